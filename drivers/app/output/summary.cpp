// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/app/output/plan.hpp>
#include <plica/drivers/app/output/problem_json.hpp>
#include <plica/drivers/app/output/row_json.hpp>
#include <plica/drivers/app/output/summary.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/version.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

long steps_to_cover(double duration, double macro_step) {
  constexpr double rounding = 1e-9;  // of a step: 3 s are 100 steps of 30 ms
  constexpr double most = 1e12;
  const double steps = std::ceil(duration / macro_step - rounding);
  if (!(steps <= most))
    throw InputError(fmt::format("a duration of {:g} s is {:.3g} macro steps of {:g} s; expected at most {:g}",
                                 duration, steps, macro_step, most));
  return std::max(1L, std::lround(steps));
}

namespace {

Json diagnosis_json(const std::optional<Diagnosis>& diagnosis) {
  if (!diagnosis) return nullptr;
  const auto index = [](int i) { return i < 0 ? Json(nullptr) : Json(i); };
  return {{"kind", diagnosis->kind},
          {"level", index(diagnosis->level)},
          {"element", index(diagnosis->element)},
          {"vertex", index(diagnosis->vertex)},
          {"region", diagnosis->region},
          {"J", diagnosis->J},
          {"substep_over_critical", diagnosis->substep_over_critical},
          {"motion_over_edge", diagnosis->motion_over_edge},
          {"reason", diagnosis->reason},
          {"remedy", diagnosis->remedy}};
}

}  // namespace

Json levels_json(const std::vector<LevelReport>& levels) {
  Json list = Json::array();
  for (const LevelReport& level : levels) {
    Json stiffest = Json::array();
    for (const StiffElement& e : level.stiffest)
      stiffest.push_back(
          {{"element", e.element}, {"region", e.region}, {"height_ratio", e.height_ratio}, {"step", e.step}});
    list.push_back({{"vertices", level.vertices},
                    {"tets", level.tets},
                    {"mean_edge", level.mean_edge},
                    {"mass", level.mass},
                    {"critical_step", level.critical_step},
                    {"element_bound", level.element_bound},
                    {"share", level.share},
                    {"substeps", level.substeps},
                    {"element", level.element},
                    {"integrator", level.integrator},
                    {"inertia", level.inertia},
                    {"detail_step", level.detail_step},
                    {"outside_down", level.outside_down},
                    {"outside_up", level.outside_up},
                    {"largest_miss", level.largest_miss},
                    {"typical_element", level.typical_element},
                    {"stiffest", stiffest}});
  }
  return list;
}

std::string summary_json(const Scene& scene, const Summary& s, const std::vector<std::string>& words) {
  const Json json = {{"name", scene.name},
                     {"scene", scene.file},
                     {"arguments", words},
                     {"version", version()},
                     {"git_revision", git_revision()},
                     {"compiler", compiler()},
                     {"status", s.status},
                     {"simulated_time", s.simulated_time},
                     {"macro_step", s.macro_step},
                     {"macro_steps", s.macro_steps},
                     {"wall_time", s.wall_time},
                     {"setup_time", s.setup_time},
                     {"peak_memory", s.peak_memory},
                     {"frames", s.frames},
                     {"precision", s.precision},
                     {"backend", s.backend},
                     {"threads", s.threads},
                     {"cycle", s.cycle},
                     {"choice", choice_json(s.choice)},
                     {"levels", levels_json(s.levels)},
                     {"stages", s.stages},
                     {"counters", s.counters},
                     {"residual", s.residual},
                     {"last_good_time", s.last_good_time},
                     {"diagnosis", diagnosis_json(s.diagnosis)},
                     {"obstacles", obstacles_json(scene.problem.contact.obstacles)}};
  return json_text(json);
}

std::string summary_text(const Scene& scene, const Summary& s, const std::string& folder) {
  const double wall = s.wall_time;
  std::string speed;
  if (s.macro_steps > 0)
    speed = fmt::format(" ({:.2f} x real time, {:.3g} steps/s)", s.simulated_time / wall,
                        static_cast<double>(s.macro_steps) / wall);
  const std::string beyond =
      s.status == "completed" && s.simulated_time > scene.duration * (1 + 1e-9)
          ? fmt::format(", the first whole number of steps that covers {:g} s", scene.duration)
      : s.status == "completed" && static_cast<double>(s.macro_steps) * s.macro_step > scene.duration * (1 + 1e-9)
          ? ", the last one shorter"
          : "";
  const std::string last_good =
      s.diagnosis ? fmt::format(", the last good one at {:.5g} s", s.last_good_time) : std::string{};
  const std::vector<std::vector<std::string>> rows = {
      {"simulated", fmt::format("{:.5g} s in {} of {}{}", s.simulated_time, counted(s.macro_steps, "macro step"),
                                in_units(s.macro_step, "s"), beyond)},
      {"stepping", in_units(wall, "s") + speed},
      {"set-up", in_units(s.setup_time, "s") + ", peak memory " + in_bytes(s.peak_memory)},
      {"files", fmt::format("{}: summary.json, history.csv, frames.pvd ({}{})", folder,
                            counted(static_cast<long>(s.frames), "frame"), last_good)}};
  return fmt::format("{}: {}\n", scene.name, s.status) + text_table(rows, "<<");
}

}  // namespace plica::app
