// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/stability_table.hpp>
#include <plica/drivers/app/output/terminal.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

// Returns a function of the scene's own limit, as one of the row; null: there is no such limit
template <class Get>
auto from_scene(Get get) {
  return [get](const StabilityRow& row) {
    return row.scene ? or_null(std::invoke(get, *row.scene)) : Json();
  };
}

// Returns the same of the state with which the scene's run failed
template <class Get>
auto from_failure(Get get) {
  return from_scene([get](const SceneLimit& scene) {
    return scene.failure ? or_null(std::invoke(get, *scene.failure)) : Json();
  });
}

Json if_known(int index) { return index >= 0 ? Json(index) : Json(); }

const Table<StabilityRow> stability_columns = {
    {"method", &StabilityRow::method},
    {"distribution", &StabilityRow::distribution},
    {"variant", &StabilityRow::variant},
    {"integrator", &StabilityRow::integrator},
    {"status", &StabilityRow::status},
    {"reason", &StabilityRow::reason},
    {"critical_step", &StabilityRow::critical_step},
    {"predicted", &StabilityRow::predicted},
    {"measured", &StabilityRow::measured},
    {"ratio", &StabilityRow::ratio},
    {"stable_up_to", &StabilityRow::stable_up_to},
    {"growth_step", &StabilityRow::growth_step},
    {"spectral_radius", &StabilityRow::spectral_radius},
    {"growth_per_second", &StabilityRow::growth_per_second},
    {"scene_measured", from_scene(&SceneLimit::step)},
    {"scene_failed_step", from_scene(&SceneLimit::failed_step)},
    {"scene_failed_time",
     from_scene([](const SceneLimit& s) { return s.failed_step ? Json(s.failed_time) : Json(); })},
    {"scene_reason", from_scene(&SceneLimit::reason)},
    {"scene_kind", from_failure(&Diagnosis::kind)},
    {"scene_region", from_failure(&Diagnosis::region)},
    {"scene_level", from_failure(&Diagnosis::level)},
    {"scene_element", from_failure([](const Diagnosis& d) { return if_known(d.element); })},
    {"scene_vertex", from_failure([](const Diagnosis& d) { return if_known(d.vertex); })},
    {"scene_J",
     from_failure([](const Diagnosis& d) { return d.element >= 0 ? Json(d.J) : Json(); })}};

const Table<MatrixRow> matrix_columns = {{"case", &MatrixRow::name},
                                         {"method", &MatrixRow::method},
                                         {"expected", &MatrixRow::expected},
                                         {"outcome", &MatrixRow::outcome},
                                         {"ok", &MatrixRow::ok},
                                         {"detail", &MatrixRow::detail},
                                         {"why", &MatrixRow::why}};

template <class Row>
StabilityTexts texts(Json json, const Table<Row>& columns, const std::vector<Row>& rows) {
  json["rows"] = with_nulls(columns.json(rows));
  return {json_text(json), csv_table(json["rows"], columns.json(Row()))};
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
  return texts(json, stability_columns, result.rows);
}

StabilityTexts stability_texts(const StudyMachine& machine, const MatrixResult& result,
                               const std::string& status) {
  const Json json = {{"status", status},
                     {"ok", result.ok()},
                     {"machine", machine_json(machine)},
                     {"left_out", result.left_out}};
  return texts(json, matrix_columns, result.rows);
}

namespace {

constexpr std::size_t width = 110;

std::string step_or(const std::optional<double>& step, const std::string& none) {
  return step ? *step > 0 ? in_units(*step, "s") : "none" : none;
}

std::string predicted_of(const StabilityRow& row) {
  return step_or(row.predicted, row.status == "refused" ? "refused" : "no limit");
}

std::string measured_of(const StabilityRow& row) {
  return row.stable_up_to ? "none up to " + in_units(*row.stable_up_to, "s")
                          : step_or(row.measured, "");
}

std::string growth_of_small_motions(const StabilityRow& row) {
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
  const Table<StabilityRow> table = {{"", &StabilityRow::label, {"largest stable macro step"}},
                                     {"", predicted_of, {"predicted", "{}"}},
                                     {"", measured_of, {"of small motions", "{}"}},
                                     {"", &StabilityRow::ratio, {"ratio", "{:.3f}"}},
                                     {"", scene_of, {own ? "of the scene" : "", "{}"}},
                                     {"", growth_of_small_motions, {"growth", "{}"}}};
  std::string text = fmt::format("{}: {}{}\n", scene.name,
                                 counted(static_cast<long>(result.rows.size()), "method"),
                                 result.stopped ? ", interrupted" : "");
  text += table.text(result.rows) + failures_text(result);
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
