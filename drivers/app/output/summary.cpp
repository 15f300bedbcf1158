// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/summary.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/solver/elements.hpp>
#include <plica/drivers/solver/set_up/body_parts.hpp>
#include <plica/drivers/solver/set_up/plan_steps.hpp>
#include <plica/version.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

std::string cycle_name(const Scene& scene, const std::optional<CycleChoice>& choice) {
  return choice ? choice->cycle : scene.problem.integration.cycle;
}

std::string choice_text(const CycleChoice& choice) {
  std::string text = "\nCycle auto\n";
  text += wrapped(fmt::format("{} at {:.3g} x the critical step; {}: {}", choice.cycle, choice.over_critical,
                              choice.error_class, choice.reason),
                  98, "  ");
  if (choice.trials.empty()) return text;
  std::vector<std::vector<std::string>> rows = {{"tried", "macro step", "of critical", "error of displacement"}};
  std::string out;
  for (const CycleTrial& trial : choice.trials) {
    rows.push_back({trial.cycle, in_units(trial.macro_step, "s"), fmt::format("{:.3g} x", trial.over_critical),
                    trial.error ? fmt::format("{:.2g} %", 100 * *trial.error) : "none"});
    if (!trial.reason.empty())
      out += wrapped(fmt::format("{} at {:.3g} x: {}", trial.cycle, trial.over_critical, trial.reason), 98, "  ");
  }
  return text + text_table(rows, "<>>>") + out +
         fmt::format("  in trials of {} against level 0 alone{}\n", in_units(choice.duration, "s"),
                     choice.start > 0
                         ? fmt::format(", from {} on, shortly before something touches", in_units(choice.start, "s"))
                         : std::string{});
}

Json choice_json(const std::optional<CycleChoice>& choice) {
  if (!choice) return nullptr;
  Json trials = Json::array();
  for (const CycleTrial& trial : choice->trials)
    trials.push_back({{"cycle", trial.cycle},
                      {"macro_step", trial.macro_step},
                      {"over_critical", trial.over_critical},
                      {"error", trial.error ? Json(*trial.error) : Json(nullptr)},
                      {"reason", trial.reason}});
  return {{"cycle", choice->cycle},
          {"macro_step", choice->macro_step},
          {"over_critical", choice->over_critical},
          {"error_class", choice->error_class},
          {"allowed", choice->allowed},
          {"duration", choice->duration},
          {"start", choice->start},
          {"reason", choice->reason},
          {"trials", trials}};
}

