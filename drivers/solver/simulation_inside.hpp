// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/energy_meter.hpp>
#include <plica/drivers/solver/materials.hpp>
#include <plica/drivers/solver/parts.hpp>
#include <plica/drivers/solver/set_up/build_hierarchy.hpp>
#include <plica/drivers/solver/set_up/choose_cycle.hpp>
#include <plica/drivers/solver/set_up/make_path.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>
#include <plica/drivers/solver/simulation.hpp>

namespace plica {

/// What a simulation owns, for the sources that implement it.
template <class B>
struct Simulation<B>::Inside {
  Inside(const Problem& p, const Exec& exec)
      : choice(choose_cycle<B>((validate(p), p), exec)),
        problem(with_choice(p, choice)),
        built(build_hierarchy<B>(problem, exec)),
        meter(*built.hierarchy, built.meshes.front(), p.gravity) {
    problem.body.levels.clear();  // the placed meshes in use are in `built`
    rest.resize(built.hierarchy->levels.size());
    for (const auto& part : built.hierarchy->levels) kept.emplace_back("kept", part.level.model.vertices);
    budget_known = p.body.prescribed.empty() && p.body.loads.empty() &&
                   std::none_of(p.contact.obstacles.begin(), p.contact.obstacles.end(),
                                [](const ObstacleOptions& o) { return moves(o.motion); });
    linear = !find_material(p.body.material.model)->rotation_invariant;
    keep();
    open_budget();
  }

  std::optional<CycleChoice> choice;  // of cycle auto
  Problem problem;
  BuiltHierarchy<B> built;
  EnergyMeter<B> meter;
  std::vector<Vectors<B>> rest;  // of each level's vertices, where somebody has asked for positions
  std::vector<State<B>> kept;
  double time = 0, kept_time = 0;
  long steps = 0, kept_steps = 0;
  bool linear = false;        // the material is, in any state
  bool budget_known;          // nothing from outside but gravity does work
  bool budget_opens = false;  // anew at the next check: the state has been replaced since
  double residual = 0, worst_residual = 0;
  double start = 0, put_in = 0;  // energy at the start, the most that was ever there to be had [J]
  double kept_put_in = 0;
  Point drift = Point::Zero(), kept_drift = Point::Zero();  // mean velocity at the last check [m/s]
  long halvings = 0, rejected = 0;                          // macro steps and parts of them

  Hierarchy<B>& hierarchy() { return *built.hierarchy; }
  const Level<B>& level(int i) {
    if (i < 0 || i >= hierarchy().count())
      throw InputError("level " + std::to_string(i) + " of a simulation that has " +
                       std::to_string(hierarchy().count()));
    return hierarchy()[i].level;
  }

  const Vectors<B>& rest_positions(int i) {
    level(i);  // throws where there is none
    Vectors<B>& x = rest[static_cast<std::size_t>(i)];
    if (x.extent(0) == 0)
      x = to_device<Vectors<B>>("rest", rows<typename B::Real>(built.meshes[static_cast<std::size_t>(i)].vertices));
    return x;
  }

  void step() {
    residual = 0;
    advance(time, built.macro_step);
    time = static_cast<double>(++steps) * built.macro_step;
  }
  /// A macro step or a part of it; the time is the caller's.
  void advance(double from, double span) {
    for (auto& part : hierarchy().levels) part.forces->begin_macro_step();
    built.cycle->step(hierarchy(), from, span);
    for (const auto& part : hierarchy().levels) residual = std::max(residual, part.integrator->residual());
    worst_residual = std::max(worst_residual, residual);
  }

  void keep() {
    for (std::size_t i = 0; i < kept.size(); ++i) kept[i].copy(hierarchy().exec(), hierarchy().levels[i].level.state);
    kept_time = time, kept_steps = steps, kept_put_in = put_in, kept_drift = drift;
  }
  void go_back() {
    put_back(kept);
    time = kept_time, steps = kept_steps, put_in = kept_put_in, drift = kept_drift;
  }
  /// All levels' states; coarser ones start from level 0's anew.
  void put_back(const std::vector<State<B>>& states) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      HierarchyLevel<B>& part = hierarchy().levels[i];
      part.level.state.copy(hierarchy().exec(), states[i]);
      part.level.flags.clear(hierarchy().exec());
    }
    forget();
    if (const Contact<B>* contact = hierarchy()[0].forces->contact()) contact->take_lost(hierarchy().exec());
    built.cycle->begin(hierarchy());
  }
  void forget() {
    for (auto& part : hierarchy().levels) part.integrator->forget();
  }
  /// From the last kept state once more to where it is, by a cycle that has lost stability since; false where it cannot.
  bool repair() {
    constexpr int most_attempts = 8;
    const long there = steps;
    for (int attempt = 0; built.cycle->alarmed(hierarchy()); ++attempt) {
      if (attempt == most_attempts) return false;
      go_back();
      if (!built.cycle->repair(hierarchy(), built.macro_step, attempt)) return false;
      while (steps < there) step();
    }
    return true;
  }
  void open_budget() {
    const Energies e = meter.all(time);
    start = put_in = kept_put_in = e.total();
    drift = kept_drift = meter.motion(Point::Zero()).drift;
    budget_opens = false;
  }
  /// Level 0's state has been replaced: the other levels follow.
  void restart() {
    for (auto& part : hierarchy().levels) part.level.flags.clear(hierarchy().exec());
    forget();
    built.cycle->begin(hierarchy());
    keep();
    budget_opens = true;
  }
};

}  // namespace plica
