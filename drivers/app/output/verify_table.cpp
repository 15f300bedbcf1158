// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/verify_table.hpp>
#include <plica/version.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

Json row_head(const VerifyRow& row) {
  return {{"problem", row.problem},
          {"quantity", row.quantity},
          {"unit", row.unit},
          {"element", row.element},
          {"mesh", row.mesh},
          {"accepted", row_value(row.accepted)},
          {"source", row_value(row.source)}};
}

Json row_end(const VerifyRow& row) {
  return {
      {"limit", row_value(row.limit)},
      {"order", row_value(row.order)},
      {"judged", judged_name(row.judged)},
      {"tolerance",
       row.judged == Judged::nothing || row.judged == Judged::above ? Json() : Json(row.tolerance)},
      {"outcome", row.outcome},
      {"ok", row.outcome != "not ok"},
      {"note", row_value(row.note)}};
}

}  // namespace

std::string judged_name(Judged judged) {
  switch (judged) {
    case Judged::finest:
      return "finest";
    case Judged::limit:
      return "limit";
    case Judged::size:
      return "size";
    case Judged::order:
      return "order";
    case Judged::above:
      return "above";
    case Judged::nothing:
      break;
  }
  return "nothing";
}

std::string verify_json(const VerifyHead& head, const VerifyResult& result) {
  Json json = {{"status", head.status},       {"ok", result.ok()},
               {"small", head.small},         {"machine", machine_json(head.machine)},
               {"wall_time", head.wall_time}, {"rows", Json::array()}};
  for (const VerifyRow& row : result.rows) {
    Json one = row_head(row);
    one["ours"] = Json::array();
    for (const VerifyValue& v : row.ours)
      one["ours"].push_back({{"mesh", v.mesh}, {"size", v.size}, {"value", v.value}});
    one.update(row_end(row));
    json["rows"].push_back(one);
  }
  return json_text(json);
}

std::string verify_csv(const VerifyResult& result) {
  Json rows = Json::array();
  for (const VerifyRow& row : result.rows)
    for (const VerifyValue& v : row.ours) {
      Json one = row_head(row);
      one["mesh"] = v.mesh, one["size"] = v.size, one["value"] = v.value;
      one.update(row_end(row));
      rows.push_back(one);
    }
  return csv_table(rows);
}

