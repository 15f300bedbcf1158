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
  /// The same at the very start, where it may also change level 0's velocities into what it can carry.
  virtual void start(Hierarchy<B>& hierarchy) { begin(hierarchy); }
  /// Whether steps so far have lost stability, though the state may still look sound. Waits.
  virtual bool alarmed(const Hierarchy<B>&) const { return false; }
  /// Makes steps of `t` [s] stable again at the state as it is; false where it cannot. `attempt`: how many before have not
  /// been enough.
  virtual bool repair(Hierarchy<B>&, double, int) { return false; }
  virtual std::map<std::string, long> counters() const { return {}; }
  /// Device memory of its own.
  virtual std::size_t bytes() const { return 0; }
  /// Names what it carries from one macro step to the next, besides the levels' states.
  virtual void persist(StateArchive<B>&) {}
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
    if (hierarchy.count() > 1) part.integrator->forget();  // other levels have changed the state
    part.integrator->advance(hierarchy.exec(), level, *part.forces, time, span / part.substeps, part.substeps);
  });
  return time + span;
}

}  // namespace plica
