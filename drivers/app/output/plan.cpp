// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/output/cycle_choice.hpp>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/summary.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/body/body_parts.hpp>
#include <plica/drivers/cycles/him/advice.hpp>
#include <plica/drivers/cycles/plan_steps.hpp>
#include <plica/drivers/elastic/elements.hpp>

// Output of `plica explain`.
namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

// Returns the elements of the levels: "nodal (stabilisation 0.4), linear; about 8 across the
// thickness of level 0"
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
      text += fmt::format(
          " (stabilisation {:g}{}{})", body.stabilisation, smoothed ? ", pressures smoothed" : "",
          smoothed && !level.explicit_integrator ? " and carried by implicit steps" : "");
  }
  return text + fmt::format("; about {:.2g} across the thickness of level 0",
                            elements_across(body.levels.front()));
}

std::string head_text(const Scene& scene, const Plan& plan) {
  const MaterialOptions& m = scene.problem.body.material;
  const IntegrationOptions& i = scene.problem.integration;
  const std::string shift = i.shift_to_coarsest > 0
                                ? fmt::format(", {:g} of each to the coarsest", i.shift_to_coarsest)
                                : "";
  return fmt::format("{} ({})\n", scene.name, scene.file) +
         text_table(
             {{"time", fmt::format("{:g} s in {} of {}", scene.duration,
                                   counted(steps_of(scene, plan.macro_step), "macro step"),
                                   in_units(plan.macro_step, "s"))},
              {"cycle", fmt::format("{}{}", cycle_name(scene, plan.choice),
                                    plan.him || plan.choice
                                        ? ""
                                        : fmt::format(", {} shares{}", i.distribution, shift))},
              {"material", material_text(*find_material(m.model), m)},
              {"elements", elements_text(scene.problem.body, plan)},
              {"machine", fmt::format("{} on {}, {}", plan.precision, plan.backend,
                                      counted(plan.threads, "thread"))}},
             "<<");
}

// Returns what cycle him does with the levels, as text
std::string inertia_text(const Scene& scene, const Plan& plan) {
  std::vector<std::vector<std::string>> rows = {
      {"level", "inertia of its own detail", "limit of that detail", "macro step / limit"}};
  for (std::size_t i = 0; i < plan.levels.size(); ++i) {
    const LevelReport& level = plan.levels[i];
    const double own = level.detail_step;
    rows.push_back({std::to_string(i), fmt::format("{:.3g} x", level.inertia),
                    own > 0 ? in_units(own, "s") : "",
                    own > 0 ? fmt::format("{:.3g}", plan.macro_step / own) : ""});
  }
  std::string advice;
  for (const std::string& sentence :
       him_advice(scene.problem, *plan.him, plan.levels, plan.macro_step))
    advice += wrapped(sentence, 98, "  ");
  return "\nThe hierarchical inverse mass\n" + text_table(rows, ">>>>") +
         fmt::format(
             "t^2 times the largest eigenvalue of A K at rest: {:.3f}, below 4 is stable; by the "
             "levels' own: {:.3f}\n",
             plan.him->product, plan.him->bound) +
         advice;
}

// Returns the table of elements whose own step is below half the median of their level. They limit
// the critical step of the level
std::string slivers_text(const Plan& plan) {
  std::vector<std::vector<std::string>> rows = {
      {"level", "element", "edge / height", "step by itself", "of the median", "region"}};
  for (std::size_t i = 0; i < plan.levels.size(); ++i)
    for (const StiffElement& e : plan.levels[i].stiffest)
      if (const double median = plan.levels[i].typical_element; e.step < named_below * median)
        rows.push_back({std::to_string(i), std::to_string(e.element),
                        fmt::format("{:.3g}", e.height_ratio), in_units(e.step, "s"),
                        fmt::format("{:.2g}", e.step / median), e.region});
  if (rows.size() == 1) return {};
  return "\nElements that limit the step, at most ten of a level\n" + text_table(rows, ">>>>><");
}

