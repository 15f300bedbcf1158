// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <string>

namespace plica {

/// `value` when it is finite and above zero; else an InputError "WHAT is VALUE; it must be ...".
double checked_size(const std::string& what, double value);

/// `point` when its three coordinates are finite; else an InputError.
Point checked_point(const std::string& what, const Point& point);

/// `cells` when it is at least 1; else an InputError.
int checked_cells(const std::string& what, int cells);

/// Refuses what an int cannot number, before anything of that size is allocated. The count is a
/// double, as the product of counts may not fit an integer.
void checked_count(const std::string& what, double count);

}  // namespace plica
