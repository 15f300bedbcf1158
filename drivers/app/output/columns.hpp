// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <concepts>
#include <functional>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <plica/drivers/app/output/terminal.hpp>
#include <string>
#include <type_traits>
#include <vector>

/// Tables of results. One list of columns says what JSON, CSV, Markdown and terminal show, and
/// reads the JSON again.
namespace plica::app {

/// Returns a value as JSON; null where an optional value is missing.
template <class T>
nlohmann::ordered_json or_null(const T& value) {
  if constexpr (requires { value.has_value(); })
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
  else
    return value;
}

/// Reads a value that or_null() has written; null leaves an optional value and a text as they are.
/// Throws nlohmann's exception if the JSON is of another type.
template <class T>
requires(!std::is_const_v<T>) void read_value(const nlohmann::ordered_json& json, T& value) {
  if constexpr (requires { value.has_value(); }) {
    if (!json.is_null()) value = json.get<typename T::value_type>();
  } else {
    if (!std::same_as<T, std::string> || !json.is_null()) json.get_to(value);
  }
}

/// Look of a column on the terminal and in Markdown.
struct Shown {
  std::optional<std::string> head = {};  ///< none: the column is in files only
  /// empty: text, on the left. Else on the right: "%" for a fraction in per cent, the unit of
  /// in_units(), or a format with braces
  std::string format = {};
};

using Lines = std::vector<std::vector<std::string>>;  ///< lines of a table, each of cells

/// Returns a value as text, in the format of Shown; empty: null.
std::string text_of(const nlohmann::ordered_json& value, const std::string& format);
/// Returns lines as a table in Markdown; the first has the heads.
std::string markdown_table(const Lines& lines);

/// Column of a table of results.
template <class Row>
struct Column {
  using Json = nlohmann::ordered_json;
  std::string name;                             ///< name in JSON and CSV; empty: not in files
  std::function<Json(const Row&)> json;         ///< value
  std::function<void(const Json&, Row&)> read;  ///< sets the member again; empty: it is computed
  Shown shown;

  /// @param get  member or function of the row; a member, or a reference to one, is read again
  template <class Get>
  Column(std::string its_name, Get get, Shown look = {})
      : name(std::move(its_name)),
        json([get](const Row& row) -> Json { return or_null(std::invoke(get, row)); }),
        shown(std::move(look)) {
    if constexpr (requires(Json from, Row & row) { read_value(from, std::invoke(get, row)); })
      read = [get](const Json& from, Row& row) { read_value(from, std::invoke(get, row)); };
  }

  /// @param put  reads what `get` has written
  template <class Get, std::invocable<const nlohmann::ordered_json&, Row&> Put>
  Column(std::string its_name, Get get, Put put) : Column(std::move(its_name), get) {
    read = put;
  }
};

/// List of columns.
template <class Row>
class Table {
 public:
  using Json = nlohmann::ordered_json;
  Table(std::initializer_list<Column<Row>> columns) : columns_(columns) {}
  void add(const Column<Row>& column) { columns_.push_back(column); }

  /// Returns a row as an object with the names of the columns.
  Json json(const Row& row) const {
    Json object = Json::object();
    for (const Column<Row>& column : columns_)
      if (!column.name.empty()) object[column.name] = column.json(row);
    return object;
  }
  Json json(const std::vector<Row>& rows) const {
    Json array = Json::array();
    for (const Row& row : rows) array.push_back(json(row));
    return array;
  }

  /// Sets the members that json() has written. Throws nlohmann's exception if one is missing.
  void read(const Json& from, Row& row) const {
    for (const Column<Row>& column : columns_)
      if (column.read) column.read(from.at(column.name), row);
  }
  void read(const Json& from, std::vector<Row>& rows) const {
    for (const Json& one : from) read(one, rows.emplace_back());
  }

  /// Returns rows as a table for the terminal, below the heads if one of them is not empty.
  std::string text(const std::vector<Row>& rows) const {
    std::string sides;
    for (const Column<Row>& column : columns_)
      if (column.shown.head) sides += column.shown.format.empty() ? '<' : '>';
    Lines all = lines(rows);
    if (std::ranges::count(all[0], "") == std::ssize(all[0])) all.erase(all.begin());
    return text_table(all, sides);
  }
  /// Returns rows as a table in Markdown.
  std::string markdown(const std::vector<Row>& rows) const { return markdown_table(lines(rows)); }

 private:
  std::vector<Column<Row>> columns_;

  // Returns the heads of the columns that are shown, then the rows as text
  Lines lines(const std::vector<Row>& rows) const {
    Lines all(1 + rows.size());
    for (const auto& [name, json, read, shown] : columns_) {
      if (!shown.head) continue;
      all[0].push_back(*shown.head);
      for (std::size_t i = 0; i < rows.size(); ++i)
        all[i + 1].push_back(text_of(json(rows[i]), shown.format));
    }
    return all;
  }
};

/// Returns the column of a member, or of a list of members, that has columns of its own.
template <class Row, class Member, class Own>
Column<Row> part(const std::string& name, Member Row::*member, const Table<Own>& own) {
  using Json = nlohmann::ordered_json;
  return {name, [=](const Row& row) { return own.json(row.*member); },
          [=](const Json& from, Row& row) { own.read(from, row.*member); }};
}

/// Returns rows with null in the place of empty texts: does not apply.
nlohmann::ordered_json with_nulls(nlohmann::ordered_json rows);

/// Returns objects with equal members as a CSV table (RFC 4180); null gives an empty field.
/// @param head  object whose names stand above the table; null: the first row, where there is one
std::string csv_table(const nlohmann::ordered_json& rows, const nlohmann::ordered_json& head = {});

}  // namespace plica::app
