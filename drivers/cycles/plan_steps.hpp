// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/error.hpp>
#include <plica/core/problem.hpp>
#include <plica/core/reports.hpp>
#include <plica/core/type_list.hpp>
#include <string>
#include <vector>

// Shares of the macro step that the levels take. All shares are positive and sum to 1.
namespace plica {

/// Properties that a distribution may use, one per level, finest first.
struct LevelFacts {
  std::vector<double> tets;           ///< number of tetrahedra
  std::vector<double> critical_step;  ///< critical step as an explicit level [s]
};

struct EqualShares {
  static constexpr const char* name = "equal";
  static constexpr const char* summary = "1/M each, the original algorithm";
  static std::vector<double> weights(const LevelFacts& facts) {
    return std::vector<double>(facts.tets.size(), 1.0);
  }
};

struct InverseElementShares {
  static constexpr const char* name = "inverse_elements";
  static constexpr const char* summary =
      "in proportion to 1/(number of tetrahedra), the paper's equation 1";
  static std::vector<double> weights(const LevelFacts& facts) {
    std::vector<double> w;
    for (double n : facts.tets) w.push_back(1 / n);
    return w;
  }
};

struct CriticalShares {
  static constexpr const char* name = "critical";
  static constexpr const char* summary = "in proportion to each level's critical step";
  static std::vector<double> weights(const LevelFacts& facts) { return facts.critical_step; }
};

/// All distributions that are computed; `custom` is a list in the options.
/// To add one, write its struct above and its name here.
using Distributions = TypeList<EqualShares, InverseElementShares, CriticalShares>;

/// Returns the shares that the options ask for, after shift_to_coarsest.
/// Throws InputError for an unknown name, a list of the wrong length, a share that is not positive,
/// or a sum that differs from 1 by more than 1e-12. `critical` finds no share for a level without a
/// limit.
std::vector<double> make_shares(const IntegrationOptions& options, const LevelFacts& facts);

/// Throws InputError where listed shares are not one for each level, above 0, with the sum 1.
void validate_shares(const IntegrationOptions& options, std::size_t levels);

/// Properties of a level that the plan of steps depends on.
struct LevelLimits {
  int tets = 0;
  std::string integrator;
  bool is_explicit = true;
  /// largest stable step of an explicit integrator, of symplectic Euler for an implicit one [s]; 0:
  /// no step is stable
  double critical_step = 0;
  StiffElement stiffest = {};  ///< element with the smallest step of its own
  double typical_element = 0;  ///< median of the steps that elements allow by themselves [s]
};

struct StepPlan {
  double macro_step = 0;      ///< [s]
  std::vector<double> share;  ///< finest first, sums to 1
  std::vector<int> substeps;
};

/// Limit below which an element is named: its own step over the median step of its level's
/// elements. Sound meshes of one material have no element below it.
inline constexpr double named_below = 0.5;

/// Error of an explicit sub-step above its limit. `element`: the element that sets the limit, if
/// one alone does. A caller may throw it again with the element's number in another mesh.
class SubstepRefused : public InputError {
 public:
  SubstepRefused(const std::string& words, int level, const std::optional<StiffElement>& element);
  std::string words;                    ///< message without the element
  int level;                            ///< 0: the finest
  std::optional<StiffElement> element;  ///< numbered in the level's mesh
};

/// Returns shares, macro step and sub-steps of a cycle.
/// Throws InputError where a macro step cannot be derived. Throws SubstepRefused, with the numbers
/// and the remedy, for an explicit sub-step above its limit unless allow_unstable.
/// `cuts`: the body will be cut, after which its limits are shorter; an automatic macro step leaves
/// room for that.
StepPlan plan_steps(const IntegrationOptions& options, const std::vector<LevelLimits>& levels,
                    bool cuts = false);

}  // namespace plica