namespace {

bool has_elements(const LevelReport& level) {
  return level.kind == LevelKind::mesh || level.kind == LevelKind::lattice;
}

const char* name_of(LevelKind kind) {
  constexpr const char* names[] = {"mesh", "lattice", "space", "slivers"};
  return names[static_cast<std::size_t>(kind)];
}

// "nodal (stabilisation 0.4), linear; about 8 across the thickness of level 0"
std::string elements_text(const Body& body, const Plan& plan) {
  std::vector<Lame<double>> lame;
  const MaterialInfo& material = *find_material(body.material.model);
  lame.push_back(material.small_strains(parameter_values(material, body.material, {})));
  for (const auto& [name, region] : body.regions)
    lame.push_back(material.small_strains(parameter_values(material, body.material, region)));
  const bool smoothed = smooths_pressure(body, lame);
  std::string text;
  for (const LevelReport& level : plan.levels) {
    if (!has_elements(level)) continue;
    text += (text.empty() ? "" : ", ") + level.element;
    if (level.element == name_of(Element::nodal))
      text += fmt::format(" (stabilisation {:g}{}{})", body.stabilisation, smoothed ? ", pressures smoothed" : "",
                          smoothed && !level.explicit_integrator ? " and carried by implicit steps" : "");
  }
  return text + fmt::format("; about {:.2g} across the thickness of level 0", elements_across(body.levels.front()));
}

std::string head_text(const Scene& scene, const Plan& plan) {
  const MaterialOptions& m = scene.problem.body.material;
  const IntegrationOptions& i = scene.problem.integration;
  const std::string shift =
      i.shift_to_coarsest > 0 ? fmt::format(", {:g} of each to the coarsest", i.shift_to_coarsest) : "";
  return fmt::format("{} ({})\n", scene.name, scene.file) +
         text_table(
             {{"time", fmt::format("{:g} s in {} of {}", scene.duration,
                                   counted(steps_to_cover(scene.duration, plan.macro_step), "macro step"),
                                   in_units(plan.macro_step, "s"))},
              {"cycle",
               fmt::format("{}{}", cycle_name(scene, plan.choice),
                           plan.him || plan.choice ? "" : fmt::format(", {} shares{}", i.distribution, shift))},
              {"material", material_text(*find_material(m.model), m)},
              {"elements", elements_text(scene.problem.body, plan)},
              {"machine", fmt::format("{} on {}, {}", plan.precision, plan.backend, counted(plan.threads, "thread"))}},
             "<<");
}

// What cycle him does with the levels
std::string inertia_text(const Plan& plan) {
  std::vector<std::vector<std::string>> rows = {
      {"level", "inertia of its own detail", "limit of that detail", "macro step / limit"}};
  for (std::size_t i = 0; i < plan.levels.size(); ++i) {
    const LevelReport& level = plan.levels[i];
    const double own = level.detail_step;
    rows.push_back({std::to_string(i), fmt::format("{:.3g} x", level.inertia), own > 0 ? in_units(own, "s") : "",
                    own > 0 ? fmt::format("{:.3g}", plan.macro_step / own) : ""});
  }
  return "\nThe hierarchical inverse mass\n" + text_table(rows, ">>>>") +
         fmt::format(
             "t^2 times the largest eigenvalue of A K at rest: {:.3f}, below 4 is stable; by the levels' own: {:.3f}\n",
             plan.him->product, plan.him->bound);
}

// The elements that set a level's critical step, where they are out of the ordinary: below half the median
std::string slivers_text(const Plan& plan) {
  std::vector<std::vector<std::string>> rows = {
      {"level", "element", "edge / height", "step by itself", "of the median", "region"}};
  for (std::size_t i = 0; i < plan.levels.size(); ++i)
    for (const StiffElement& e : plan.levels[i].stiffest)
      if (const double median = plan.levels[i].typical_element; e.step < named_below * median)
        rows.push_back({std::to_string(i), std::to_string(e.element), fmt::format("{:.3g}", e.height_ratio),
                        in_units(e.step, "s"), fmt::format("{:.2g}", e.step / median), e.region});
  if (rows.size() == 1) return {};
  return "\nElements that limit the step, at most ten of a level\n" + text_table(rows, ">>>>><");
}

// Coarse levels that were made of the finest mesh
std::string spaces_text(const Plan& plan) {
  std::vector<std::vector<std::string>> rows = {{"level", "points", "spacing", "weights per row"}};
  for (std::size_t i = 0; i < plan.levels.size(); ++i) {
    const LevelReport& level = plan.levels[i];
    if (!has_elements(level))
      rows.push_back({std::to_string(i), std::to_string(level.vertices),
                      level.kind == LevelKind::space ? in_units(level.mean_edge, "m") : "slivers follow",
                      fmt::format("{:.1f}", level.nonzeros)});
  }
  return rows.size() == 1 ? "" : "\nCoarse spaces, made of level 0 (body.levels: coarsen)\n" + text_table(rows, ">>>>");
}

// Two tables: what a level is, then what it does in a macro step
std::string levels_text(const Plan& plan) {
  std::vector<std::vector<std::string>> meshes = {
      {"level", "vertices", "tetrahedra", "mean edge", "mass", "critical step", "element bound"}};
  std::vector<std::vector<std::string>> steps = {
      {"level", "share", "time", "sub-steps", "of", "of / critical", "integrator"}};
  for (std::size_t i = 0; i < plan.levels.size(); ++i) {
    const LevelReport& level = plan.levels[i];
    if (!has_elements(level)) continue;
    const std::string filled =
        level.kind == LevelKind::lattice ? fmt::format(", {:.1f} % filled", 100 * level.filled) : "";
    meshes.push_back({std::to_string(i), std::to_string(level.vertices), std::to_string(level.tets) + filled,
                      in_units(level.mean_edge, "m"), in_units(level.mass, "kg"),
                      level.critical_step > 0 ? in_units(level.critical_step, "s") : "",
                      in_units(level.element_bound, "s")});
    if (level.share == 0) continue;
    const double time = level.share * plan.macro_step, substep = time / level.substeps;
    steps.push_back({std::to_string(i), fmt::format("{:.4f}", level.share), in_units(time, "s"),
                     std::to_string(level.substeps), in_units(substep, "s"),
                     fmt::format("{:.2f}", substep / level.critical_step),
                     level.integrator + (level.explicit_integrator ? "" : " (no limit)")});
  }
  const std::string list = "\nLevels, finest first\n" + text_table(meshes, ">>>>>>>") + spaces_text(plan);
  if (plan.him) return list + inertia_text(plan);
  return list + "\nIn a macro step (the coarsest level goes first)\n" + text_table(steps, ">>>>>><");
}

std::string transfers_text(const Plan& plan) {
  if (plan.levels.size() < 2) return {};
  std::vector<std::vector<std::string>> rows = {
      {"levels", "coarse vertices outside", "fine vertices outside", "largest miss / edge"}};
  for (std::size_t i = 1; i < plan.levels.size(); ++i) {
    const LevelReport& level = plan.levels[i];
    if (!has_elements(level)) return {};
    rows.push_back({fmt::format("{} - {}", i - 1, i), std::to_string(level.outside_down),
                    std::to_string(level.outside_up), fmt::format("{:.2g}", level.largest_miss)});
  }
  return "\nBetween the levels\n" + text_table(rows, ">>>>");
}

std::string parts_text(const Plan& plan) {
  std::vector<std::vector<std::string>> rows;
  std::size_t bytes = 0;
  for (const Part& part : plan.parts) {
    rows.push_back({part.in ? "in" : "out", part.name, part.in ? in_bytes(part.bytes) : "", part.reason});
    bytes += part.bytes;
  }
  return fmt::format("\nParts, {} on the device\n", in_bytes(bytes)) + text_table(rows, "<<><");
}

}  // namespace

