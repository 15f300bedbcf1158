// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/study_choice.hpp>
#include <plica/drivers/app/output/study_table.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/truth_report.hpp>
#include <plica/drivers/study/study.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

Json probes_json(const StudyRow& row) {
  Json json;  // null: there are no probes
  for (const auto& [name, value] : row.error_probes) json[name] = or_null(value);
  return json;
}

void read_probes(const Json& json, StudyRow& row) {
  for (const auto& [name, value] : json.items()) read_value(value, row.error_probes[name]);
}

const Table<StudyRow> study_columns = {
    {"method", &StudyRow::method},
    {"distribution", &StudyRow::distribution},
    {"variant", &StudyRow::variant},
    {"macro_step", &StudyRow::macro_step},
    {"macro_step_over_critical", &StudyRow::macro_step_over_critical},
    {"automatic", &StudyRow::automatic},
    {"element", &StudyRow::element},
    {"precision", &StudyRow::precision},
    {"threads", &StudyRow::threads},
    {"status", &StudyRow::status},
    {"reason", &StudyRow::reason},
    {"reached", &StudyRow::reached},
    {"error", &StudyRow::error},
    {"error_velocity", &StudyRow::error_velocity},
    {"error_worst_vertex", &StudyRow::error_worst_vertex},
    {"total_error", &StudyRow::total_error},
    {"space_error", &StudyRow::space_error},
    {"error_finer", &StudyRow::error_finer},
    {"error_probes", probes_json, read_probes},
    {"energy_drift", &StudyRow::energy_drift},
    {"phase", &StudyRow::phase},
    {"wall_time", &StudyRow::wall_time},
    {"wall_time_spread", &StudyRow::wall_time_spread},
    {"timed_runs", &StudyRow::timed_runs},
    {"setup_time", &StudyRow::setup_time},
    {"work", &StudyRow::work},
    {"spectral_radius", &StudyRow::spectral_radius},
    {"spectral_radius_uncertainty", &StudyRow::spectral_radius_uncertainty},
    {"growth_per_second", &StudyRow::growth_per_second},
    {"pareto", &StudyRow::pareto},
    {"case", &StudyRow::key}};

Json reference_json(const StudyResult& result) {
  const StudyReference& r = result.reference;
  Json json = {{"method", r.method},
               {"macro_step", r.macro_step},
               {"critical_step", r.critical_step},
               {"own_error", r.own_error},
               {"own_error_velocity", r.own_error_velocity},
               {"smallest_error", or_null(smallest_error(result.rows))},
               {"good_enough", good_enough(result)},
               {"space_error", or_null(r.space_error)},
               {"wall_time", r.wall_time}};
  if (r.truth)
    json["truth"] = truth_columns().json(*r.truth), json["meshes"] = mesh_columns().json(r.meshes);
  return json;
}

}  // namespace

std::string study_json(const StudyHead& head, const StudyMachine& machine,
                       const StudyResult& result, const std::string& status,
                       const std::string& stopped) {
  Json json = {{"scene", head.scene},
               {"name", head.name},
               {"status", status},
               {"duration", head.duration},
               {"samples", head.samples},
               {"tets", head.tets},
               {"machine", machine_json(machine)},
               {"digest", head.digest},
               {"reference", reference_json(result)},
               {"choices", choices_json(result, head.levels)},
               {"rows", with_nulls(study_columns.json(result.rows))},
               {"left_out", Json::array()}};
  for (const LeftOut& one : result.left_out)
    json["left_out"].push_back({{"case", one.key}, {"reason", one.reason}});
  if (!stopped.empty())
    json["left_out"].push_back(
        {{"case", stopped}, {"reason", "the study was stopped during this case"}});
  return json_text(json);
}

std::vector<StudyRow> rows_of_study(const std::string& text, const std::string& digest) try {
  const Json json = Json::parse(text);
  std::vector<StudyRow> rows;
  if (json.at("digest") == digest) study_columns.read(json.at("rows"), rows);
  return rows;
} catch (const Json::exception&) {
  return {};
}

bool holds_other_rows(const std::string& text, const std::string& digest) try {
  const Json json = Json::parse(text);
  return json.at("digest") != digest && !json.at("rows").empty();
} catch (const Json::exception&) {
  return false;
}

std::string study_csv(const std::vector<StudyRow>& rows) {
  StudyRow all;
  for (const StudyRow& row : rows)
    for (const auto& [probe, value] : row.error_probes) all.error_probes[probe];
  const auto flat = [&](const StudyRow& row) {
    Json line;
    const Json nested = study_columns.json(row);
    for (const auto& [name, value] : nested.items())
      if (name != "error_probes")
        line[name] = value;
      else
        for (const auto& [probe, unused] : all.error_probes)
          line[name + "." + probe] = value.is_null() ? Json() : value.value(probe, Json());
    return line;
  };
  Json lines = Json::array();
  for (const StudyRow& row : rows) lines.push_back(flat(row));
  return csv_table(lines, flat(all));
}

