// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <plica/core/obstacles.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <string>
#include <vector>

/// What several results have in common: rows, materials, obstacles, the machine.
namespace plica::app {

/// JSON as the program writes it: indented, with an end of line. Bytes that are not UTF-8, as names
/// of files may have them, become U+FFFD.
inline std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// A row's value: what does not apply is null, also a text that is empty.
template <class T>
nlohmann::ordered_json row_value(const T& value) {
  return value;
}
inline nlohmann::ordered_json row_value(const std::string& text) {
  return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}
inline nlohmann::ordered_json row_value(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

/// The same in a table: nothing for null, quoted where it has to be (RFC 4180).
inline std::string csv_field(const nlohmann::ordered_json& value) {
  if (value.is_null()) return {};
  if (!value.is_string()) return value.dump();
  std::string text = value.get<std::string>();
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2)
    text.insert(at, 1, '"');
  return '"' + text + '"';
}

/// Objects with the same members as a table, their names above it.
inline std::string csv_table(const nlohmann::ordered_json& rows) {
  std::string text;
  const auto add_line = [&text](const nlohmann::ordered_json& row, bool names) {
    std::string line;
    for (const auto& [name, value] : row.items())
      line += "," + csv_field(names ? nlohmann::ordered_json(name) : value);
    text += line.substr(std::min<std::size_t>(1, line.size())) + "\n";
  };
  for (const auto& row : rows) {
    if (text.empty()) add_line(row, true);
    add_line(row, false);
  }
  return text;
}

/// A material of this kind: "neo_hookean, young_modulus 20 kPa, poisson_ratio 0.4, density 1000
/// kg/m^3". The parameters are those that the material declares.
std::string material_text(const MaterialInfo& info, const MaterialOptions& material);

/// The same: {"model", each parameter by its name, "density"}, in SI units.
nlohmann::ordered_json material_json(const MaterialInfo& info, const MaterialOptions& material);

/// The obstacles, so that a picture can show what was hit. Of a surface its box and counts.
nlohmann::ordered_json obstacles_json(const ContactOptions& contact);

/// What measurements were made on.
struct StudyMachine {
  std::string cpu;
  int cores = 0;
  std::string backend;
  int threads = 0;  ///< at most
};

/// This one. Needs Kokkos.
StudyMachine this_machine();

/// plica --version: the program, Kokkos and its back ends, the compiler, the commit.
std::string version_text();

/// With the program that measured.
nlohmann::ordered_json machine_json(const StudyMachine& machine);

}  // namespace plica::app
