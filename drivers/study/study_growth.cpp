// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/study/study_growth.hpp>

namespace plica {

namespace {

constexpr CycleGrowthOptions bounded_growth{.macro_steps = 500, .tolerance = 1e-6, .dimension = 40};

constexpr Eigen::Index most_dense = 800;
constexpr double close_to_one = 1.001;

template <class B>
CycleGrowth of_all_modes(const CycleMap<B>& map) {
  const Eigen::VectorXcd values = Eigen::EigenSolver<Eigen::MatrixXd>(map.matrix(), false).eigenvalues();
  CycleGrowth found;
  found.macro_step = map.macro_step(), found.macro_steps = map.size();
  found.radius = values.cwiseAbs().maxCoeff(), found.per_second = std::log(found.radius) / found.macro_step;
  found.uncertainty = 1e-6,
  found.converged = true;  // pairs that meet at 1, as of free bodies, are found to the root of rounding
  return found;
}

// What the linearised cycle depends on: its mappings do not switch, and rsv and rsv_sv are rv there; see CycleMap
IntegrationOptions map_of(const StudyCase& one, double macro_step) {
  IntegrationOptions o = one.integration;
  if (o.cycle == "rsv" || o.cycle == "rsv_sv") o.cycle = "rv";
  o.macro_step = macro_step, o.allow_unstable = true;
  return o;
}

}  // namespace

const GrowthOfCycles::Found* GrowthOfCycles::known(const IntegrationOptions& map) const {
  const auto found = std::ranges::find_if(found_, [&](const Found& f) { return steps_alike(f.first, map); });
  return found == found_.end() ? nullptr : &*found;
}

std::optional<CycleGrowth> GrowthOfCycles::of(const StudyCase& one, double macro_step,
                                              std::optional<double> told_from) {
  const IntegrationOptions map = map_of(one, macro_step);
  const auto clear = [&](const CycleGrowth& g) {
    return g.converged || !told_from || std::abs(g.radius - *told_from) > 2 * g.uncertainty;
  };
  if (const Found* before = known(map); before != nullptr && (!before->second || clear(*before->second)))
    return before->second;
  std::erase_if(found_, [&](const Found& f) { return steps_alike(f.first, map); });
  std::optional<CycleGrowth>& growth = found_.emplace_back(map, std::nullopt).second;
  Problem problem = problem_;
  problem.integration = map;
  try {
    using B = Backend<double, Kokkos::DefaultExecutionSpace>;
    const CycleMap<B> cycle(problem);
    CycleGrowthOptions options = bounded_growth;
    const bool few = told_from && *told_from < close_to_one && cycle.size() <= most_dense;
    growth = few ? of_all_modes(cycle) : cycle_growth(cycle, options);
    for (int i = 0; i < 2 && !clear(*growth); ++i) options.macro_steps *= 4, growth = cycle_growth(cycle, options);
  } catch (const InputError&) {
  }
  return growth;
}

double GrowthOfCycles::predicted_evaluations(const StudyCase& one, double macro_step, double duration) const {
  if (known(map_of(one, macro_step)) != nullptr) return 0;
  return one.predicted_evaluations * macro_step / duration * static_cast<double>(bounded_growth.macro_steps);
}

}  // namespace plica
