// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/energy_meter.hpp>
#include <plica/drivers/solver/parts.hpp>
#include <plica/drivers/solver/set_up/build_hierarchy.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>
#include <plica/drivers/solver/simulation.hpp>

namespace plica {

/// What a simulation owns, for the sources that implement it.
template <class B>
struct Simulation<B>::Inside {
  Inside(const Problem& p, const Exec& exec)
      : problem(p), built(build_hierarchy<B>((validate(p), p), exec)), meter(*built.hierarchy, p.gravity) {
    problem.body.levels.clear();  // the placed meshes in use are in `built`
    for (const auto& part : built.hierarchy->levels) kept.emplace_back("kept", part.level.model.vertices);
    budget_known =
        problem.body.prescribed.empty() && std::none_of(p.contact.obstacles.begin(), p.contact.obstacles.end(),
                                                        [](const ObstacleOptions& o) { return o.velocity.norm() > 0; });
    parts = list_parts<B>(p, built);
    keep();
    start_energy();
  }

  Problem problem;
  BuiltHierarchy<B> built;
  EnergyMeter<B> meter;
  std::vector<Part> parts;
  std::vector<State<B>> kept;
  double time = 0, kept_time = 0;
  long steps = 0, kept_steps = 0;
  bool budget_known;  // nothing from outside but gravity does work
  double residual = 0, worst_residual = 0;
  double start = 0, put_in = 0;  // energy at the start, the most that was ever there to be had [J]

  Hierarchy<B>& hierarchy() { return *built.hierarchy; }
  const Level<B>& level(int i) {
    if (i < 0 || i >= hierarchy().count())
      throw InputError("level " + std::to_string(i) + " of a simulation that has " +
                       std::to_string(hierarchy().count()));
    return hierarchy()[i].level;
  }

  void keep() {
    for (std::size_t i = 0; i < kept.size(); ++i) kept[i].copy(hierarchy().exec(), hierarchy().levels[i].level.state);
    kept_time = time, kept_steps = steps;
  }
  void start_energy() {
    const Energies e = meter.all(time);
    start = put_in = e.total();
  }
};

}  // namespace plica