std::string plan_text(const Scene& scene, const Plan& plan) {
  return head_text(scene, plan) + (plan.choice ? choice_text(*plan.choice) : "") + levels_text(plan) +
         slivers_text(plan) + transfers_text(plan) + parts_text(plan);
}

std::string plan_json(const Scene& scene, const Plan& plan) {
  Json parts = Json::array();
  for (const Part& part : plan.parts)
    parts.push_back({{"name", part.name}, {"in", part.in}, {"reason", part.reason}, {"bytes", part.bytes}});
  const Json json = {{"name", scene.name},
                     {"scene", scene.file},
                     {"duration", scene.duration},
                     {"macro_step", plan.macro_step},
                     {"macro_steps", steps_to_cover(scene.duration, plan.macro_step)},
                     {"cycle", cycle_name(scene, plan.choice)},
                     {"choice", choice_json(plan.choice)},
                     {"precision", plan.precision},
                     {"backend", plan.backend},
                     {"threads", plan.threads},
                     {"levels", levels_json(plan.levels)},
                     {"him", plan.him ? Json{{"product", plan.him->product},
                                             {"bound", plan.him->bound},
                                             {"coarsest_vertices", plan.him->coarsest},
                                             {"all_modes", plan.him->all_modes}}
                                      : Json(nullptr)},
                     {"parts", parts}};
  return json_text(json);
}

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

constexpr double notable_wait = 0.1;  // of the threads' time

Json diagnosis_json(const std::optional<Diagnosis>& diagnosis, const std::vector<Point>& corners) {
  if (!diagnosis) return nullptr;
  Json places = Json::array();
  for (const Point& p : corners) places.push_back({p.x(), p.y(), p.z()});
  const auto index = [](int i) { return i < 0 ? Json(nullptr) : Json(i); };
  return {{"kind", diagnosis->kind},
          {"text", diagnosis->text()},
          {"level", index(diagnosis->level)},
          {"element", index(diagnosis->element)},
          {"vertex", index(diagnosis->vertex)},
          {"region", diagnosis->region},
          {"corners", places},
          {"J", diagnosis->J},
          {"substep_over_critical", diagnosis->substep_over_critical},
          {"motion_over_edge", diagnosis->motion_over_edge},
          {"reason", diagnosis->reason},
          {"remedy", diagnosis->remedy}};
}

Json three(const Point& p) { return {p[0], p[1], p[2]}; }

Json wrenches_json(const std::vector<Wrench>& wrenches) {
  Json all = Json::object();
  for (const Wrench& w : wrenches) all[w.obstacle] = {{"force", three(w.force)}, {"torque", three(w.torque)}};
  return all;
}

