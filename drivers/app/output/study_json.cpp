// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <plica/drivers/app/output/row_json.hpp>
#include <plica/drivers/app/output/study_json.hpp>
#include <plica/drivers/study/judgement.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

// A row's members under their names in the file, once, for writing and for reading
template <class Row, class Visit>
void each_member(Row& row, const Visit& visit) {
  visit("method", row.method);
  visit("distribution", row.distribution);
  visit("variant", row.variant);
  visit("macro_step", row.macro_step);
  visit("macro_step_over_critical", row.macro_step_over_critical);
  visit("automatic", row.automatic);
  visit("precision", row.precision);
  visit("threads", row.threads);
  visit("status", row.status);
  visit("reason", row.reason);
  visit("reached", row.reached);
  visit("error", row.error);
  visit("error_velocity", row.error_velocity);
  visit("error_worst_vertex", row.error_worst_vertex);
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
  Json json;  // null where there are none
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
  return {{"method", r.method},
          {"macro_step", r.macro_step},
          {"critical_step", r.critical_step},
          {"own_error", r.own_error},
          {"own_error_velocity", r.own_error_velocity},
          {"smallest_error", row_value(smallest_error(result.rows))},
          {"good_enough", good_enough(result)},
          {"space_error", row_value(r.space_error)},
          {"wall_time", r.wall_time}};
}

}  // namespace

std::string study_json(const StudyHead& head, const StudyMachine& machine, const StudyResult& result,
                       const std::string& status) {
  Json json = {{"scene", head.scene},
               {"name", head.name},
               {"status", status},
               {"duration", head.duration},
               {"samples", head.samples},
               {"tets", head.tets},
               {"machine", machine_json(machine)},
               {"digest", head.digest},
               {"reference", reference_json(result)},
               {"rows", Json::array()},
               {"left_out", Json::array()}};
  for (const StudyRow& row : result.rows) json["rows"].push_back(row_json(row));
  for (const LeftOut& one : result.left_out) json["left_out"].push_back({{"case", one.key}, {"reason", one.reason}});
  return json.dump(2) + "\n";
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

}  // namespace plica::app