// Returns the table of coarse spaces that were made of the finest mesh
std::string spaces_text(const Plan& plan) {
  std::vector<std::vector<std::string>> rows = {{"level", "points", "spacing", "weights per row"}};
  for (std::size_t i = 0; i < plan.levels.size(); ++i) {
    const LevelReport& level = plan.levels[i];
    if (!has_elements(level))
      rows.push_back(
          {std::to_string(i), std::to_string(level.vertices),
           level.kind == LevelKind::space ? in_units(level.mean_edge, "m") : "slivers follow",
           fmt::format("{:.1f}", level.nonzeros)});
  }
  return rows.size() == 1 ? "" : "\nCoarse spaces, made of level 0\n" + text_table(rows, ">>>>");
}

// Returns the table of the pieces of levels that are finer in a part of the body
std::string pieces_text(const Plan& plan) {
  std::vector<std::vector<std::string>> rows = {{"level", "piece", "tetrahedra", "followers", "cut",
                                                 "dropped", "least filled", "mass", "covered"}};
  for (std::size_t i = 0; i < plan.levels.size(); ++i)
    for (const PieceReport& piece : plan.levels[i].pieces)
      rows.push_back({std::to_string(i), std::to_string(&piece - plan.levels[i].pieces.data()),
                      std::to_string(piece.tets), std::to_string(piece.followers),
                      std::to_string(piece.cut), std::to_string(piece.dropped),
                      fmt::format("{:.2g}", piece.least_filled), in_units(piece.mass, "kg"),
                      fmt::format("{:.3g} m^3", piece.covered)});
  return rows.size() == 1 ? ""
                          : "\nPieces of levels, finest first\n" + text_table(rows, ">>>>>>>>>");
}

// Returns two tables: the sizes of the levels, then their work in a macro step
std::string levels_text(const Scene& scene, const Plan& plan) {
  std::vector<std::vector<std::string>> meshes = {
      {"level", "vertices", "tetrahedra", "mean edge", "mass", "critical step", "element bound"}};
  std::vector<std::vector<std::string>> steps = {
      {"level", "share", "time", "sub-steps", "of", "of / critical", "integrator"}};
  for (std::size_t i = 0; i < plan.levels.size(); ++i) {
    const LevelReport& level = plan.levels[i];
    if (!has_elements(level)) continue;
    const std::string filled = level.kind == LevelKind::lattice
                                   ? fmt::format(", {:.1f} % filled", 100 * level.filled)
                                   : "";
    meshes.push_back({std::to_string(i), std::to_string(level.vertices),
                      std::to_string(level.tets) + filled, in_units(level.mean_edge, "m"),
                      in_units(level.mass, "kg"),
                      level.critical_step > 0 ? in_units(level.critical_step, "s") : "",
                      in_units(level.element_bound, "s")});
    if (level.share == 0) continue;
    const double time = level.share * plan.macro_step, substep = time / level.substeps;
    steps.push_back({std::to_string(i), fmt::format("{:.4f}", level.share), in_units(time, "s"),
                     std::to_string(level.substeps), in_units(substep, "s"),
                     fmt::format("{:.2f}", substep / level.critical_step),
                     level.integrator + (level.explicit_integrator ? "" : " (no limit)")});
  }
  const std::string list = "\nLevels, finest first\n" + text_table(meshes, ">>>>>>>") +
                           pieces_text(plan) + spaces_text(plan);
  if (plan.him) return list + inertia_text(scene, plan);
  return list + "\nIn a macro step (the coarsest level goes first)\n" +
         text_table(steps, ">>>>>><");
}

std::string transfers_text(const Plan& plan) {
  std::vector<std::vector<std::string>> rows = {
      {"levels", "coarse vertices outside", "fine vertices outside", "largest miss / edge"}};
  for (std::size_t i = 1, finer = 0; i < plan.levels.size(); ++i) {
    const LevelReport& level = plan.levels[i];
    if (!has_elements(level)) continue;
    rows.push_back({fmt::format("{} - {}", finer, i), std::to_string(level.outside_down),
                    std::to_string(level.outside_up), fmt::format("{:.2g}", level.largest_miss)});
    finer = i;
  }
  return rows.size() == 1 ? "" : "\nBetween the levels\n" + text_table(rows, ">>>>");
}

const Table<Part> part_columns = {
    {"", [](const Part& part) { return part.in ? "in" : "out"; }, {""}},
    {"name", &Part::name, {""}},
    {"in", &Part::in},
    {"", [](const Part& part) { return part.in ? in_bytes(part.bytes) : ""; }, {"", "{}"}},
    {"reason", &Part::reason, {""}},
    {"bytes", &Part::bytes}};

