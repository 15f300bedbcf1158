// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <plica/drivers/app/output/columns.hpp>

namespace plica::app {

std::string text_of(const nlohmann::ordered_json& value, const std::string& format) {
  if (value.is_null()) return {};
  if (value.is_string()) return value.get<std::string>();
  if (format == "%") return percent(value.get<double>());
  if (format.find('{') == std::string::npos) return in_units(value.get<double>(), format);
  return value.is_number_integer() ? fmt::format(fmt::runtime(format), value.get<long>())
                                   : fmt::format(fmt::runtime(format), value.get<double>());
}

std::string markdown_table(const Lines& lines) {
  std::string text;
  for (const auto& cells : lines) {
    text += fmt::format("| {} |\n", fmt::join(cells, " | "));
    if (&cells != &lines.front()) continue;
    text += "|";
    for (std::size_t i = 0; i < cells.size(); ++i) text += "---|";
    text += "\n";
  }
  return text;
}

nlohmann::ordered_json with_nulls(nlohmann::ordered_json rows) {
  for (auto& row : rows)
    for (auto& value : row)
      if (value == "") value = nullptr;
  return rows;
}

namespace {

std::string csv_field(const nlohmann::ordered_json& value) {
  if (value.is_null()) return {};
  if (!value.is_string()) return value.dump();
  std::string text = value.get<std::string>();
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2)
    text.insert(at, 1, '"');
  return '"' + text + '"';
}

}  // namespace

std::string csv_table(const nlohmann::ordered_json& rows, const nlohmann::ordered_json& head) {
  if (head.is_null()) return rows.empty() ? "" : csv_table(rows, rows.front());
  std::vector<std::string> names;
  for (const auto& [name, value] : head.items()) names.push_back(csv_field(name));
  std::string text = fmt::format("{}\n", fmt::join(names, ","));
  for (const auto& row : rows) {
    std::vector<std::string> fields;
    for (const auto& value : row) fields.push_back(csv_field(value));
    text += fmt::format("{}\n", fmt::join(fields, ","));
  }
  return text;
}

}  // namespace plica::app
