// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <functional>
#include <map>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/courses.hpp>
#include <plica/drivers/solver/materials.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/drivers/solver/set_up/build_level.hpp>
#include <plica/drivers/solver/set_up/build_nodal_rows.hpp>
#include <plica/drivers/solver/set_up/build_patches.hpp>
#include <plica/drivers/solver/set_up/initial_state.hpp>
#include <plica/drivers/solver/set_up/masses.hpp>
#include <plica/drivers/solver/set_up/selection.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/kernels/boundary_conditions.hpp>

namespace plica {

namespace {

void constrain(LevelConstants& c, const Body& body, const TetMesh& mesh, int level) {
  std::map<int, std::string> motion_of;
  const auto clash = [&](int v, const std::string& option) {
    return InputError(option + ": vertex " + std::to_string(v) + " of level " +
                      std::to_string(level) + " is prescribed by " + motion_of.at(v) +
                      " too; a vertex has one motion, or is fixed");
  };
  c.constrained.assign(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < body.prescribed.size(); ++i) {
    const std::string option = "body.prescribed." + std::to_string(i);
    for (int v : select_vertices(mesh, body.prescribed[i].where, {option, level})) {
      if (!motion_of.emplace(v, option).second) throw clash(v, option);
      c.constrained[static_cast<std::size_t>(v)] = 1;
      c.prescribed_vertex.push_back(v), c.prescribed_motion.push_back(static_cast<int>(i));
    }
  }
  for (std::size_t i = 0; i < body.fixed.size(); ++i) {
    const std::string option = "body.fixed." + std::to_string(i);
    for (int v : select_vertices(mesh, body.fixed[i], {option, level})) {
      if (motion_of.contains(v)) throw clash(v, option);
      c.constrained[static_cast<std::size_t>(v)] = 1;
    }
  }
}

template <class B>
PrescribedVertices<B> prescribed_vertices(const LevelConstants& c, const std::vector<Path>& paths,
                                          const std::vector<PathKnot>& knots) {
  PrescribedVertices<B> p;
  p.count = static_cast<int>(c.prescribed_vertex.size());
  if (p.count == 0) return p;
  p.vertex = to_device<Indices<B>>("prescribed.vertex", c.prescribed_vertex);
  p.path = to_device<Indices<B>>("prescribed.path", c.prescribed_motion);
  p.paths = to_device<decltype(p.paths)>("prescribed.paths", paths);
  p.knots = to_device<decltype(p.knots)>("prescribed.knots", knots);
  return p;
}

// A region's mass damping acts on its elements' share of a vertex's mass.
std::vector<double> vertex_damping(const TetMesh& mesh, std::vector<double> density,
                                   const std::vector<double>& of_region,
                                   const std::vector<double>& mass) {
  if (std::adjacent_find(of_region.begin(), of_region.end(), std::not_equal_to<>()) ==
      of_region.end())
    return {of_region.front()};
  for (std::size_t r = 0; r < density.size(); ++r) density[r] *= of_region[r];
  std::vector<double> damping = lumped_masses(mesh, density);
  for (std::size_t a = 0; a < damping.size(); ++a) damping[a] /= mass[a];
  return damping;
}

/// What the constants of the elements' regions are made of, of the values of their parameters.
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
  std::vector<std::vector<double>> values_of;  // likewise
  std::vector<std::vector<PronyTerm>> prony;   // likewise
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
  if (fibres_vary(body)) c.fibres = element_fibres(body, mesh, level);
  c.shape = shape_constants(body, material, c, values_of, std::move(prony));
  if (*std::max_element(c.stiffness_damping.begin(), c.stiffness_damping.end()) == 0)
    c.stiffness_damping.clear();
  c.density = region_densities(body, mesh);
  c.mass = lumped_masses(mesh, c.density);
  c.mass_damping = vertex_damping(mesh, c.density, mass_damping, c.mass);
  constrain(c, body, mesh, level);
  c.velocity.assign(mesh.vertices.size(), Point::Zero());
  // the others take it from there
  if (level == 0) c.velocity = initial_velocity(body.initial, mesh, middle);
  return c;
}

namespace {

template <class B>
void add_preconditioning(Model<B>& model, const TetMesh& placed, NodalConstants constants,
                         const LevelConstants& c, BesideNodal beside) {
  using F = Backend<float, typename B::Exec>;
  if (beside == BesideNodal::nothing) return;
  model.patches = build_patches<B>(placed, constants.material, c.stiffness_damping);
  if (!c.fibres.empty()) model.patches.fibres = device_fibres<B>(model.patches, c.fibres);
  if (beside == BesideNodal::matrix) return;
  constants.excess.clear();
  model.float_rows = build_nodal_rows<F>(placed, constants);
  if (!c.fibres.empty())
    model.float_rows.fibres = device_fibres<F>(model.float_rows, placed, c.fibres);
}

template <class B>
void add_elements(Level<B>& level, const Body& body, const TetMesh& placed, const LevelConstants& c,
                  BesideNodal beside) {
  Model<B>& model = level.model;
  if (c.element == Element::linear) {
    model.patches = build_patches<B>(placed, c.material, c.stiffness_damping);
    if (!c.fibres.empty()) model.patches.fibres = device_fibres<B>(model.patches, c.fibres);
    model.shares = model.patches.shares;
  } else {
    const bool smoothed = smooths_pressure(body, c.lame);
    NodalConstants constants{smoothed ? c.capped : c.material, {}, {}, c.stiffness_damping};
    for (const Lame<double>& lame : c.lame) {
      constants.stabiliser.push_back(body.stabilisation * lame.mu);
      if (smoothed) constants.excess.push_back(lame.lambda - capped_lambda(lame));
    }
    model.rows = build_nodal_rows<B>(placed, constants);
    model.shares = model.rows.shares;
    level.nodal = make_nodal_work<B>(model.rows);
    if (!c.fibres.empty()) model.rows.fibres = device_fibres<B>(model.rows, placed, c.fibres);
    add_preconditioning<B>(model, placed, std::move(constants), c, beside);
  }
  level.partial = zeros<Vectors<B>>("plica::work.partial",
                                    std::max(model.shares.rows, model.patches.shares.rows));
  if (!allows_inversion(body.material))
    level.flags = make_element_flags<B>(c.element == Element::linear ? model.patches.count
                                                                     : model.rows.slices);
}

}  // namespace

template <class B>
Level<B> build_level(const Body& body, const TetMesh& placed, const LevelConstants& c,
                     BesideNodal beside) {
  using Real = typename B::Real;
  const std::size_t n = placed.vertices.size();
  Level<B> level;
  level.model.vertices = static_cast<int>(n);
  level.model.tets = static_cast<int>(placed.tets.size());
  add_elements(level, body, placed, c, beside);

  std::vector<Real> mass(n), inverse(n);
  std::vector<Point> velocity(n, Point::Zero()), displacement(n, Point::Zero());
  for (std::size_t v = 0; v < n; ++v) {
    mass[v] = static_cast<Real>(c.mass[v]);
    inverse[v] = c.constrained[v] ? Real(0) : static_cast<Real>(1 / c.mass[v]);
    if (!c.constrained[v]) velocity[v] = c.velocity[v];
  }
  std::vector<PathKnot> knots;
  std::vector<Path> paths;
  for (const PrescribedMotion& given : body.prescribed)
    paths.push_back(make_path(given.motion, knots));
  level.prescribed = prescribed_vertices<B>(c, paths, knots);
  for (std::size_t i = 0; i < c.prescribed_vertex.size(); ++i) {
    const auto v = static_cast<std::size_t>(c.prescribed_vertex[i]);
    const PathPoint at =
        path_at(paths[static_cast<std::size_t>(c.prescribed_motion[i])], knots.data(), 0);
    for (int k = 0; k < 3; ++k)
      displacement[v][k] = at.displacement[k], velocity[v][k] = at.velocity[k];
  }
  const std::vector<Real> damping(c.mass_damping.begin(), c.mass_damping.end());
  level.model.damping.everywhere = damping.front();
  if (damping.size() > 1)
    level.model.damping.of_vertex = to_device<Scalars<B>>("model.damping", damping);
  level.model.mass = to_device<Scalars<B>>("model.mass", mass);
  level.model.inverse_mass = to_device<Scalars<B>>("model.inverse_mass", inverse);
  level.state.u = to_device<Vectors<B>>("state.u", rows<Real>(displacement));
  level.state.v = to_device<Vectors<B>>("state.v", rows<Real>(velocity));
  level.f = zeros<Vectors<B>>("plica::work.f", n);
  return level;
}

#define PLICA_INSTANTIATE(Real, Exec)                                   \
  template Level<Backend<Real, Exec>> build_level<Backend<Real, Exec>>( \
      const Body&, const TetMesh&, const LevelConstants&, BesideNodal);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
