// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/drivers/solver/integrators/integrator.hpp>
#include <vector>

namespace plica {

/// A level with what acts on it and moves it.
template <class B>
struct HierarchyLevel {
  Level<B> level;
  std::unique_ptr<LevelForces<B>> forces;
  std::unique_ptr<Integrator<B>> integrator;
  double share = 1;  ///< of the macro step
  int substeps = 1;
};

/// All resolutions of one body, finest first.
template <class B>
struct Hierarchy {
  explicit Hierarchy(const typename B::Exec& exec) : clock(exec) {}
  StageClock<B> clock;
  std::vector<HierarchyLevel<B>> levels;

  const typename B::Exec& exec() const { return clock.exec(); }
  int count() const { return static_cast<int>(levels.size()); }
  HierarchyLevel<B>& operator[](int i) { return levels[static_cast<std::size_t>(i)]; }
  const HierarchyLevel<B>& operator[](int i) const { return levels[static_cast<std::size_t>(i)]; }
};

}  // namespace plica