namespace {

std::string number(const std::optional<double>& value, const char* none = "") {
  return value ? fmt::format("{:.5g}", *value) : none;
}

std::string with_unit(const std::optional<double>& value, const std::string& unit) {
  return number(value) + (value && unit != "1" ? " " + unit : "");
}

// Returns what the row had to fulfil
std::string demand(const VerifyRow& row) {
  switch (row.judged) {
    case Judged::finest:
      return fmt::format("finest within {:.3g} %", 100 * row.tolerance);
    case Judged::limit:
      return fmt::format("limit within {:.3g} %", 100 * row.tolerance);
    case Judged::size:
      return fmt::format("at most {:.0e}", row.tolerance);
    case Judged::order:
      return fmt::format("order within {:.2g}", row.tolerance);
    case Judged::above:
      return "falls, stays above";
    case Judged::nothing:
      break;
  }
  return "for information";
}

std::string accepted(const VerifyRow& row) {
  if (row.judged == Judged::order) return "order " + number(row.accepted);
  return row.judged == Judged::size ? "0" : with_unit(row.accepted, row.unit);
}

// Returns the value on the finest mesh; for errors that must be round-off, the largest of all
// meshes
std::optional<double> headline(const VerifyRow& row) {
  if (row.ours.empty()) return {};
  double worst = 0;
  for (const VerifyValue& v : row.ours)
    worst = std::abs(v.value) <= worst ? worst : std::abs(v.value);
  return row.judged == Judged::size ? worst : row.ours.back().value;
}

std::string limit(const VerifyRow& row) { return number(row.limit); }
std::string order(const VerifyRow& row) {
  return row.order ? fmt::format("{:.2f}", *row.order) : "";
}

std::string values(const VerifyRow& row) {
  std::string text;
  for (const VerifyValue& v : row.ours)
    text += (text.empty() ? "" : "<br>") + fmt::format("{}: {}", v.mesh, number(v.value));
  return text;
}

using Cell = std::string (*)(const VerifyRow&);

// Column of the tables in verify.md and on the terminal; text null: not on the terminal
struct Column {
  const char* name;
  Cell markdown, text;
};

const Column columns[] = {
    {"problem", [](const VerifyRow& row) { return row.problem; },
     [](const VerifyRow& row) { return row.problem; }},
    {"quantity",
     [](const VerifyRow& row) {
       return row.quantity + (row.unit == "1" ? "" : " [" + row.unit + "]");
     },
     [](const VerifyRow& row) { return row.quantity; }},
    {"element", [](const VerifyRow& row) { return row.element; },
     [](const VerifyRow& row) { return row.element; }},
    {"mesh", [](const VerifyRow& row) { return row.mesh; },
     [](const VerifyRow& row) { return row.mesh; }},
    {"accepted", accepted, accepted},
    {"source", [](const VerifyRow& row) { return row.source; }, nullptr},
    {"ours", values, [](const VerifyRow& row) { return with_unit(headline(row), row.unit); }},
    {"limit", limit, limit},
    {"order", order, order},
    {"asked", demand, nullptr},
    {"outcome", [](const VerifyRow& row) { return row.outcome; },
     [](const VerifyRow& row) { return row.outcome; }},
    {"note", [](const VerifyRow& row) { return row.note; }, nullptr}};

}  // namespace

std::string verify_markdown(const VerifyHead& head, const VerifyResult& result) {
  std::string text = fmt::format(
      "# Problems with known answers\n\n"
      "Written by `plica verify{}` in {:.0f} s: {}, {} cores, {} with {}; {}; plica {} ({}). "
      "Status: {}.\n\n"
      "All in double precision. *Ours*: on each mesh, in cells, each cut into six tetrahedra, with "
      "these elements; "
      "*jittered*: vertices moved by up to a fifth of a cell; *delaunay*: Delaunay's tetrahedra of "
      "as many vertices, "
      "slivers and all. *Limit*: what the "
      "last three tend to\n"
      "(Richardson). *Order*: of the error against the accepted value, or of the differences where "
      "the row is judged "
      "by its limit\n"
      "or by nothing; of time steps, in time. An outcome `shown` is for information: such a row is "
      "not judged, and its "
      "note says what is known to be wrong.\n\n",
      head.small ? " --small" : "", head.wall_time, head.machine.cpu, head.machine.cores,
      head.machine.backend, counted(head.machine.threads, "thread"), compiler(), version(),
      git_revision(), head.status);
  std::string names = "|", rule = "|";
  for (const Column& column : columns) names += fmt::format(" {} |", column.name), rule += "---|";
  text += names + "\n" + rule + "\n";
  for (const VerifyRow& row : result.rows) {
    text += "|";
    for (const Column& column : columns) text += " " + column.markdown(row) + " |";
    text += "\n";
  }
  return text;
}

std::string verify_text(const VerifyResult& result, const std::string& folder) {
  std::vector<std::vector<std::string>> table(1);
  for (const Column& column : columns)
    if (column.text) table[0].emplace_back(column.name);
  for (const VerifyRow& row : result.rows) {
    table.emplace_back();
    for (const Column& column : columns)
      if (column.text) table.back().push_back(column.text(row));
  }
  const auto wrong = std::ranges::count_if(
      result.rows, [](const VerifyRow& row) { return row.outcome == "not ok"; });
  return text_table(table, "<<<<>>>><") +
         fmt::format("{}, {} not ok. All of it: {}/verify.md\n",
                     counted(static_cast<long>(result.rows.size()), "row"), wrong, folder);
}

}  // namespace plica::app
