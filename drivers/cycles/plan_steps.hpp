// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/error.hpp>
#include <plica/core/problem.hpp>
#include <plica/core/reports.hpp>
#include <plica/core/type_list.hpp>
#include <string>
#include <vector>

// How a macro step is shared out among the levels. All shares are positive and sum to 1.
namespace plica {

/// What a distribution looks at, per level, finest first.
struct LevelFacts {
  std::vector<double> tets;
  std::vector<double> critical_step;  ///< as an explicit level, [s]
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

/// Every computed distribution there is; `custom` is a list in the options. One more: its struct
/// above, its name here.
using Distributions = TypeList<EqualShares, InverseElementShares, CriticalShares>;

/// The shares that the options ask for, after shift_to_coarsest. Throws InputError for an unknown
/// name, a list of the wrong length, a share that is not positive (critical: of a level without a
/// limit) or a sum that is not 1 to 1e-12.
std::vector<double> make_shares(const IntegrationOptions& options, const LevelFacts& facts);

/// Throws InputError where the options list shares of the macro step that are not one for each
/// level, above 0, 1 together.
void validate_shares(const IntegrationOptions& options, std::size_t levels);

/// What the plan of steps needs to know of a level.
struct LevelLimits {
  int tets = 0;
  std::string integrator;
  bool is_explicit = true;
  double critical_step = 0;    ///< of an explicit integrator its own, of an implicit one symplectic
                               ///< Euler's [s]; 0: none is stable
  StiffElement stiffest = {};  ///< the worst of its elements
  double typical_element = 0;  ///< the median of what elements allow by themselves [s]
};

struct StepPlan {
  double macro_step = 0;      ///< [s]
  std::vector<double> share;  ///< finest first, sums to 1
  std::vector<int> substeps;
};

/// Elements whose own step is below this part of their level's median are named: fewer than that
/// the mesh means, more than sound meshes of one material have.
inline constexpr double named_below = 0.5;

/// An explicit sub-step above its limit. `element`: the one that sets the limit, if one alone does;
/// a caller may number it otherwise.
class SubstepRefused : public InputError {
 public:
  SubstepRefused(const std::string& words, int level, const std::optional<StiffElement>& element);
  std::string words;                    ///< without the element
  int level;                            ///< 0: the finest
  std::optional<StiffElement> element;  ///< in the level's mesh
};

/// Shares, macro step and sub-steps of a cycle. Throws InputError for an explicit sub-step above
/// its limit unless allow_unstable, with the numbers and the remedy, and where a macro step cannot
/// be derived.
StepPlan plan_steps(const IntegrationOptions& options, const std::vector<LevelLimits>& levels);

}  // namespace plica
