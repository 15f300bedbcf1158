// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/set_up/build_level.hpp>
#include <plica/drivers/solver/set_up/build_patches.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/kernels/materials/list.hpp>

namespace plica {

namespace {

std::vector<int> vertices_of_region(const TetMesh& mesh, int region) {
  std::vector<char> in(mesh.vertices.size(), 0);
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
    if (mesh.region[e] == region)
      for (int v : mesh.tets[e]) in[static_cast<std::size_t>(v)] = 1;
  std::vector<int> chosen;
  for (std::size_t v = 0; v < in.size(); ++v)
    if (in[v]) chosen.push_back(static_cast<int>(v));
  return chosen;
}

std::vector<int> vertices_in_box(const TetMesh& mesh, const Box& box) {
  const Box all = bounding_box(mesh.vertices);
  const Point slack = Point::Constant(1e-9 * (all.max - all.min).norm());  // a face is chosen by its own coordinates
  std::vector<int> chosen;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if ((mesh.vertices[v].array() >= (box.min - slack).array()).all() &&
        (mesh.vertices[v].array() <= (box.max + slack).array()).all())
      chosen.push_back(static_cast<int>(v));
  return chosen;
}

std::string text(const Point& p) {
  std::string s = "[";
  for (int k = 0; k < 3; ++k) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%g", k > 0 ? ", " : "", p[k]);
    s += number;
  }
  return s + "]";
}

std::vector<int> select(const TetMesh& mesh, const Selection& selection, int level) {
  const std::string where = " on level " + std::to_string(level);
  if (selection.box) {
    const auto chosen = vertices_in_box(mesh, *selection.box);
    const Box all = bounding_box(mesh.vertices);
    if (chosen.empty())
      throw InputError("the box from " + text(selection.box->min) + " to " + text(selection.box->max) +
                       " m selects no vertex" + where + ", which reaches from " + text(all.min) + " to " +
                       text(all.max) + " m at rest");
    return chosen;
  }
  if (const auto set = mesh.vertex_sets.find(selection.group); set != mesh.vertex_sets.end()) return set->second;
  const auto region = std::find(mesh.region_names.begin(), mesh.region_names.end(), selection.group);
  if (region == mesh.region_names.end()) {
    std::vector<std::string> choices = mesh.region_names;
    for (const auto& [name, unused] : mesh.vertex_sets) choices.push_back(name);
    throw InputError(unknown_name("group" + where, selection.group, choices));
  }
  return vertices_of_region(mesh, static_cast<int>(region - mesh.region_names.begin()));
}

}  // namespace

LevelConstants level_constants(const Body& body, const TetMesh& mesh, int level) {
  LevelConstants c;
  const std::size_t regions = mesh.region.empty() ? 1 : mesh.region_names.size();
  for (std::size_t r = 0; r < regions; ++r) {
    const auto own = mesh.region.empty() ? body.regions.end() : body.regions.find(mesh.region_names[r]);
    const RegionOptions o = own == body.regions.end() ? RegionOptions{} : own->second;
    c.lame.push_back(lame_constants(o.young_modulus.value_or(body.material.young_modulus),
                                    o.poisson_ratio.value_or(body.material.poisson_ratio)));
    c.density.push_back(o.density.value_or(body.material.density));
  }
  c.mass.assign(mesh.vertices.size(), 0);
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const auto& t = mesh.tets[e];
    const auto x = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    const double density = c.density[mesh.region.empty() ? 0 : static_cast<std::size_t>(mesh.region[e])];
    for (int v : t) c.mass[static_cast<std::size_t>(v)] += density * tet_volume(x(0), x(1), x(2), x(3)) / 4;
  }
  c.constrained.assign(mesh.vertices.size(), 0);
  for (const PrescribedMotion& motion : body.prescribed)
    for (int v : select(mesh, motion.where, level))
      if (!std::exchange(c.constrained[static_cast<std::size_t>(v)], 1)) {
        c.prescribed_vertex.push_back(v);
        c.prescribed_speed.push_back(motion.velocity);
      }
  for (const Selection& fixed : body.fixed)
    for (int v : select(mesh, fixed, level)) {
      const auto moving = std::find(c.prescribed_vertex.begin(), c.prescribed_vertex.end(), v);
      if (moving != c.prescribed_vertex.end())
        throw InputError("vertex " + std::to_string(v) + " of level " + std::to_string(level) +
                         " is both fixed and prescribed");
      c.constrained[static_cast<std::size_t>(v)] = 1;
    }
  return c;
}

template <class B>
Level<B> build_level(const Body& body, const TetMesh& placed, const LevelConstants& c, const Point& centre) {
  using Real = typename B::Real;
  using Row = std::array<Real, 3>;
  const auto row = [](const Point& p) {
    return Row{static_cast<Real>(p[0]), static_cast<Real>(p[1]), static_cast<Real>(p[2])};
  };
  const std::size_t n = placed.vertices.size();
  Level<B> level;
  level.model.vertices = static_cast<int>(n);
  level.model.tets = static_cast<int>(placed.tets.size());
  level.model.material = body.material.model;
  level.model.patches = build_patches<B>(placed, c.lame);

  std::vector<Real> mass(n), inverse(n);
  std::vector<Row> velocity(n);
  for (std::size_t v = 0; v < n; ++v) {
    mass[v] = static_cast<Real>(c.mass[v]);
    inverse[v] = c.constrained[v] ? Real(0) : static_cast<Real>(1 / c.mass[v]);
    if (!c.constrained[v])
      velocity[v] = row(body.initial.velocity + body.initial.angular_velocity.cross(placed.vertices[v] - centre));
  }
  std::vector<Row> prescribed;
  for (std::size_t i = 0; i < c.prescribed_vertex.size(); ++i) {
    prescribed.push_back(row(c.prescribed_speed[i]));
    velocity[static_cast<std::size_t>(c.prescribed_vertex[i])] = prescribed.back();
  }
  level.model.mass = to_device<Scalars<B>>("model.mass", mass);
  level.model.inverse_mass = to_device<Scalars<B>>("model.inverse_mass", inverse);
  level.state.u = Vectors<B>("plica::state.u", n);
  level.state.v = to_device<Vectors<B>>("state.v", velocity);
  if (!prescribed.empty()) {
    level.prescribed.count = static_cast<int>(prescribed.size());
    level.prescribed.vertex = to_device<Indices<B>>("prescribed.vertex", c.prescribed_vertex);
    level.prescribed.velocity = to_device<Vectors<B>>("prescribed.velocity", prescribed);
  }
  level.f = Vectors<B>("plica::work.f", n);
  level.partial = Vectors<B>("plica::work.partial", level.model.patches.vertex.extent(0));
  Materials::visit(body.material.model, [&](auto material) {
    if (!decltype(material)::survives_inversion) level.flags = make_element_flags<B>(level.model.patches.count);
  });
  return level;
}

#define PLICA_INSTANTIATE(Real, Exec)                                                               \
  template Level<Backend<Real, Exec>> build_level<Backend<Real, Exec>>(const Body&, const TetMesh&, \
                                                                       const LevelConstants&, const Point&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
