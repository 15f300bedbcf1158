// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/stability_table.hpp>
#include <plica/drivers/app/output/terminal.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

// Adds the state with which the scene's run failed, at the smallest macro step that was too long
void add_failure(Json& json, const SceneLimit& scene) {
  json["scene_failed_step"] = row_value(scene.failed_step);
  json["scene_failed_time"] = scene.failed_step ? Json(scene.failed_time) : Json(nullptr);
  json["scene_reason"] = row_value(scene.reason);
  const bool known = scene.failure.has_value();
  const Diagnosis d = scene.failure.value_or(Diagnosis{});
  json["scene_kind"] = row_value(d.kind), json["scene_region"] = row_value(d.region);
  json["scene_level"] = known ? Json(d.level) : Json(nullptr);
  json["scene_element"] = known && d.element >= 0 ? Json(d.element) : Json(nullptr);
  json["scene_vertex"] = known && d.vertex >= 0 ? Json(d.vertex) : Json(nullptr);
  json["scene_J"] = known && d.element >= 0 ? Json(d.J) : Json(nullptr);
}

Json row_json(const StabilityRow& row) {
  Json json = {{"method", row.method},
               {"distribution", row_value(row.distribution)},
               {"variant", row_value(row.variant)},
               {"integrator", row_value(row.integrator)},
               {"status", row.status},
               {"reason", row_value(row.reason)},
               {"critical_step", row.critical_step},
               {"predicted", row_value(row.predicted)},
               {"measured", row_value(row.measured)},
               {"ratio", row_value(row.ratio)},
               {"stable_up_to", row_value(row.stable_up_to)},
               {"growth_step", row_value(row.growth_step)},
               {"spectral_radius", row_value(row.spectral_radius)},
               {"growth_per_second", row_value(row.growth_per_second)}};
  json["scene_measured"] = row.scene ? row_value(row.scene->step) : Json(nullptr);
  add_failure(json, row.scene.value_or(SceneLimit{}));
  return json;
}

Json row_json(const MatrixRow& row) {
  return {{"case", row.name},         {"method", row.method}, {"expected", row.expected},
          {"outcome", row.outcome},   {"ok", row.ok},         {"detail", row_value(row.detail)},
          {"why", row_value(row.why)}};
}

template <class Row>
StabilityTexts texts(Json json, const std::vector<Row>& rows) {
  json["rows"] = Json::array();
  for (const Row& row : rows) json["rows"].push_back(row_json(row));
  return {json_text(json), csv_table(json["rows"])};
}

}  // namespace

StabilityTexts stability_texts(const Scene& scene, const StudyMachine& machine,
                               const StabilityResult& result, const std::string& status) {
  Json tets;
  for (const TetMesh& mesh : scene.problem.body.levels) tets.push_back(mesh.tets.size());
  const Json json = {{"scene", scene.file},
                     {"name", scene.name},
                     {"status", status},
                     {"duration", scene.duration},
                     {"tets", tets},
                     {"material", scene.problem.body.material.model},
                     {"machine", machine_json(machine)},
                     {"left_out", result.left_out}};
  return texts(json, result.rows);
}

StabilityTexts stability_texts(const StudyMachine& machine, const MatrixResult& result,
                               const std::string& status) {
  const Json json = {{"status", status},
                     {"ok", result.ok()},
                     {"machine", machine_json(machine)},
                     {"left_out", result.left_out}};
  return texts(json, result.rows);
}

namespace {

constexpr std::size_t width = 110;

std::string step_or(const std::optional<double>& step, const std::string& none) {
  return step ? *step > 0 ? in_units(*step, "s") : "none" : none;
}

std::string measured_of(const StabilityRow& row) {
  return row.stable_up_to ? "none up to " + in_units(*row.stable_up_to, "s")
                          : step_or(row.measured, "");
}

std::string growth_of(const StabilityRow& row) {
  if (!row.growth_per_second || *row.spectral_radius <= 1 + 1e-6) return "";
  return fmt::format("{:.2g} per second at {}", *row.growth_per_second,
                     in_units(*row.growth_step, "s"));
}

std::string scene_of(const StabilityRow& row) {
  if (!row.scene) return "";
  if (!row.scene->step) return "none tried";
  return (row.scene->failed_step ? "" : "at least ") + in_units(*row.scene->step, "s");
}

std::string failures_text(const StabilityResult& result) {
  std::string text;
  for (const StabilityRow& row : result.rows) {
    if (row.status == "refused")
      text += wrapped(row.label() + " refused: " + row.reason, width, "  ");
    if (row.scene && row.scene->failed_step)
      text += wrapped(
          fmt::format("{} at {}, after {}: {}", row.label(), in_units(*row.scene->failed_step, "s"),
                      in_units(row.scene->failed_time, "s"), row.scene->reason),
          width, "  ");
  }
  return text.empty() ? text : "How they end beyond it:\n" + text;
}

}  // namespace

std::string stability_text(const Scene& scene, const StabilityResult& result,
                           const std::string& folder) {
  const bool own = std::ranges::any_of(
      result.rows, [](const StabilityRow& row) { return row.scene.has_value(); });
  std::vector<std::vector<std::string>> table = {{"largest stable macro step", "predicted",
                                                  "of small motions", "ratio",
                                                  own ? "of the scene" : "", "growth"}};
  for (const StabilityRow& row : result.rows)
    table.push_back({row.label(),
                     step_or(row.predicted, row.status == "refused" ? "refused" : "no limit"),
                     measured_of(row), row.ratio ? fmt::format("{:.3f}", *row.ratio) : "",
                     scene_of(row), growth_of(row)});
  std::string text = fmt::format("{}: {}{}\n", scene.name,
                                 counted(static_cast<long>(result.rows.size()), "method"),
                                 result.stopped ? ", interrupted" : "");
  text += text_table(table, "<>>>>>") + failures_text(result);
  if (!result.left_out.empty())
    text += wrapped(fmt::format("Left out: {}", fmt::join(result.left_out, "; ")), width, "");
  return text + fmt::format(
                    "Files: {0}: stability.json, stability.csv. The picture: python3 "
                    "drivers/plots/stability.py {0}\n",
                    folder);
}

std::string stability_text(const MatrixResult& result, const std::string& folder) {
  std::map<std::string, long> outcomes;
  std::string wrong;
  long wrongs = 0;
  for (const MatrixRow& row : result.rows) {
    const bool differs = row.outcome.starts_with("differs");
    ++outcomes[differs ? row.ok ? "the same but for rounding" : "not the same" : row.outcome];
    if (row.ok) continue;
    ++wrongs;
    wrong += wrapped(fmt::format("{}, {}: {}; expected {}. {}", row.name, row.method, row.outcome,
                                 row.expected, row.detail),
                     width, "  ");
  }
  std::string counts;
  for (const auto& [outcome, count] : outcomes)
    counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, outcome);
  std::string text =
      fmt::format("{}: {}\n", counted(static_cast<long>(result.rows.size()), "case"), counts);
  text += wrongs == 0 ? "Each as expected.\n" : fmt::format("Wrong, {}:\n{}", wrongs, wrong);
  if (result.left_out > 0)
    text += fmt::format("Left out: {}\n", counted(static_cast<long>(result.left_out), "case"));
  return text + fmt::format("Files: {}: stability.json, stability.csv\n", folder);
}

}  // namespace plica::app
