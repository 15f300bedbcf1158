// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/output/cycle_choice.hpp>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/summary.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/body/body_parts.hpp>
#include <plica/drivers/cycles/plan_steps.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/drivers/methods/rest.hpp>
#include <plica/drivers/run/energy_meter.hpp>
#include <plica/version.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

std::string cycle_name(const Scene& scene, const std::optional<CycleChoice>& choice) {
  return choice ? choice->cycle : scene.problem.integration.cycle;
}

long steps_to_cover(double duration, double macro_step) {
  constexpr double rounding = 1e-9;  // part of a step that is ignored: 3 s are 100 steps of 30 ms
  constexpr double most = 1e12;
  const double steps = std::ceil(duration / macro_step - rounding);
  if (!(steps <= most))
    throw InputError(
        fmt::format("duration: {:g} s are {:.3g} macro steps of {:g} s; expected at most {:g}",
                    duration, steps, macro_step, most));
  return std::max(1L, std::lround(steps));
}

long steps_of(const Scene& scene, double macro_step) {
  try {
    return steps_to_cover(scene.duration, macro_step);
  } catch (const InputError& error) {
    throw located(error, scene.source);
  }
}

namespace {

constexpr double notable_wait = 0.1;  // part of the threads' time

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
  for (const Wrench& w : wrenches)
    all[w.obstacle] = {{"force", three(w.force)}, {"torque", three(w.torque)}};
  return all;
}

Json reactions_json(const std::vector<Reaction>& reactions) {
  Json all = Json::object();
  for (const Reaction& r : reactions)
    all[r.set] = {
        {"force", three(r.force)}, {"torque", three(r.torque)}, {"about", three(r.about)}};
  return all;
}

Json tools_json(const std::vector<ToolState>& tools) {
  Json all = Json::object();
  for (const ToolState& t : tools) {
    Json& tool = all[t.obstacle] = {{"displacement", three(t.displacement)},
                                    {"velocity", three(t.velocity)}};
    if (!t.turns) continue;
    tool["rotation"] = three(t.rotation), tool["angular_velocity"] = three(t.angular_velocity);
  }
  return all;
}

// Returns a largest depth of a surface in an obstacle or a body; null: it did not come inside
Json penetration_json(const Penetration& p, double edge) {
  if (!(p.depth > 0)) return nullptr;
  return {{"depth", p.depth},
          {"over_edge", edge > 0 ? Json(p.depth / edge) : Json(nullptr)},
          {"time", p.time}};
}

Json penetrations_json(const Penetrations& all) {
  Json obstacles = Json::object();
  for (std::size_t o = 0; o < all.obstacles.size(); ++o)
    obstacles[all.obstacles[o]] = penetration_json(all.deepest[o], all.edge);
  return {{"obstacles", obstacles},
          {"bodies", all.pairs ? penetration_json(all.deepest.back(), all.edge) : Json()}};
}

Json held_json(const std::vector<HeldBy>& held) {
  Json all = Json::object();
  for (const HeldBy& h : held) all[h.obstacle] = h.points.size();
  return all;
}

}  // namespace

bool has_elements(const LevelReport& level) {
  return level.kind != LevelKind::space && level.kind != LevelKind::slivers;
}

const char* level_kind_name(LevelKind kind) {
  constexpr const char* names[] = {"mesh", "lattice", "space", "slivers", "part"};
  return names[static_cast<std::size_t>(kind)];
}

Json levels_json(const std::vector<LevelReport>& levels) {
  static const Table<StiffElement> stiffest = {{"element", &StiffElement::element},
                                               {"region", &StiffElement::region},
                                               {"height_ratio", &StiffElement::height_ratio},
                                               {"step", &StiffElement::step}};
  static const Table<PieceReport> pieces = {{"tets", &PieceReport::tets},
                                            {"followers", &PieceReport::followers},
                                            {"cut", &PieceReport::cut},
                                            {"dropped", &PieceReport::dropped},
                                            {"mass", &PieceReport::mass},
                                            {"covered_volume", &PieceReport::covered},
                                            {"least_filled", &PieceReport::least_filled}};
  static const Table<LevelReport> columns = {
      {"kind", [](const LevelReport& level) { return level_kind_name(level.kind); }},
      {"vertices", &LevelReport::vertices},
      {"tets", &LevelReport::tets},
      {"filled", &LevelReport::filled},
      part("pieces", &LevelReport::pieces, pieces),
      {"nonzeros_per_row",
       [](const LevelReport& level) {
         return has_elements(level) ? Json() : Json(level.nonzeros);
       }},
      {"mean_edge", &LevelReport::mean_edge},
      {"mass", &LevelReport::mass},
      {"critical_step", &LevelReport::critical_step},
      {"element_bound", &LevelReport::element_bound},
      {"share", &LevelReport::share},
      {"substeps", &LevelReport::substeps},
      {"element", &LevelReport::element},
      {"integrator", &LevelReport::integrator},
      {"inertia", &LevelReport::inertia},
      {"detail_step", &LevelReport::detail_step},
      {"outside_down", &LevelReport::outside_down},
      {"outside_up", &LevelReport::outside_up},
      {"largest_miss", &LevelReport::largest_miss},
      {"typical_element", &LevelReport::typical_element},
      part("stiffest", &LevelReport::stiffest, stiffest)};
  Json all = columns.json(levels);
  for (Json& level : all)  // levels of one piece have no list of them
    if (level["pieces"].empty()) level.erase("pieces");
  return all;
}

