// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// Settings put over a problem's own for cycles that are named with it; what is empty stays. See IntegrationOptions.
struct StudyVariant {
  std::optional<double> shift_to_coarsest;
  std::optional<std::vector<std::string>> integrator;
  std::optional<std::vector<int>> substeps;
  std::optional<double> safety;
  std::optional<bool> allow_unstable;
  std::optional<double> switch_threshold;
  std::optional<std::string> outside;
};

IntegrationOptions with(IntegrationOptions options, const StudyVariant& variant);

/// The same run, as far as variants, cycles and steps can tell: a threshold differs only where mappings switch.
bool steps_alike(const IntegrationOptions& a, const IntegrationOptions& b);

/// "cycle/rsv/critical+hybrid", without what is empty.
std::string study_label(const std::string& method, const std::string& distribution, const std::string& variant);

}  // namespace plica
