// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <string>

namespace plica {

/// Returns `value` if it is finite and above zero; else throws an InputError "WHAT is VALUE; it
/// must be ...".
double checked_size(const std::string& what, double value);

/// Returns `point` if its three coordinates are finite; else throws an InputError.
Point checked_point(const std::string& what, const Point& point);

/// Returns `cells` if it is at least 1; else throws an InputError.
int checked_cells(const std::string& what, int cells);

/// Throws an InputError if `count` is too large for an int, before anything of that size is
/// allocated. The count is a double, as the product of counts may not fit an integer.
void checked_count(const std::string& what, double count);

}  // namespace plica
