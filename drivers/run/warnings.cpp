// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/body/initial_state.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/methods/rest.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/compare_levels.hpp>
#include <plica/meshes/composite.hpp>
#include <plica/meshes/mesh_quality.hpp>

namespace plica {

namespace {

MeshSize size_of_level(const Body& body, std::size_t level) {
  TetMesh mesh = body.levels[level];
  add_regions(mesh, body.regions, static_cast<int>(level));
  return mesh_size(mesh, region_densities(body, mesh));
}

// Warns of coarse levels that may be another body. Where one certainly is, the set-up refuses it.
void doubt_levels(const Problem& problem, std::vector<std::string>& sentences) {
  const bool automatic = problem.integration.cycle == "auto";
  if (!automatic && !uses_coarse_levels(problem.integration.cycle)) return;
  MeshSize finest;
  for (std::size_t i = 0; i < problem.body.levels.size(); ++i) {
    const MeshSize size = size_of_level(problem.body, i);
    if (i == 0) finest = size;
    const LevelComparison found = compare_levels(finest, size, i);
    if (found.same == SameBody::doubtful || (automatic && found.same == SameBody::no))
      sentences.push_back("body.levels: " + found.sentence);
  }
}

// Warns of linear elements where they are known to be too stiff, and of too few nodal ones.
void doubt_elements(const Body& body, std::vector<std::string>& sentences) {
  const MaterialInfo* material = find_material(body.material.model);
  if (!material) return;
  double poisson = 0;
  const auto look = [&](const RegionOptions& region) {
    const std::vector<double> values = parameter_values(*material, body.material, region);
    poisson = std::max(poisson, poisson_ratio(material->small_strains(values)));
  };
  look({});
  for (const auto& [name, region] : body.regions) look(region);
  const Element element = element_of(body, 0);
  const bool linear = element == Element::linear;
  constexpr double many = 4, most = 0.7;
  double across = elements_across(body.levels.front());
  // A plate of one cell: its volume and surface alone look like two cells and more
  if (!linear && across < many && part_one_across(body.levels.front()) > most) across = 1;
  if (linear ? poisson <= 0.4 && across >= 8 : across >= 1.2) return;
  const auto bends = [&](Element one) { return number(bending_ratio(one, poisson, across), 2); };
  sentences.push_back(text(
      "body.element: level 0 has ", name_of(element), " elements, about ", number(across, 2),
      " across its thickness, at nu ", number(poisson, 4), "; a slender beam of these bends ",
      bends(element), " of what it should",
      linear ? text(", of nodal elements ", bends(Element::nodal), ": expected body.element: nodal")
             : ": expected a finer mesh"));
}

// Warns of so many regions that nodal elements, which average over a vertex and its region, are as
// stiff as linear ones
void doubt_regions(const Body& body, std::vector<std::string>& sentences) {
  constexpr std::size_t few_regions = 8, tets_of_each = 100;
  const TetMesh& mesh = body.levels.front();
  const std::size_t regions = mesh.region_names.size();
  if (element_of(body, 0) != Element::nodal || regions <= few_regions ||
      regions * tets_of_each <= mesh.tets.size())
    return;
  sentences.push_back(text("body.levels.0: ", regions, " regions for ", mesh.tets.size(),
                           " tetrahedra; nodal elements average within a region, so these are as "
                           "stiff as linear ones; expected a region for 100 tetrahedra or more"));
}

// Warns of loads that act beside the border of a part, where displacements are the coarser mesh's
void doubt_loads_at_border(const Body& body, std::vector<std::string>& sentences) {
  TetMesh mesh = body.levels.front();
  std::vector<char> near = follows_others(mesh);
  if (near.empty() || body.loads.empty()) return;
  const std::vector<char> follows = near;
  for (const auto& tet : mesh.tets)
    if (std::ranges::any_of(tet, [&](int v) { return follows[static_cast<std::size_t>(v)] != 0; }))
      for (const int v : tet) near[static_cast<std::size_t>(v)] = 1;
  for (const auto& masters : mesh.followers.of)
    for (const int v : masters) near[static_cast<std::size_t>(v)] = 1;
  add_regions(mesh, body.regions, 0);
  for (std::size_t i = 0; i < body.loads.size(); ++i) {
    const std::vector<int> chosen =
        select_vertices(mesh, body.loads[i].where, {text("body.loads.", i), 0});
    const auto count = std::ranges::count_if(
        chosen, [&](int v) { return near[static_cast<std::size_t>(v)] != 0; });
    if (count > 0)
      sentences.push_back(text("body.loads.", i, ": ", count, " of its ", chosen.size(),
                               " vertices are within an edge of the border of a part, where "
                               "displacements are as exact as on the coarser mesh; expected loads "
                               "further from it"));
  }
}

// Warns of a tool that is lighter than what it touches: its own inertia then counts for nothing,
// and contact accelerates it as nothing real.
void doubt_tools(const Problem& problem, std::vector<std::string>& sentences) {
  double mass = -1;  // mean mass of a vertex [kg]
  for (std::size_t i = 0; i < problem.contact.obstacles.size(); ++i) {
    const std::optional<double>& own = problem.contact.obstacles[i].mass;
    if (!own) continue;
    if (mass < 0)
      mass = size_of_level(problem.body, 0).mass /
             static_cast<double>(problem.body.levels.front().vertices.size());
    if (*own < mass)
      sentences.push_back(text("contact.obstacles.", i, ".mass: ", number(*own, 3),
                               " kg is less than a vertex of the body has, ", number(mass, 3),
                               " kg: contact will accelerate it unrealistically; expected a tool "
                               "that is not lighter than what it touches"));
  }
}

// Returns the least radius of a round shape [m]; infinity: another shape.
double least_radius(const ShapeOptions& shape) {
  double radius = std::numeric_limits<double>::infinity();
  visit_shape(shape, [&](auto, const auto& o) {
    if constexpr (requires { o.to_radius; })
      radius = std::min(o.radius, o.to_radius);
    else if constexpr (std::is_same_v<std::decay_t<decltype(o)>, SphereOptions> ||
                       requires { o.to; })
      radius = o.radius;
  });
  return radius;
}

// Warns of moving tools that catch single vertices, which long steps let go late. The numbers were
// measured, see cmake/docs/results/contact.md.
void doubt_narrow_tools(const Problem& problem, std::vector<std::string>& sentences) {
  const IntegrationOptions& o = problem.integration;
  if (seeks_rest(o) || (o.cycle != "him" && is_explicit(o.integrator.front()))) return;
  const double edge = mean_edge_length(problem.body.levels.front());
  for (std::size_t i = 0; i < problem.contact.obstacles.size(); ++i) {
    const ObstacleOptions& tool = problem.contact.obstacles[i];
    const double radius = least_radius(tool.shape);
    if (!moves(tool) || !(radius < edge)) continue;
    sentences.push_back(text(
        "contact.obstacles.", i, ": its radius of ", number(1e3 * radius, 3),
        " mm is below the mean edge of level 0, ", number(1e3 * edge, 3),
        " mm: it catches single vertices, and they slip off some steps late, so that displacements "
        "under it are off by tens of per cent where it is drawn along; expected explicit steps, a "
        "shorter integration.macro_step, or a finer mesh there"));
  }
}

// Warns of integrators that let motion at contacts oscillate from step to step.
void doubt_integrator(const Problem& problem, std::vector<std::string>& sentences) {
  if (!has_contact(problem)) return;
  for (const char* name : {"generalized_alpha", "newmark"})
    if (std::ranges::count(problem.integration.integrator, name) > 0)
      sentences.push_back(std::string("integration.integrator is ") + name +
                          ": motion where something touches rings on from step to step, and forces "
                          "of tools alternate; "
                          "expected bdf2, sdirk2, implicit_euler or an explicit integrator");
}

// Says what the cycle rest does not use.
void tell_of_rest(const Problem& problem, std::vector<std::string>& sentences) {
  if (!seeks_rest(problem.integration)) return;
  if (damps_by_mass(problem.body) || damps_by_stiffness(problem.body))
    sentences.push_back(
        "body.damping is not used: integration.cycle is rest, which has no motion to damp");
  if (is_viscous(problem.body))
    sentences.push_back(
        "body.material.prony: integration.cycle is rest, where all stress that relaxes has "
        "relaxed, however long that takes");
}

}  // namespace

std::vector<std::string> problem_warnings(const Problem& problem) {
  std::vector<std::string> sentences;
  const std::vector<TetMesh>& levels = problem.body.levels;
  for (std::size_t i = 1; i < levels.size(); ++i)
    if (levels[i].tets.size() >= levels[i - 1].tets.size())
      sentences.push_back("body.levels: level " + std::to_string(i) +
                          " is not coarser than level " + std::to_string(i - 1) + ": " +
                          std::to_string(levels[i].tets.size()) + " tetrahedra after " +
                          std::to_string(levels[i - 1].tets.size()) +
                          "; expected the finest first");
  if (levels.size() > 1) doubt_levels(problem, sentences);
  doubt_elements(problem.body, sentences);
  doubt_regions(problem.body, sentences);
  doubt_loads_at_border(problem.body, sentences);
  doubt_tools(problem, sentences);
  doubt_narrow_tools(problem, sentences);
  doubt_integrator(problem, sentences);
  tell_of_rest(problem, sentences);
  for (const std::string& sentence : starts_in_obstacles(problem)) sentences.push_back(sentence);
  if (const Body& body = problem.body;
      starts_deformed(body.initial) && !recovers(body.material.model)) {
    const TetMesh& mesh = levels.front();
    const std::string inverted = inverted_at_start(
        mesh, initial_displacement(body.initial, mesh, bounding_box(mesh.vertices)));
    if (!inverted.empty())
      sentences.push_back("body.initial: " + inverted + "; " + body.material.model +
                          " does not push them back; they may stay inverted");
  }
  for (std::size_t i = 0; i < problem.body.prescribed.size(); ++i)
    if (const auto* path = std::get_if<PathMotion>(&problem.body.prescribed[i].motion);
        path && path->knots.front().displacement.norm() > 0)
      sentences.push_back(
          "body.prescribed." + std::to_string(i) +
          ".curve does not start at [0, 0, 0]: the vertices jump there at the start");
  return sentences;
}

}  // namespace plica
