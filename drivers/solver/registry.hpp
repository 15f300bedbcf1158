// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <string_view>
#include <vector>

/// The families a scene chooses from, as lists to print and to check names against. Each walks the family's own list.
namespace plica {

struct Choice {
  std::string name;
  std::string summary;  ///< one line
};

std::vector<Choice> materials();
std::vector<Choice> integrators();
std::vector<Choice> cycles();
std::vector<Choice> distributions();
std::vector<Choice> obstacle_shapes();
std::vector<Choice> linear_solvers();

/// Whether that cycle uses more than the finest level; false for a name it does not know.
bool uses_coarse_levels(std::string_view cycle);

std::vector<std::string> names(const std::vector<Choice>& choices);

}  // namespace plica
