// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/drivers/study/study_growth.hpp>

namespace plica {

namespace {

constexpr CycleGrowthOptions bounded_growth{.macro_steps = 500, .tolerance = 1e-6, .dimension = 40};

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

std::optional<CycleGrowth> GrowthOfCycles::of(const StudyCase& one, double macro_step) {
  const IntegrationOptions map = map_of(one, macro_step);
  if (const Found* before = known(map)) return before->second;
  std::optional<CycleGrowth>& growth = found_.emplace_back(map, std::nullopt).second;
  Problem problem = problem_;
  problem.integration = map;
  try {
    using B = Backend<double, Kokkos::DefaultExecutionSpace>;
    growth = cycle_growth(CycleMap<B>(problem), bounded_growth);
  } catch (const InputError&) {
  }
  return growth;
}

double GrowthOfCycles::predicted_evaluations(const StudyCase& one, double macro_step, double duration) const {
  if (known(map_of(one, macro_step)) != nullptr) return 0;
  return one.predicted_evaluations * macro_step / duration * static_cast<double>(bounded_growth.macro_steps);
}

}  // namespace plica
