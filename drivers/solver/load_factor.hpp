// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/load.hpp>

namespace plica {

/// What a load's forces are multiplied with at a time [s] >= 0.
double load_factor(const LoadCourse& course, double time);

}  // namespace plica
