// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <functional>
#include <plica/core/error.hpp>
#include <plica/drivers/body/initial_state.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/elastic/level_constants.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/meshes/composite.hpp>

namespace plica {

namespace {

void constrain(LevelConstants& c, const Body& body, const TetMesh& mesh, int level) {
  Supports found = find_supports(body, mesh, level);
  c.constrained = std::move(found.constrained), c.sliding = std::move(found.sliding);
  c.prescribed_vertex = std::move(found.prescribed_vertex),
  c.prescribed_motion = std::move(found.prescribed_motion);
  c.held = std::move(found.sets);
}

/// Returns the mass damping of each vertex [1/s]; one entry where it is the same everywhere.
/// A region's mass damping acts on its elements' share of a vertex's mass.
std::vector<double> vertex_damping(const TetMesh& mesh, std::vector<double> density,
                                   const std::vector<double>& of_region,
                                   const std::vector<double>& mass) {
  if (std::adjacent_find(of_region.begin(), of_region.end(), std::not_equal_to<>()) ==
      of_region.end())
    return {of_region.front()};
  for (std::size_t r = 0; r < density.size(); ++r) density[r] *= of_region[r];
  std::vector<double> damping = lumped_masses(mesh, density);
  for (std::size_t a = 0; a < damping.size(); ++a)  // a vertex that follows others has no mass
    damping[a] = mass[a] > 0 ? damping[a] / mass[a] : of_region.front();
  return damping;
}

/// Returns the parts that viscous constants of each region are made of, from parameter values.
/// Empty for a material that is not viscous.
ShapeConstants shape_constants(const Body& body, const MaterialInfo& material,
                               const LevelConstants& c,
                               const std::vector<std::vector<double>>& values,
                               std::vector<std::vector<PronyTerm>> prony) {
  ShapeConstants shape;
  if (!is_viscous(body)) return shape;
  shape.prony = std::move(prony);
  const bool capped = c.element == Element::nodal && smooths_pressure(body, c.lame);
  for (std::size_t r = 0; r < values.size(); ++r) {
    const Lame<double>& lame = c.lame[r];
    const double bulk = (capped ? capped_lambda(lame) : lame.lambda) + 2 * lame.mu / 3;
    shape.half.push_back(material.with_shape(values[r], 0.5, bulk));
    shape.isochoric.push_back(material.with_shape(values[r], 1, 0));
  }
  return shape;
}

}  // namespace

LevelConstants level_constants(const Body& body, const TetMesh& mesh, const Point& middle,
                               int level) {
  LevelConstants c;
  c.element = element_of(body, static_cast<std::size_t>(level));
  const MaterialInfo& material = *find_material(body.material.model);
  std::vector<double> mass_damping;            // per region
  std::vector<std::vector<double>> values_of;  // per region
  std::vector<std::vector<PronyTerm>> prony;   // per region
  const std::size_t regions = mesh.region.empty() ? 1 : mesh.region_names.size();
  for (std::size_t r = 0; r < regions; ++r) {
    const auto own =
        mesh.region.empty() ? body.regions.end() : body.regions.find(mesh.region_names[r]);
    const RegionOptions o = own == body.regions.end() ? RegionOptions{} : own->second;
    if (material.has_fibres && !body.material.fibres && !o.fibres)
      throw InputError("body.fibres is missing" +
                       (mesh.region.empty()
                            ? ""
                            : ", and region '" + mesh.region_names[r] + "' has none of its own") +
                       "; expected the direction of its fibres, such as {axis: [0, 0, 1]}");
    const std::vector<double>& values =
        values_of.emplace_back(parameter_values(material, body.material, o));
    c.material.push_back(material.kernel_constants(values));
    c.lame.push_back(material.small_strains(values));
    c.capped.push_back(material.with_lambda
                           ? material.with_lambda(values, capped_lambda(c.lame.back()))
                           : c.material.back());
    prony.push_back(o.prony.empty() ? body.material.prony : o.prony);
    mass_damping.push_back(o.damping.mass.value_or(body.damping.mass));
    c.stiffness_damping.push_back(o.damping.stiffness.value_or(body.damping.stiffness));
  }
  if (fibres_vary(body)) {
    c.fibres = element_fibres(body, mesh, level);
    for (const std::vector<double>& values : values_of)
      c.families.push_back(family_components(material, values));
  }
  c.shape = shape_constants(body, material, c, values_of, std::move(prony));
  if (*std::max_element(c.stiffness_damping.begin(), c.stiffness_damping.end()) == 0)
    c.stiffness_damping.clear();
  c.density = region_densities(body, mesh);
  c.mass = lumped_masses(mesh, c.density);
  c.mass_damping = vertex_damping(mesh, c.density, mass_damping, c.mass);
  constrain(c, body, mesh, level);
  c.velocity.assign(mesh.vertices.size(), Point::Zero());
  // other levels take their velocities from level 0
  if (level == 0) c.velocity = initial_velocity(body.initial, mesh, middle);
  follow_masters(mesh.followers, c.velocity);
  return c;
}

}  // namespace plica
