// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string_view>

namespace plica {

/// The material of one of tissues(), with the values of its source. InputError for another name.
MaterialOptions tissue_material(std::string_view name);

}  // namespace plica
