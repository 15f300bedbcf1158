// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/study/cycle_map.hpp>
#include <plica/drivers/study/study_case.hpp>
#include <utility>

namespace plica {

/// How small motions about rest grow by a study's cycles, in double. A map that several runs share, whatever their precision,
/// threads or mappings of the same linear part, is examined once, for some hundred macro steps.
class GrowthOfCycles {
 public:
  explicit GrowthOfCycles(const Problem& problem) : problem_(problem) {}

  /// Of that case at this macro step [s]; none where its set-up is refused.
  /// @param told_from  a radius that it is to be told from: close to 1, of a small body, by all eigenvalues; else, where its uncertainty is
  ///                   too large for that, by longer runs, up to 16 times
  std::optional<CycleGrowth> of(const StudyCase& one, double macro_step, std::optional<double> told_from = {});

  /// Evaluations of tetrahedra that of() is to take, at most, in a study so long [s]; 0 where the map is known.
  double predicted_evaluations(const StudyCase& one, double macro_step, double duration) const;

 private:
  using Found = std::pair<IntegrationOptions, std::optional<CycleGrowth>>;
  const Found* known(const IntegrationOptions& map) const;

  const Problem& problem_;
  std::vector<Found> found_;
};

}  // namespace plica
