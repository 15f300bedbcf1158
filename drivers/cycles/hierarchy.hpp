// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/level/integrator.hpp>
#include <plica/drivers/level/level.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>
#include <vector>

namespace plica {

/// All levels of one scene, finest first.
template <class B>
struct Hierarchy {
  explicit Hierarchy(const typename B::Exec& exec) : clock(exec) {}
  StageTimer<B> clock;
  /// levels, finest first; none may be added after integrators were made, since linear solvers keep
  /// pointers to them
  std::vector<Level<B>> levels;

  const typename B::Exec& exec() const { return clock.exec(); }
  int count() const { return static_cast<int>(levels.size()); }
  Level<B>& operator[](int i) { return levels[static_cast<std::size_t>(i)]; }
  const Level<B>& operator[](int i) const { return levels[static_cast<std::size_t>(i)]; }

  void begin_macro_step(double part) {
    for (Level<B>& level : levels) level.begin_macro_step(part);
  }
  /// Forgets all that is carried from earlier steps, after the states were replaced.
  void reset_history() {
    for (Level<B>& level : levels) level.reset_history();
  }
  void clear_flags() {
    for (Level<B>& level : levels) level.flags.clear(exec());
  }
};

}  // namespace plica
