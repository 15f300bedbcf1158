// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/set_up/assemble_loads.hpp>
#include <plica/drivers/solver/set_up/selection.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>

namespace plica {

namespace {

/// Per vertex its share: of a traction the area [m^2], of a force the mass over the mass of all.
std::map<int, double> shares(const LoadOptions& load, const TetMesh& mesh, const std::vector<double>& mass,
                             const Selecting& who) {
  std::map<int, double> share;
  if (std::holds_alternative<Traction>(load.load)) {
    for (const auto& t : select_triangles(mesh, load.where, who)) {
      const auto x = [&](std::size_t k) -> const Point& { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
      const double area = (x(1) - x(0)).cross(x(2) - x(0)).norm() / 2;
      for (int v : t) share[v] += area / 3;
    }
    return share;
  }
  double total = 0;
  for (int v : select_vertices(mesh, load.where, who)) total += share[v] = mass[static_cast<std::size_t>(v)];
  for (auto& [v, s] : share) s /= total;
  return share;
}

}  // namespace

std::vector<AssembledLoad> assemble_loads(const Body& body, const TetMesh& mesh, const LevelConstants& constants,
                                          int level, const std::vector<AssembledLoad>& finest) {
  std::vector<AssembledLoad> all;
  for (std::size_t i = 0; i < body.loads.size(); ++i) {
    const LoadOptions& load = body.loads[i];
    const Selecting who{"body.loads." + std::to_string(i), level};
    const Point value = std::visit([](const auto& kind) { return kind.value; }, load.load);
    AssembledLoad made;
    bool free = false;
    for (const auto& [v, share] : shares(load, mesh, constants.mass, who)) {
      free = free || !constants.constrained[static_cast<std::size_t>(v)];
      made.vertex.push_back(v), made.force.emplace_back(share * value);
      made.resultant += made.force.back();
    }
    if (!free)
      throw InputError(who.option + ": all " + std::to_string(made.vertex.size()) + " vertices it acts on, on level " +
                       std::to_string(level) + ", are fixed or prescribed");
    if (!finest.empty() && made.resultant.norm() > 0) {
      const double scale = finest[i].resultant.norm() / made.resultant.norm();
      for (Point& f : made.force) f *= scale;
      made.resultant *= scale;
    }
    all.push_back(std::move(made));
  }
  return all;
}

template <class B>
std::vector<Load<B>> device_loads(const Body& body, const std::vector<AssembledLoad>& loads) {
  using Real = typename B::Real;
  std::vector<Load<B>> all;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    all.push_back({static_cast<int>(loads[i].force.size()), to_device<Indices<B>>("load.vertex", loads[i].vertex),
                   to_device<Vectors<B>>("load.force", rows<Real>(loads[i].force)), body.loads[i].course});
  }
  return all;
}

#define PLICA_INSTANTIATE(Real, Exec)                                                \
  template std::vector<Load<Backend<Real, Exec>>> device_loads<Backend<Real, Exec>>( \
      const Body&, const std::vector<AssembledLoad>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