namespace {

constexpr std::size_t table_width = text_width;

// Returns a row's label and everything in which the study's rows differ: element, precision,
// threads
std::string name_of(const StudyRow& row, const StudyResult& result) {
  const auto differs = [&](auto member) {
    return std::ranges::any_of(result.rows,
                               [&](const StudyRow& other) { return other.*member != row.*member; });
  };
  std::string name = row.label();
  if (differs(&StudyRow::element)) name += ", " + row.element;
  if (differs(&StudyRow::precision)) name += ", " + row.precision;
  if (differs(&StudyRow::threads)) name += ", " + counted(row.threads, "thread");
  return name;
}

std::string reference_text(const StudyResult& result) {
  const StudyReference& r = result.reference;
  if (r.truth) return truth_text(result);
  std::string text = fmt::format("Reference: {} at {}; doubling that step changes it by {}.",
                                 r.method, in_units(r.macro_step, "s"), percent(r.own_error));
  if (!good_enough(result))
    text += fmt::format(
        " The smallest error reported, {}, is too small for this reference: errors below {} cannot "
        "be compared.",
        percent(*smallest_error(result.rows)), percent(10 * r.own_error));
  if (r.space_error)
    text += fmt::format(" A mesh twice as fine differs by {}: the finest mesh's error in space.",
                        percent(*r.space_error));
  return wrapped(text, table_width, "");
}

std::optional<std::string> growth_of(const StudyRow& row) {
  if (!row.spectral_radius) return {};
  return grows(row) ? fmt::format("{:.2g} per second", *row.growth_per_second) : "none";
}

std::string pareto_text(const StudyResult& result) {
  std::vector<StudyRow> front;
  std::ranges::copy_if(result.rows, std::back_inserter(front), &StudyRow::pareto);
  if (front.empty()) return "No method completed.\n";
  std::ranges::sort(front, {}, &StudyRow::wall_time);
  Table<StudyRow> table = {
      {"", [&](const StudyRow& row) { return name_of(row, result); }, {"the best for their time"}},
      {"", &StudyRow::macro_step, {"macro step", "s"}},
      {"", &StudyRow::macro_step_over_critical, {"x critical", "{:.3g}"}},
      {"", &StudyRow::judged, {"error", "%"}},
      {"", &StudyRow::error_velocity, {"of velocity", "%"}},
      {"", &StudyRow::wall_time, {"time", "s"}},
      {"", &StudyRow::work, {"work", "{:.3g}"}}};
  if (result.reference.truth)
    table.add({"", &StudyRow::space_error, {"in space", "%"}}),
        table.add({"", &StudyRow::error, {"in time", "%"}});
  if (std::ranges::any_of(front, [](const StudyRow& row) { return growth_of(row).has_value(); }))
    table.add({"", growth_of, {"growth", "{}"}});
  return table.text(front);
}

// Returns how small motions about rest grow in all rows of linearised cycles. Growth is the change
// of the logarithm of the amplitude per simulated second
std::string growth_text(const StudyResult& result) {
  const StudyRow *fastest = nullptr, *stable = nullptr;
  long found = 0, growing = 0;
  for (const StudyRow& row : result.rows) {
    if (!row.spectral_radius) continue;
    ++found, growing += grows(row) ? 1 : 0;
    if (grows(row) && (fastest == nullptr || *row.growth_per_second > *fastest->growth_per_second))
      fastest = &row;
    if (!grows(row) && (stable == nullptr || *row.macro_step > *stable->macro_step)) stable = &row;
  }
  if (found == 0) return {};
  const auto at = [&](const StudyRow& row) {
    return fmt::format("{} at {:.3g} x critical", name_of(row, result),
                       *row.macro_step_over_critical);
  };
  std::string text =
      fmt::format("Small motions about rest: {} of cycles, of which {} let them grow.",
                  counted(found, "row"), growing);
  if (fastest != nullptr)
    text += fmt::format(" {} grows fastest, by {:.3g} per second.", at(*fastest),
                        *fastest->growth_per_second);
  if (stable != nullptr)
    text += fmt::format(" The longest macro step without growth: {}.", at(*stable));
  return wrapped(text, table_width, "");
}

std::string choice_text(const StudyResult& result, const StudyChoice& choice) {
  std::string text =
      fmt::format("Under {:g} % error ({}): ", 100 * choice.allowed, choice.error_class);
  if (const StudyRow* row = choice.row) {
    text +=
        fmt::format("{} at {}, {} for {}. ", name_of(*row, result), in_units(*row->macro_step, "s"),
                    in_units(*row->wall_time, "s"), percent(*row->judged()));
    if (row->method.starts_with("coarse/")) text += "A coarser mesh alone is enough here. ";
  }
  return wrapped(text + choice.reason, table_width, "");
}

std::string missing_text(const StudyResult& result) {
  const auto count = [&](const char* status) {
    return std::ranges::count_if(result.rows,
                                 [&](const StudyRow& row) { return row.status == status; });
  };
  std::string text;
  if (count("diverged") + count("refused") > 0)
    text += fmt::format("Not completed: {} diverged, {} refused; study.json says why.\n",
                        count("diverged"), count("refused"));
  std::map<std::string, int> left_out;
  for (const LeftOut& one : result.left_out) ++left_out[one.key.substr(0, one.key.find(','))];
  std::string names;
  for (const auto& [name, runs] : left_out)
    names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", name, runs);
  if (!names.empty())
    text += fmt::format("Left out, {} (study.json says why):\n",
                        counted(static_cast<long>(result.left_out.size()), "run")) +
            wrapped(names, table_width, "  ");
  return text;
}

}  // namespace

std::string study_text(const Scene& scene, const StudyResult& result, const std::string& folder) {
  if (result.reference.trajectory.u.empty())
    return fmt::format("{}: stopped before there was a reference; nothing is written\n",
                       scene.name);
  std::string text =
      fmt::format("{}: {}{}\n", scene.name, counted(static_cast<long>(result.rows.size()), "row"),
                  result.stopped ? ", interrupted: the same command goes on with them" : "");
  text += reference_text(result) + pareto_text(result);
  for (const StudyChoice& choice : choices_of(result)) text += choice_text(result, choice);
  text += growth_text(result) + missing_text(result);
  return text +
         fmt::format("Files: {0}: study.json, study.csv. To look at: plica report {0}\n", folder) +
         fmt::format(
             "To run what is chosen: plica run {} --study {} --set integration.error_class=CLASS\n",
             scene.file, folder);
}

}  // namespace plica::app
