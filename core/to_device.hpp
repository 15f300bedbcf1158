// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/fields.hpp>
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// Returns points as the rows of a view.
template <class Real>
std::vector<std::array<Real, 3>> rows(const std::vector<Point>& points) {
  std::vector<std::array<Real, 3>> result;
  result.reserve(points.size());
  for (const Point& p : points)
    result.push_back({static_cast<Real>(p[0]), static_cast<Real>(p[1]), static_cast<Real>(p[2])});
  return result;
}

}  // namespace plica
