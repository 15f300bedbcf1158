// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/error.hpp>
#include <plica/core/problem.hpp>
#include <plica/drivers/solver/simulation.hpp>
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
  StiffElement stiffest = {};  ///< the worst of its elements
  double typical_element = 0;  ///< the median of what elements allow by themselves [s]
};

struct StepPlan {
  double macro_step = 0;      ///< [s]
  std::vector<double> share;  ///< finest first, sums to 1
  std::vector<int> substeps;
};

/// Elements whose own step is below this part of their level's median are named: fewer than that the mesh means, more than
/// sound meshes of one material have.
inline constexpr double named_below = 0.5;

/// An explicit sub-step above its limit. Where one element sets that, `element` tells which, for who knows another number of it.
class SubstepRefused : public InputError {
 public:
  SubstepRefused(const std::string& words, int level, const std::optional<StiffElement>& element);
  std::string words;                    ///< without the element
  int level;                            ///< 0: the finest
  std::optional<StiffElement> element;  ///< in the level's mesh
};

/// Shares, macro step and sub-steps of a cycle. Throws InputError for an explicit sub-step above its limit unless
/// allow_unstable, with the numbers and the remedy, and where a macro step cannot be derived.
StepPlan plan_steps(const IntegrationOptions& options, const std::vector<LevelLimits>& levels);

}  // namespace plica
