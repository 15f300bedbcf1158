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

/// How that method is run: all of a case but its macro step, precision and threads.
StudyCase study_case(const Problem& problem, const StudyOptions& options, const ChosenMethod& chosen);

}  // namespace plica
