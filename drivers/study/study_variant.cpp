// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/solver/cycles/list.hpp>
#include <plica/drivers/study/study_variant.hpp>
#include <tuple>

namespace plica {

namespace {

bool has_switch(const std::string& cycle) {
  bool has = false;
  Cycles::visit(cycle, [&](auto member) { has = decltype(member)::switched; });
  return has;
}

// One for all levels, or one each: do they say the same?
template <class T>
bool alike_per_level(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() == b.size()) return a == b;
  const auto& [one, each] = std::minmax(a, b, [](const auto& x, const auto& y) { return x.size() < y.size(); });
  return one.size() == 1 && std::ranges::all_of(each, [&](const T& x) { return x == one.front(); });
}

}  // namespace

IntegrationOptions with(IntegrationOptions options, const StudyVariant& variant) {
  const auto put = [](auto& setting, const auto& instead) {
    if (instead) setting = *instead;
  };
  put(options.shift_to_coarsest, variant.shift_to_coarsest);
  put(options.integrator, variant.integrator);
  put(options.substeps, variant.substeps);
  put(options.safety, variant.safety);
  put(options.allow_unstable, variant.allow_unstable);
  put(options.switch_threshold, variant.switch_threshold);
  put(options.outside, variant.outside);
  return options;
}

bool steps_alike(const IntegrationOptions& a, const IntegrationOptions& b) {
  const auto rest = [](const IntegrationOptions& o) {
    return std::tie(o.cycle, o.macro_step, o.distribution, o.shares, o.shift_to_coarsest, o.safety, o.allow_unstable,
                    o.outside);
  };
  return rest(a) == rest(b) && alike_per_level(a.integrator, b.integrator) && alike_per_level(a.substeps, b.substeps) &&
         (a.error_class == b.error_class || a.cycle != "auto") &&
         (a.switch_threshold == b.switch_threshold || !has_switch(a.cycle));
}

std::string study_label(const std::string& method, const std::string& distribution, const std::string& variant) {
  return method + (distribution.empty() ? "" : "/" + distribution) + (variant.empty() ? "" : "+" + variant);
}

}  // namespace plica
