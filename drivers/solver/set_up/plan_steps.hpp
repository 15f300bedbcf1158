// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// What the plan of steps needs to know of a level.
struct LevelLimits {
  int tets = 0;
  std::string integrator;
  bool is_explicit = true;
  double critical_step =
      0;  ///< of an explicit integrator its own, of an implicit one symplectic Euler's [s]; 0: none is stable
};

struct StepPlan {
  double macro_step = 0;      ///< [s]
  std::vector<double> share;  ///< finest first, sums to 1
  std::vector<int> substeps;
};

/// Shares, macro step and sub-steps of a cycle. Throws InputError for an explicit sub-step above its limit unless
/// allow_unstable, with the numbers and the remedy, and where a macro step cannot be derived.
StepPlan plan_steps(const IntegrationOptions& options, const std::vector<LevelLimits>& levels);

}  // namespace plica
