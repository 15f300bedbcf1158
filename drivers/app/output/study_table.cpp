// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/study_choice.hpp>
#include <plica/drivers/app/output/study_table.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/truth_report.hpp>
#include <plica/drivers/study/study.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

// Visits the members of a row with their names in study.json; used for writing and reading
template <class Row, class Visit>
void each_member(Row& row, const Visit& visit) {
  visit("method", row.method);
  visit("distribution", row.distribution);
  visit("variant", row.variant);
  visit("macro_step", row.macro_step);
  visit("macro_step_over_critical", row.macro_step_over_critical);
  visit("automatic", row.automatic);
  visit("element", row.element);
  visit("precision", row.precision);
  visit("threads", row.threads);
  visit("status", row.status);
  visit("reason", row.reason);
  visit("reached", row.reached);
  visit("error", row.error);
  visit("error_velocity", row.error_velocity);
  visit("error_worst_vertex", row.error_worst_vertex);
  visit("total_error", row.total_error);
  visit("space_error", row.space_error);
  visit("error_finer", row.error_finer);
  visit("error_probes", row.error_probes);
  visit("energy_drift", row.energy_drift);
  visit("phase", row.phase);
  visit("wall_time", row.wall_time);
  visit("wall_time_spread", row.wall_time_spread);
  visit("timed_runs", row.timed_runs);
  visit("setup_time", row.setup_time);
  visit("work", row.work);
  visit("spectral_radius", row.spectral_radius);
  visit("spectral_radius_uncertainty", row.spectral_radius_uncertainty);
  visit("growth_per_second", row.growth_per_second);
  visit("pareto", row.pareto);
  visit("case", row.key);
}

using Probes = std::map<std::string, std::optional<double>>;

using app::row_value;
Json row_value(const Probes& probes) {
  Json json;  // null: there are no probes
  for (const auto& [name, value] : probes) json[name] = row_value(value);
  return json;
}

template <class T>
void read(const Json& json, T& value) {
  if (!json.is_null()) json.get_to(value);
}
void read(const Json& json, std::optional<double>& value) {
  if (!json.is_null()) value = json.get<double>();
}
void read(const Json& json, Probes& probes) {
  for (const auto& [name, value] : json.items()) read(value, probes[name]);
}

Json row_json(const StudyRow& row) {
  Json json;
  each_member(row, [&](const char* name, const auto& value) { json[name] = row_value(value); });
  return json;
}

StudyRow row_of(const Json& json) {
  StudyRow row;
  each_member(row, [&](const char* name, auto& value) { read(json.at(name), value); });
  return row;
}

Json reference_json(const StudyResult& result) {
  const StudyReference& r = result.reference;
  Json json = {{"method", r.method},
               {"macro_step", r.macro_step},
               {"critical_step", r.critical_step},
               {"own_error", r.own_error},
               {"own_error_velocity", r.own_error_velocity},
               {"smallest_error", row_value(smallest_error(result.rows))},
               {"good_enough", good_enough(result)},
               {"space_error", row_value(r.space_error)},
               {"wall_time", r.wall_time}};
  if (r.truth) json["truth"] = truth_json(*r.truth), json["meshes"] = meshes_json(r.meshes);
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
               {"rows", Json::array()},
               {"left_out", Json::array()}};
  for (const StudyRow& row : result.rows) json["rows"].push_back(row_json(row));
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
  if (json.at("digest") == digest)
    for (const Json& row : json.at("rows")) rows.push_back(row_of(row));
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
  StudyRow columns;
  for (const StudyRow& row : rows)
    for (const auto& [name, value] : row.error_probes) columns.error_probes[name];
  std::string text;
  const auto add_line = [&](const Json& row, bool names) {
    std::string line;
    const auto add = [&](const std::string& name, const Json& value) {
      line += (line.empty() ? "" : ",") + csv_field(names ? Json(name) : value);
    };
    for (const auto& [name, value] : row.items()) {
      if (name != "error_probes") add(name, value);
      if (name == "error_probes")
        for (const auto& [probe, unused] : columns.error_probes)
          add(name + "." + probe, value.is_null() ? Json() : value.value(probe, Json()));
    }
    text += line + "\n";
  };
  add_line(row_json(columns), true);
  for (const StudyRow& row : rows) add_line(row_json(row), false);
  return text;
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

std::string growth_of(const StudyRow& row) {
  if (!row.spectral_radius) return "";
  if (!grows(row)) return "none";
  return fmt::format("{:.2g} per second", *row.growth_per_second);
}

std::string pareto_text(const StudyResult& result) {
  std::vector<const StudyRow*> front;
  for (const StudyRow& row : result.rows)
    if (row.pareto) front.push_back(&row);
  if (front.empty()) return "No method completed.\n";
  std::ranges::sort(front, {}, [](const StudyRow* row) { return *row->wall_time; });
  const bool growth = std::ranges::any_of(
      front, [](const StudyRow* row) { return row->spectral_radius.has_value(); });
  std::vector<std::vector<std::string>> table = {{"the best for their time", "macro step",
                                                  "x critical", "error", "of velocity", "time",
                                                  "work"}};
  const bool truth = result.reference.truth.has_value();
  if (truth) table[0].insert(table[0].end(), {"in space", "in time"});
  if (growth) table[0].emplace_back("growth");
  for (const StudyRow* row : front) {
    table.push_back({name_of(*row, result), in_units(*row->macro_step, "s"),
                     fmt::format("{:.3g}", *row->macro_step_over_critical), percent(*row->judged()),
                     percent(*row->error_velocity), in_units(*row->wall_time, "s"),
                     fmt::format("{:.3g}", *row->work)});
    if (truth)
      table.back().insert(table.back().end(), {percent(*row->space_error), percent(*row->error)});
    if (growth) table.back().push_back(growth_of(*row));
  }
  return text_table(table, "<>>>>>>>>>");
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
