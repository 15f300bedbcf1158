// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <plica/core/obstacles.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <string>
#include <vector>

/// JSON and text of what several results share: rows, materials, obstacles, the machine.
namespace plica::app {

/// Returns JSON as the program writes it: indented, with an end of line. Bytes that are not UTF-8
/// become U+FFFD; names of files may have such bytes.
inline std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// Returns a value of a row as JSON. A missing value or an empty text becomes null: does not apply.
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

/// Returns a value as a field of a CSV table: empty for null, quoted if needed (RFC 4180).
inline std::string csv_field(const nlohmann::ordered_json& value) {
  if (value.is_null()) return {};
  if (!value.is_string()) return value.dump();
  std::string text = value.get<std::string>();
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2)
    text.insert(at, 1, '"');
  return '"' + text + '"';
}

/// Returns objects with equal members as a CSV table, with the names of the members above it.
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

/// Returns a material and the parameters that it declares as text: "neo_hookean, young_modulus 20
/// kPa, poisson_ratio 0.4, density 1000 kg/m^3".
std::string material_text(const MaterialInfo& info, const MaterialOptions& material);

/// Returns a material as JSON: {"model", each parameter by its name, "density"}, in SI units.
nlohmann::ordered_json material_json(const MaterialInfo& info, const MaterialOptions& material);

/// Returns shapes and motions of the obstacles as JSON, so that a page can draw them. A
/// triangulated surface is given by its bounding box and its number of triangles.
nlohmann::ordered_json obstacles_json(const ContactOptions& contact);

/// Machine on which measurements were made.
struct StudyMachine {
  std::string cpu;
  int cores = 0;
  std::string backend;
  int threads = 0;  ///< maximum number of threads
};

/// Returns the machine on which the program runs. Needs Kokkos.
StudyMachine this_machine();

/// Returns the text of `plica --version`: version, Kokkos and its back ends, compiler, commit.
std::string version_text();

/// Returns the machine as JSON, with the compiler and version of the program that measured.
nlohmann::ordered_json machine_json(const StudyMachine& machine);

}  // namespace plica::app