Json tools_json(const std::vector<ToolState>& tools) {
  Json all = Json::object();
  for (const ToolState& t : tools)
    all[t.obstacle] = {{"displacement", three(t.displacement)}, {"velocity", three(t.velocity)}};
  return all;
}

}  // namespace

Json levels_json(const std::vector<LevelReport>& levels) {
  Json list = Json::array();
  for (const LevelReport& level : levels) {
    Json stiffest = Json::array();
    for (const StiffElement& e : level.stiffest)
      stiffest.push_back(
          {{"element", e.element}, {"region", e.region}, {"height_ratio", e.height_ratio}, {"step", e.step}});
    list.push_back({{"kind", name_of(level.kind)},
                    {"vertices", level.vertices},
                    {"tets", level.tets},
                    {"filled", level.filled},
                    {"nonzeros_per_row", has_elements(level) ? Json(nullptr) : Json(level.nonzeros)},
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

Json bodies_json(const Body& body) {
  Json list = Json::array();
  std::vector<int> vertices(body.parts.size(), 0);
  if (!body.levels.empty())
    for (const int part : parts_of_vertices(body.levels.front(), body.parts))
      ++vertices[static_cast<std::size_t>(part)];
  for (std::size_t i = 0; i < body.parts.size(); ++i)
    list.push_back({{"name", body.parts[i].name}, {"vertices", vertices[i]}, {"surface_points", body.parts[i].points}});
  return list;
}

std::string summary_json(const Scene& scene, const Summary& s, const std::vector<std::string>& words) {
  const Point& gravity = scene.problem.gravity;
  const Json json = {{"name", scene.name},
                     {"scene", scene.file},
                     {"gravity", {gravity.x(), gravity.y(), gravity.z()}},
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
                     {"wait_share", s.wait_share ? Json(*s.wait_share) : Json()},
                     {"cycle", s.cycle},
                     {"choice", choice_json(s.choice)},
                     {"bodies", bodies_json(scene.problem.body)},
                     {"levels", levels_json(s.levels)},
                     {"stages", s.stages},
                     {"counters", s.counters},
                     {"residual", s.residual},
                     {"last_good_time", s.last_good_time},
                     {"diagnosis", diagnosis_json(s.diagnosis, s.diagnosed)},
                     {"obstacles", obstacles_json(scene.problem.contact)},
                     {"wrenches", wrenches_json(s.wrenches)},
                     {"tools", tools_json(s.tools)}};
  return json_text(json);
}

namespace {

// "20 linear systems, 211 iterations each, 0 not solved; 60 of Newton's iterations, 0 steps not solved"; empty: none
std::string solves_text(const Summary& s) {
  const auto count = [&](const char* name) {
    const auto found = s.counters.find(name);
    return found == s.counters.end() ? 0L : found->second;
  };
  const long solves = count("linear_solves");
  if (solves == 0) return "";
  std::string text =
      fmt::format("{}, {:.3g} iterations each, {} not solved", counted(solves, "linear system"),
                  static_cast<double>(count("cg_iterations")) / static_cast<double>(solves), count("cg_misses"));
  if (const long newtons = count("newton_iterations"); newtons > 0)
    text +=
        fmt::format("; {} of Newton's method, {} not solved", counted(newtons, "iteration"), count("newton_misses"));
  return text;
}

}  // namespace

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
  const std::string waited = s.wait_share.value_or(0) > notable_wait
                                 ? fmt::format(", {:.0f} % of the threads' time without a core: other work has them{}",
                                               100 * *s.wait_share, s.threads > 1 ? ", --threads 1 may be faster" : "")
                                 : "";
  std::vector<std::vector<std::string>> rows = {
      {"simulated", fmt::format("{:.5g} s in {} of {}{}", s.simulated_time, counted(s.macro_steps, "macro step"),
                                in_units(s.macro_step, "s"), beyond)},
      {"stepping", in_units(wall, "s") + speed + waited},
      {"set-up", in_units(s.setup_time, "s") + ", peak memory " + in_bytes(s.peak_memory)},
      {"files", fmt::format("{}: summary.json, history.csv, frames.pvd ({}{})", folder,
                            counted(static_cast<long>(s.frames), "frame"), last_good)},
      {"to look at", "plica report " + folder}};
  if (const std::string solves = solves_text(s); !solves.empty()) rows.insert(rows.begin() + 2, {"solving", solves});
  return fmt::format("{}: {}\n", scene.name, s.status) + text_table(rows, "<<");
}

}  // namespace plica::app
