// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/study/study_case.hpp>

namespace plica {

struct ChosenMethod {
  std::string method;
  std::string distribution;  ///< of a cycle
  std::string variant;       ///< of a cycle
};

/// The methods of the options, families, distributions and variants spelt out, none twice. InputError for an unknown name.
std::vector<ChosenMethod> chosen_methods(const Problem& problem, const StudyOptions& options);

}  // namespace plica
