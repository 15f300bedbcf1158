// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/core/type_list.hpp>
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
  static std::vector<double> weights(const LevelFacts& facts) { return std::vector<double>(facts.tets.size(), 1.0); }
};

struct InverseElementShares {
  static constexpr const char* name = "inverse_elements";
  static constexpr const char* summary = "in proportion to 1/(number of tetrahedra), the paper's equation 1";
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

/// Every computed distribution there is; `custom` is a list in the options. One more: its struct above, its name here.
using Distributions = TypeList<EqualShares, InverseElementShares, CriticalShares>;

/// The shares that the options ask for, after shift_to_coarsest. Throws InputError for an unknown name, a list of the wrong
/// length, a share that is not positive (critical: of a level without a
/// limit) or a sum that is not 1 to 1e-12.
std::vector<double> make_shares(const IntegrationOptions& options, const LevelFacts& facts);

}  // namespace plica
