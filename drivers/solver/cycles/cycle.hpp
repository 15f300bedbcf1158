// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/hierarchy.hpp>
#include <plica/kernels/motion/prescribe.hpp>

namespace plica {

/// How the levels take a macro step together. A cycle allocates on the levels what it needs and nothing else.
template <class B>
class Cycle {
 public:
  virtual ~Cycle() = default;
  /// Makes the coarser levels' states follow level 0's, which was just set.
  virtual void begin(Hierarchy<B>& hierarchy) = 0;
  /// From `time` over `t` [s].
  virtual void step(Hierarchy<B>& hierarchy, double time, double t) = 0;
};

/// Where motions are given, all levels are at the same time before any of them is looked at.
template <class B>
void prescribe_levels(Hierarchy<B>& hierarchy, double time) {
  for (auto& part : hierarchy.levels) prescribe(hierarchy.exec(), part.level, part.level.state, time);
}

/// Level i's own part of a macro step, from `time` [s]; returns the time it ends at.
template <class B>
double integrate(Hierarchy<B>& hierarchy, int i, double time, double t) {
  HierarchyLevel<B>& part = hierarchy[i];
  Level<B>& level = part.level;
  const double span = part.share * t;
  hierarchy.clock.time("integrate", i, [&] {
    prescribe(hierarchy.exec(), level, level.state, time);
    part.integrator->advance(hierarchy.exec(), level, *part.forces, time, span / part.substeps, part.substeps);
  });
  return time + span;
}

}  // namespace plica
