// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <plica/core/error.hpp>
#include <plica/drivers/app/report/tables.hpp>
#include <plica/meshes/files/memory_file.hpp>
#include <sstream>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

double number_of(const std::string& text, const MemoryFile& file, std::int64_t line) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    refuse(file.name, {line}, "expected a number, found " + shown(text));
  return value;
}

}  // namespace

Json read_columns(const std::filesystem::path& csv, std::size_t rows) {
  const MemoryFile file = load_file(csv);
  std::istringstream stream(file.bytes);
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> names = fields_of(line);
  if (names.empty() || names.front() != "time") refuse(file.name, {1}, "expected columns that start with 'time'");
  std::vector<std::vector<double>> table;
  while (std::getline(stream, line)) {
    const std::vector<std::string> fields = fields_of(line);
    const auto number = static_cast<std::int64_t>(table.size()) + 2;
    if (fields.size() != names.size())
      refuse(file.name, {number},
             "expected " + std::to_string(names.size()) + " values, found " + std::to_string(fields.size()));
    std::vector<double>& row = table.emplace_back();
    for (const std::string& field : fields) row.push_back(number_of(field, file, number));
  }
  Json columns = Json::object();
  for (const std::string& name : names) columns[name] = Json::array();
  const std::size_t kept = std::min(rows, table.size());
  for (std::size_t i = 0; i < kept; ++i) {
    const std::vector<double>& row = table[kept == 1 ? 0 : i * (table.size() - 1) / (kept - 1)];
    for (std::size_t k = 0; k < names.size(); ++k) columns[names[k]].push_back(row[k]);
  }
  return columns;
}

Json read_json(const std::filesystem::path& file, const std::vector<std::string>& keys) try {
  Json json = Json::parse(load_file(file).bytes);
  for (const std::string& key : keys)
    if (!json.is_object() || !json.contains(key))
      throw InputError("it is not what plica wrote there: there is no '" + key + "'", {file.string()});
  return json;
} catch (const Json::exception& error) {
  throw InputError(std::string("it is damaged: ") + error.what(), {file.string()});
}

}  // namespace plica::app