Json bodies_json(const Body& body) {
  Json list = Json::array();
  std::vector<int> vertices(body.parts.size(), 0);
  if (!body.levels.empty())
    for (const int part : parts_of_vertices(body.levels.front(), body.parts))
      ++vertices[static_cast<std::size_t>(part)];
  for (std::size_t i = 0; i < body.parts.size(); ++i)
    list.push_back({{"name", body.parts[i].name},
                    {"vertices", vertices[i]},
                    {"surface_points", body.parts[i].points}});
  return list;
}

std::string summary_json(const Scene& scene, const Summary& s,
                         const std::vector<std::string>& words) {
  const Point& gravity = scene.problem.gravity;
  Json json = {{"name", scene.name},
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
               {"wait_share", or_null(s.wait_share)},
               {"cycle", s.cycle},
               {"choice", choice_json(s.choice)},
               {"bodies", bodies_json(scene.problem.body)},
               {"levels", levels_json(s.levels)},
               {"stages", s.stages},
               {"counters", s.counters},
               {"residual", s.residual},
               {"last_good_time", s.last_good_time},
               {"diagnosis", diagnosis_json(s.diagnosis, s.diagnosed)},
               {"warnings", s.warnings},
               {"obstacles", obstacles_json(scene.problem.contact)},
               {"wrenches", wrenches_json(s.wrenches)},
               {"reactions", reactions_json(s.reactions)},
               {"tools", tools_json(s.tools)},
               {"held", held_json(s.held)},
               {"penetration", penetrations_json(s.penetrations)}};
  if (s.cuts)
    json["cuts"] = {{"opened_faces", s.cuts->opened_faces},
                    {"new_vertices", s.cuts->new_vertices},
                    {"pieces", s.cuts->pieces}};
  if (s.followed)
    json["followed"] = {{"moves", s.followed->moves}, {"wall_time", s.followed->seconds}};
  if (s.ranks) {
    const double time = std::max(s.wall_time, std::numeric_limits<double>::min());
    json["ranks"] = {{"count", s.ranks->count},
                     {"imbalance", s.ranks->imbalance},
                     {"messages", s.ranks->messages},
                     {"bytes", s.ranks->bytes},
                     {"wait_share", s.ranks->waited / time},
                     {"most_wait_share", s.ranks->most_waited / time}};
  }
  return json_text(json);
}

// Returns how linear systems were solved: "20 linear systems, 211 iterations each, 0 not solved".
// Empty: there were none
static std::string solves_text(std::map<std::string, long> count) {
  if (count["linear_solves"] == 0) return "";
  const std::string text = fmt::format(
      "{}, {:.3g} iterations each, {} not solved", counted(count["linear_solves"], "linear system"),
      static_cast<double>(count["cg_iterations"]) / static_cast<double>(count["linear_solves"]),
      count["cg_misses"]);
  if (count["newton_iterations"] == 0) return text;
  return text + fmt::format("; {} of Newton's method, {} not solved",
                            counted(count["newton_iterations"], "iteration"),
                            count["newton_misses"]);
}

// Returns how often sub-steps were cut; empty: never. Example: "cut 4 times as the body stiffened,
// given back 2 times, at the end 2 in a macro step"
static std::string cuts_text(std::map<std::string, long> count) {
  const long cuts = cuts_of(count), back = count["substeps_regained"], now = count["him_substeps"],
             level_alone = count["him_explicit_steps"];
  if (cuts == 0) return "";
  std::string text = fmt::format("cut {} as the body stiffened", counted(cuts, "time"));
  if (back > 0) text += fmt::format(", given back {}", counted(back, "time"));
  if (now > 0) text += fmt::format(", at the end {} in a macro step", now);
  if (level_alone > 0)
    text += fmt::format("; {} by explicit steps of level 0, as cycle single",
                        counted(level_alone, "macro step"));
  return text;
}

// Returns how often macro steps were halved: "halved 5 times where they failed (step_halvings of
// history.csv)". Empty: never
static std::string halvings_text(const std::map<std::string, long>& count) {
  const auto found = count.find("step_halvings");
  if (found == count.end() || found->second == 0) return "";
  return fmt::format("halved {} where they failed (step_halvings of history.csv)",
                     counted(found->second, "time"));
}

