// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/core/problem.hpp>
#include <plica/drivers/run/build_hierarchy.hpp>

namespace plica {

/// The problem of its small motions about rest: every material is `linear`, nothing acts but
/// elasticity and damping, given motions stand still, mappings never switch, implicit levels solve
/// to 1e-12; at the macro step, the shares and the sub-steps of the whole problem, also above a
/// limit. InputError where that is refused, as cycle auto is: ask choose_cycle() before.
template <class B>
Problem about_rest(Problem problem, const typename B::Exec& exec);

/// How a run of small random motion is made and judged.
struct SmallMotionOptions {
  long macro_steps = 400;            ///< at most so many
  std::function<bool()> go_on = {};  ///< asked after every macro step; false ends the run
};

/// What became of it.
struct SmallMotion {
  /// its energy has not grown by more than a factor of ten from the first quarter to the last
  bool bounded = true;
  bool stopped = false;  ///< by go_on
  double growth = 0;     ///< of the amplitude's logarithm per macro step, from quarter to quarter;
                         ///< infinite where it ended early
};

/// The slowest growth of the amplitude's logarithm per macro step that such a run can tell: that at
/// which one mode of so many, all of which start with the same energy, multiplies the whole by ten.
double visible_growth(double modes, long macro_steps);

/// Lets every free vertex start from rest in shape with a random velocity of a millionth of an edge
/// per step, which excites all modes alike, and steps a body without loads by its cycle, its
/// inertia and sub-steps as they were built, with macro steps of t [s].
template <class B>
SmallMotion small_motion(BuiltHierarchy<B>& built, double t, const SmallMotionOptions& options);

}  // namespace plica
