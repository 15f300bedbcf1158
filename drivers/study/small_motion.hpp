// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/core/problem.hpp>
#include <plica/drivers/run/build_hierarchy.hpp>

namespace plica {

/// Returns the problem of small motions about rest. Every material is `linear`, only elasticity and
/// damping act, vertices with given motions are fixed, mappings never switch, and implicit levels
/// solve to 1e-12. Macro step, shares and sub-steps are those of the given problem, also above a
/// limit. Throws InputError where the set-up is refused. Cycle auto is refused: call choose_cycle()
/// before.
template <class B>
Problem about_rest(Problem problem, const typename B::Exec& exec);

/// Length of a run of small random motion, and its caller's right to end it.
struct SmallMotionOptions {
  long macro_steps = 400;            ///< maximum number of macro steps
  std::function<bool()> go_on = {};  ///< called after every macro step; false ends the run
};

/// Result of a run of small random motion.
struct SmallMotion {
  /// true where the energy has grown by at most a factor of ten from the first quarter to the last
  bool bounded = true;
  bool stopped = false;  ///< true where go_on ended the run
  /// growth of the amplitude's logarithm per macro step, from the first quarter to the last.
  /// Infinite where the run diverged and ended early
  double growth = 0;
};

/// Returns the slowest growth of the amplitude's logarithm per macro step that small_motion() can
/// detect. At this growth one mode of `modes`, which all start with the same energy, multiplies the
/// whole energy by ten.
double visible_growth(double modes, long macro_steps);

/// Runs a body without loads from its rest shape, with macro steps of t [s]. Every free vertex
/// starts with a random velocity of a millionth of an edge per macro step, which excites all modes
/// alike. Cycle, inertia and sub-steps are as they were built.
template <class B>
SmallMotion small_motion(BuiltHierarchy<B>& built, double t, const SmallMotionOptions& options);

}  // namespace plica