std::string unsolved_text(std::map<std::string, long> count) {
  // Newton's method corrects for linear systems that were not solved, so only its misses count
  const bool newton = count["newton_iterations"] > 0;
  const long missed = count[newton ? "newton_misses" : "cg_misses"];
  if (missed == 0) return "";
  return fmt::format(
      "integration.implicit: {} not solved as far as asked, and the run went on: expected a "
      "smaller "
      "integration.macro_step, or more integration.implicit.{}",
      counted(missed, newton ? "step" : "linear system") + (missed == 1 ? " was" : " were"),
      newton ? "newton_iterations" : "max_iterations");
}

std::string mostly_explicit_text(std::map<std::string, long> count, long macro_steps) {
  const long level_alone = count["him_explicit_steps"];
  if (2 * level_alone <= macro_steps) return "";
  return fmt::format(
      "cycle him: {} of {} were taken by explicit steps of level 0, since steps longer than those "
      "were not stable as "
      "the body "
      "stiffened; expected cycle: single, which takes these without the set-up",
      level_alone, counted(macro_steps, "macro step"));
}

std::string many_steps_text(const Scene& scene, const Summary& s) {
  constexpr double many = 1e6;
  const double steps = scene.duration / s.macro_step;
  if (!(steps > many)) return "";
  std::vector<std::string> remedies;
  if (scene.problem.integration.macro_step) remedies.emplace_back("a longer one");
  if (std::ranges::any_of(s.levels, [](const auto& level) {
        return level.share > 0 && level.explicit_integrator;
      })) {
    remedies.emplace_back("an implicit integrator");
    if (s.cycle != "him") remedies.emplace_back("cycle: him");
    remedies.emplace_back("a mesh without slivers (plica explain names them)");
    remedies.emplace_back("a poisson_ratio further from 0.5");
  }
  return fmt::format("integration.macro_step: the run takes {:.2g} macro steps of {}; expected {}",
                     steps, in_units(s.macro_step, "s"), fmt::join(remedies, ", or "));
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
      : s.status == "completed" &&
              static_cast<double>(s.macro_steps) * s.macro_step > scene.duration * (1 + 1e-9)
          ? ", the last one shorter"
          : "";
  const std::string last_good =
      s.diagnosis ? fmt::format(", the last good one at {:.5g} s", s.last_good_time)
                  : std::string{};
  const std::string waited =
      s.wait_share.value_or(0) > notable_wait
          ? fmt::format(", {:.0f} % of the threads' time without a core: other work has them{}",
                        100 * *s.wait_share, s.threads > 1 ? ", fewer threads were tried" : "")
          : "";
  std::vector<std::vector<std::string>> rows = {
      {"simulated",
       fmt::format("{:.5g} s in {} of {}{}", s.simulated_time, counted(s.macro_steps, "macro step"),
                   in_units(s.macro_step, "s"), beyond)},
      {"stepping", in_units(wall, "s") + speed + waited},
      {"set-up", in_units(s.setup_time, "s") + ", peak memory " + in_bytes(s.peak_memory)},
      {"files", fmt::format("{}: summary.json, history.csv, frames.pvd ({}{})", folder,
                            counted(static_cast<long>(s.frames), "frame"), last_good)},
      {"to look at", "plica report " + shell_word(folder)}};
  if (const std::string solves = solves_text(s.counters); !solves.empty())
    rows.insert(rows.begin() + 2, {"solving", solves});
  if (seeks_rest(scene.problem.integration) && !s.diagnosis)
    rows.insert(rows.begin() + 1,
                {"at rest", fmt::format("in all load steps; at most {:.2g} of the forces are not "
                                        "balanced (residual)",
                                        s.residual)});
  if (const std::string halved = halvings_text(s.counters); !halved.empty())
    rows.insert(rows.begin() + 1, {"macro steps", halved});
  if (const std::string cuts = cuts_text(s.counters); !cuts.empty())
    rows.insert(rows.begin() + 2, {"sub-steps", cuts});
  if (s.cuts)
    rows.insert(
        rows.begin() + 1,
        {"cuts",
         fmt::format("{} opened, {} new, {} of the body", counted(s.cuts->opened_faces, "face"),
                     s.cuts->new_vertices == 1 ? "1 vertex"
                                               : fmt::format("{} vertices", s.cuts->new_vertices),
                     counted(s.cuts->pieces, "piece"))});
  if (s.followed)
    rows.insert(rows.begin() + 1, {"part", fmt::format("made anew {} as it followed, in {}",
                                                       counted(s.followed->moves, "time"),
                                                       in_units(s.followed->seconds, "s"))});
  if (s.choice) rows.insert(rows.begin() + 1, {"cycle auto", choice_line(*s.choice)});
  return fmt::format("{}: {}\n", scene.name, s.status) + text_table(rows, "<<");
}

}  // namespace plica::app
