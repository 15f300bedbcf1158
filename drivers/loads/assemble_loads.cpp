// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <plica/core/error.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/loads/assemble_loads.hpp>
#include <plica/drivers/loads/cavity.hpp>
#include <plica/drivers/loads/dead_loads.hpp>
#include <plica/drivers/loads/follower_pressures.hpp>

namespace plica {

namespace {

Point area_vector(const TetMesh& mesh, const std::array<int, 3>& t) {
  const auto x = [&](std::size_t k) -> const Point& {
    return mesh.vertices[static_cast<std::size_t>(t[k])];
  };
  return (x(1) - x(0)).cross(x(2) - x(0)) / 2;
}

/// Returns the boundary triangles that a load acts on.
std::vector<std::array<int, 3>> loaded_triangles(const LoadOptions& load, const TetMesh& mesh,
                                                 const Selecting& who) {
  return select_triangles(mesh, load.where, who,
                          load.on_cuts ? OpenedFaces::included : OpenedFaces::left_out);
}

/// Returns the forces of a pressure on the mesh at rest, per vertex [N].
std::map<int, Point> forces_of(double pressure, const TetMesh& mesh, const LoadOptions& load,
                               const Selecting& who) {
  std::map<int, Point> force;
  for (const auto& t : loaded_triangles(load, mesh, who))
    for (const int v : t)
      force.try_emplace(v, Point::Zero()).first->second -= pressure / 3 * area_vector(mesh, t);
  return force;
}

bool follows(const LoadOptions& load) {
  return std::holds_alternative<FollowerPressure>(load.load) ||
         std::holds_alternative<EnclosedVolume>(load.load);
}

/// Returns each vertex's share of a load. For a traction it is an area [m^2], for a force the
/// vertex's mass over the mass of all.
std::map<int, double> shares(const LoadOptions& load, const TetMesh& mesh,
                             const std::vector<double>& mass, const Selecting& who) {
  std::map<int, double> share;
  if (std::holds_alternative<Traction>(load.load)) {
    for (const auto& t : loaded_triangles(load, mesh, who))
      for (int v : t) share[v] += area_vector(mesh, t).norm() / 3;
    return share;
  }
  double total = 0;
  for (int v : select_vertices(mesh, load.where, who))
    total += share[v] = mass[static_cast<std::size_t>(v)];
  for (auto& [v, s] : share) s /= total;
  return share;
}

std::map<int, Point> forces_of(const LoadOptions& load, const TetMesh& mesh,
                               const std::vector<double>& mass, const Selecting& who) {
  if (const auto* follower = std::get_if<FollowerPressure>(&load.load))
    return forces_of(follower->value, mesh, load, who);
  if (std::holds_alternative<EnclosedVolume>(load.load)) return forces_of(0, mesh, load, who);
  const auto* traction = std::get_if<Traction>(&load.load);
  const Point value = traction ? traction->value : std::get<TotalForce>(load.load).value;
  std::map<int, Point> force;
  for (const auto& [v, share] : shares(load, mesh, mass, who)) force.emplace(v, share * value);
  return force;
}

/// Gives the forces on vertices that follow others to these, by weight.
void give_forces_to_masters(const Followers& followers, std::map<int, Point>& force) {
  for (std::size_t i = 0; i < followers.vertex.size(); ++i) {
    const auto own = force.find(followers.vertex[i]);
    if (own == force.end()) continue;
    for (std::size_t k = 0; k < 4; ++k)
      if (const double w = followers.weight[i][k]; w != 0)
        force.try_emplace(followers.of[i][k], Point::Zero()).first->second += w * own->second;
    force.erase(own);
  }
}

}  // namespace

bool has_follower_loads(const Body& body) { return std::ranges::any_of(body.loads, follows); }

std::vector<AssembledLoad> assemble_loads(const Body& body, const TetMesh& mesh,
                                          const LevelConstants& constants, int level,
                                          const std::vector<AssembledLoad>& finest) {
  std::vector<AssembledLoad> all;
  for (std::size_t i = 0; i < body.loads.size(); ++i) {
    const LoadOptions& load = body.loads[i];
    const Selecting who{"body.loads." + std::to_string(i), level};
    AssembledLoad made;
    bool free = false;
    std::map<int, Point> forces = forces_of(load, mesh, constants.mass, who);
    give_forces_to_masters(mesh.followers, forces);
    for (const auto& [v, force] : forces) {
      free = free || !constants.constrained[static_cast<std::size_t>(v)];
      made.vertex.push_back(v), made.force.push_back(force);
      made.resultant += force;
    }
    if (!free)
      throw InputError(who.option + ": all " + std::to_string(made.vertex.size()) +
                       " vertices it acts on, on level " + std::to_string(level) +
                       ", are fixed or prescribed");
    if (!finest.empty() && made.resultant.norm() > 0) {
      const double scale = finest[i].resultant.norm() / made.resultant.norm();
      for (Point& f : made.force) f *= scale;
      made.resultant *= scale;
    }
    all.push_back(std::move(made));
  }
  return all;
}

namespace {

template <class B>
std::vector<Load<B>> device_loads(const Body& body, const std::vector<AssembledLoad>& loads) {
  using Real = typename B::Real;
  std::vector<Load<B>> all;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    if (follows(body.loads[i])) continue;
    all.push_back({static_cast<int>(loads[i].force.size()),
                   to_device<Indices<B>>("load.vertex", loads[i].vertex),
                   to_device<Vectors<B>>("load.force", rows<Real>(loads[i].force)),
                   body.loads[i].course});
  }
  return all;
}

template <class B>
FollowerLoad<B> follower_load(const TetMesh& mesh, const std::vector<std::array<int, 3>>& triangles,
                              const Point& origin) {
  // per vertex, the two other vertices of each of its triangles
  std::map<int, std::vector<std::array<int, 2>>> at;
  for (const auto& t : triangles)
    for (std::size_t c = 0; c < 3; ++c) at[t[c]].push_back({t[(c + 1) % 3], t[(c + 2) % 3]});
  std::map<int, int> place;
  for (const auto& [v, others] : at) place.emplace(v, static_cast<int>(place.size()));
  std::vector<int> vertex, first{0}, second, third;
  std::vector<Point> rest;
  for (const auto& [v, others] : at) {
    vertex.push_back(v), rest.push_back(mesh.vertices[static_cast<std::size_t>(v)] - origin);
    for (const auto& [b, c] : others) second.push_back(place.at(b)), third.push_back(place.at(c));
    first.push_back(static_cast<int>(second.size()));
  }
  return {static_cast<int>(vertex.size()),
          to_device<Indices<B>>("follower.vertex", vertex),
          to_device<Vectors<B>>("follower.rest", rows<typename B::Real>(rest)),
          to_device<Indices<B>>("follower.first", first),
          to_device<Indices<B>>("follower.second", second),
          to_device<Indices<B>>("follower.third", third),
          0,
          {}};
}

/// Returns for each vertex whether it never moves.
std::vector<char> still_vertices(const LevelConstants& constants) {
  std::vector<char> still = constants.constrained;
  for (const int v : constants.prescribed_vertex) still[static_cast<std::size_t>(v)] = 0;
  return still;
}

template <class B>
std::vector<FollowerLoad<B>> follower_loads(const Body& body, const TetMesh& mesh,
                                            const LevelConstants& constants, int level) {
  std::vector<FollowerLoad<B>> all;
  const std::vector<char> still = still_vertices(constants);
  for (std::size_t i = 0; i < body.loads.size(); ++i) {
    const LoadOptions& load = body.loads[i];
    if (!follows(load)) continue;
    const Selecting who{"body.loads." + std::to_string(i), level};
    const auto triangles = loaded_triangles(load, mesh, who);
    std::optional<Cavity> cavity;
    if (const auto* given = std::get_if<EnclosedVolume>(&load.load))
      cavity = make_cavity(*given, static_cast<int>(i), mesh, triangles, still, who);
    all.push_back(follower_load<B>(mesh, triangles, centre_of(mesh, triangles)));
    FollowerLoad<B>& made = all.back();
    made.course = load.course, made.cavity = cavity;
    if (has_still_rims(triangles, still))
      made.volume = zeros<Doubles<B>>("plica::follower.volume", 1);
    if (const auto* follower = std::get_if<FollowerPressure>(&load.load))
      made.pressure = follower->value;
  }
  return all;
}

}  // namespace

template <class B>
std::vector<std::unique_ptr<ForceTerm<B>>> make_force_terms(const Body& body, const TetMesh& mesh,
                                                            const LevelConstants& constants,
                                                            const std::vector<AssembledLoad>& loads,
                                                            int level) {
  std::vector<std::unique_ptr<ForceTerm<B>>> terms;
  if (auto dead = device_loads<B>(body, loads); !dead.empty())
    terms.push_back(std::make_unique<DeadLoads<B>>(std::move(dead)));
  if (auto followers = follower_loads<B>(body, mesh, constants, level); !followers.empty())
    terms.push_back(std::make_unique<FollowerPressures<B>>(std::move(followers)));
  return terms;
}

#define PLICA_INSTANTIATE(Real, Exec)                                                       \
  template std::vector<std::unique_ptr<ForceTerm<Backend<Real, Exec>>>>                     \
  make_force_terms<Backend<Real, Exec>>(const Body&, const TetMesh&, const LevelConstants&, \
                                        const std::vector<AssembledLoad>&, int);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
