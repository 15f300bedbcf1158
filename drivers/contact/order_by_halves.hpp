// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// Returns the numbers of points in an order whose aligned runs of 2, 4, 8, ... are compact: those
/// of a run are halved by the longest side of the box around them. The first half has as many as
/// the largest power of two below their number. Equal coordinates follow their numbers.
std::vector<int> order_by_halves(const std::vector<Point>& points);

}  // namespace plica
