// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string_view>

namespace plica {

/// Gives a problem the options of one of presets(). InputError for another name.
void apply_preset(std::string_view name, Problem& problem);

}  // namespace plica