std::string parts_text(const Plan& plan) {
  std::size_t bytes = 0;
  for (const Part& part : plan.parts) bytes += part.bytes;
  return fmt::format("\nParts, {} on the device\n", in_bytes(bytes)) +
         part_columns.text(plan.parts);
}

// Returns the size of what a rank receives for a force [bytes]
double bytes_of_force(const Plan& plan, const RankPlan& rank) {
  const bool nodal = plan.levels.front().element == name_of(Element::nodal);
  const double numbers = nodal ? 3 + 12 : 3;  // numbers of a row: a vertex and a record, or a share
  return numbers * (plan.precision == "float" ? 4 : 8) * static_cast<double>(rank.received);
}

std::string ranks_text(const Plan& plan) {
  if (plan.ranks.empty()) return {};
  std::vector<std::vector<std::string>> rows = {{"", "mean", "most"}};
  double imbalance = 1;
  const auto add = [&](const char* what, const auto& value, const auto& shown) {
    double sum = 0, most = 0;
    for (const RankPlan& rank : plan.ranks) {
      const auto one = static_cast<double>(value(rank));
      sum += one, most = std::max(most, one);
    }
    const double mean = sum / static_cast<double>(plan.ranks.size());
    rows.push_back({what, shown(mean), shown(most)});
    return mean > 0 ? most / mean : 1;
  };
  const auto number = [](double x) { return fmt::format("{:.0f}", x); };
  imbalance = add(
      "tetrahedra", [](const RankPlan& r) { return r.tets; }, number);
  add(
      "vertices", [](const RankPlan& r) { return r.vertices; }, number);
  add(
      "copies of others' vertices", [](const RankPlan& r) { return r.copies; }, number);
  add(
      "neighbours", [](const RankPlan& r) { return r.neighbours; }, number);
  add(
      "rows received", [](const RankPlan& r) { return r.received; }, number);
  add(
      "received for a force", [&](const RankPlan& r) { return bytes_of_force(plan, r); },
      [](double x) { return in_bytes(static_cast<std::size_t>(x)); });
  return fmt::format("\nOn {} ranks, imbalance {:.2f}\n", plan.ranks.size(), imbalance) +
         text_table(rows, "<>>");
}

Json ranks_json(const Plan& plan) {
  Json all = Json::array();
  for (const RankPlan& r : plan.ranks)
    all.push_back({{"tets", r.tets},
                   {"vertices", r.vertices},
                   {"copies", r.copies},
                   {"neighbours", r.neighbours},
                   {"rows_sent", r.sent},
                   {"rows_received", r.received},
                   {"bytes_received", bytes_of_force(plan, r)}});
  return all;
}

}  // namespace

std::string plan_text(const Scene& scene, const Plan& plan) {
  return head_text(scene, plan) + (plan.choice ? choice_text(*plan.choice) : "") +
         levels_text(scene, plan) + slivers_text(plan) + transfers_text(plan) + parts_text(plan) +
         ranks_text(plan);
}

std::string plan_json(const Scene& scene, const Plan& plan) {
  Json json = {{"name", scene.name},
               {"scene", scene.file},
               {"duration", scene.duration},
               {"macro_step", plan.macro_step},
               {"macro_steps", steps_of(scene, plan.macro_step)},
               {"cycle", cycle_name(scene, plan.choice)},
               {"choice", choice_json(plan.choice)},
               {"precision", plan.precision},
               {"backend", plan.backend},
               {"threads", plan.threads},
               {"levels", levels_json(plan.levels)},
               {"him", plan.him ? Json{{"product", plan.him->product},
                                       {"bound", plan.him->bound},
                                       {"coarsest_vertices", plan.him->coarsest},
                                       {"all_modes", plan.him->all_modes},
                                       {"advice", him_advice(scene.problem, *plan.him, plan.levels,
                                                             plan.macro_step)}}
                                : Json(nullptr)},
               {"parts", part_columns.json(plan.parts)}};
  if (!plan.ranks.empty()) json["ranks"] = ranks_json(plan);
  return json_text(json);
}

}  // namespace plica::app
