// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/app/output/row_json.hpp>
#include <plica/drivers/app/output/stability_json.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

// At the state with which the scene's own run ended, at the smallest macro step that did not do
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
  return {{"case", row.name},       {"method", row.method}, {"expected", row.expected},
          {"outcome", row.outcome}, {"ok", row.ok},         {"detail", row_value(row.detail)}};
}

template <class Row>
StabilityTexts texts(Json json, const std::vector<Row>& rows) {
  json["rows"] = Json::array();
  for (const Row& row : rows) json["rows"].push_back(row_json(row));
  return {json.dump(2) + "\n", csv_table(json["rows"])};
}

}  // namespace

StabilityTexts stability_texts(const Scene& scene, const StudyMachine& machine, const StabilityResult& result,
                               const std::string& status) {
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

StabilityTexts stability_texts(const StudyMachine& machine, const MatrixResult& result, const std::string& status) {
  const Json json = {
      {"status", status}, {"ok", result.ok()}, {"machine", machine_json(machine)}, {"left_out", result.left_out}};
  return texts(json, result.rows);
}

}  // namespace plica::app
