// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/verify_table.hpp>
#include <plica/version.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

// Names and demands of the criteria, in the order of Judged
struct Criterion {
  const char *name, *demand;
  double factor;  // factor of the tolerance in the demand
};
constexpr Criterion criteria[] = {{"finest", "finest within {:.3g} %", 100},
                                  {"limit", "limit within {:.3g} %", 100},
                                  {"size", "at most {:.0e}", 1},
                                  {"order", "order within {:.2g}", 1},
                                  {"above", "falls, stays above", 1},
                                  {"nothing", "for information", 1}};

const Criterion& criterion(const VerifyRow& row) {
  return criteria[static_cast<std::size_t>(row.judged)];
}

Json if_said(const std::string& text) { return text.empty() ? Json() : Json(text); }

const Table<VerifyValue> value_columns = {
    {"mesh", &VerifyValue::mesh}, {"size", &VerifyValue::size}, {"value", &VerifyValue::value}};

const Table<VerifyRow> verify_columns = {
    {"problem", &VerifyRow::problem},
    {"quantity", &VerifyRow::quantity},
    {"unit", &VerifyRow::unit},
    {"element", &VerifyRow::element},
    {"mesh", &VerifyRow::mesh},
    {"accepted", &VerifyRow::accepted},
    {"source", [](const VerifyRow& row) { return if_said(row.source); }},
    part("ours", &VerifyRow::ours, value_columns),
    {"limit", &VerifyRow::limit},
    {"order", &VerifyRow::order},
    {"judged", [](const VerifyRow& row) { return criterion(row).name; }},
    {"tolerance",
     [](const VerifyRow& row) {
       const bool has_none = row.judged == Judged::nothing || row.judged == Judged::above;
       return has_none ? Json() : Json(row.tolerance);
     }},
    {"outcome", &VerifyRow::outcome},
    {"ok", [](const VerifyRow& row) { return row.outcome != "not ok"; }},
    {"note", [](const VerifyRow& row) { return if_said(row.note); }}};

}  // namespace

std::string verify_json(const VerifyHead& head, const VerifyResult& result) {
  return json_text({{"status", head.status},
                    {"ok", result.ok()},
                    {"small", head.small},
                    {"machine", machine_json(head.machine)},
                    {"wall_time", head.wall_time},
                    {"rows", verify_columns.json(result.rows)}});
}

std::string verify_csv(const VerifyResult& result) {
  const auto flat = [](const Json& row, const Json& ours) {
    Json line;
    for (const auto& [name, value] : row.items())
      if (name == "ours")
        line["size"] = ours["size"], line["value"] = ours["value"];
      else
        line[name] = name == "mesh" ? ours[name] : value;
    return line;
  };
  Json lines = Json::array();
  for (const Json& row : verify_columns.json(result.rows))
    for (const Json& ours : row["ours"]) lines.push_back(flat(row, ours));
  return csv_table(lines,
                   flat(verify_columns.json(VerifyRow()), value_columns.json(VerifyValue())));
}

namespace {

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.5g}", *value) : "";
}

std::string with_unit(const std::optional<double>& value, const std::string& unit) {
  return number(value) + (value && unit != "1" ? " " + unit : "");
}

// Returns what the row had to fulfil
std::string demand(const VerifyRow& row) {
  return fmt::format(fmt::runtime(criterion(row).demand), criterion(row).factor * row.tolerance);
}

std::string accepted(const VerifyRow& row) {
  if (row.judged == Judged::order) return "order " + number(row.accepted);
  return row.judged == Judged::size ? "0" : with_unit(row.accepted, row.unit);
}

// Returns the value on the finest mesh; for errors that must be round-off, the largest of all
// meshes
std::string headline(const VerifyRow& row) {
  if (row.ours.empty()) return {};
  double worst = 0;
  for (const VerifyValue& v : row.ours)
    worst = std::abs(v.value) <= worst ? worst : std::abs(v.value);
  return with_unit(row.judged == Judged::size ? worst : row.ours.back().value, row.unit);
}

std::string values(const VerifyRow& row) {
  std::string text;
  for (const VerifyValue& v : row.ours)
    text += (text.empty() ? "" : "<br>") + fmt::format("{}: {}", v.mesh, number(v.value));
  return text;
}

std::string quantity_and_unit(const VerifyRow& row) {
  return row.quantity + (row.unit == "1" ? "" : " [" + row.unit + "]");
}

const Table<VerifyRow> markdown_columns = {{"", &VerifyRow::problem, {"problem"}},
                                           {"", quantity_and_unit, {"quantity"}},
                                           {"", &VerifyRow::element, {"element"}},
                                           {"", &VerifyRow::mesh, {"mesh"}},
                                           {"", accepted, {"accepted"}},
                                           {"", &VerifyRow::source, {"source"}},
                                           {"", values, {"ours"}},
                                           {"", &VerifyRow::limit, {"limit", "{:.5g}"}},
                                           {"", &VerifyRow::order, {"order", "{:.2f}"}},
                                           {"", demand, {"asked"}},
                                           {"", &VerifyRow::outcome, {"outcome"}},
                                           {"", &VerifyRow::note, {"note"}}};

const Table<VerifyRow> terminal_columns = {
    {"", &VerifyRow::problem, {"problem"}},       {"", &VerifyRow::quantity, {"quantity"}},
    {"", &VerifyRow::element, {"element"}},       {"", &VerifyRow::mesh, {"mesh"}},
    {"", accepted, {"accepted", "{}"}},           {"", headline, {"ours", "{}"}},
    {"", &VerifyRow::limit, {"limit", "{:.5g}"}}, {"", &VerifyRow::order, {"order", "{:.2f}"}},
    {"", &VerifyRow::outcome, {"outcome"}}};

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
  return text + markdown_columns.markdown(result.rows);
}

std::string verify_text(const VerifyResult& result, const std::string& folder) {
  const auto wrong = std::ranges::count_if(
      result.rows, [](const VerifyRow& row) { return row.outcome == "not ok"; });
  return terminal_columns.text(result.rows) +
         fmt::format("{}, {} not ok. All of it: {}/verify.md\n",
                     counted(static_cast<long>(result.rows.size()), "row"), wrong, folder);
}

}  // namespace plica::app
