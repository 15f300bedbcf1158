// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/mesh.hpp>

namespace plica {

Box bounding_box(const std::vector<Point>& points) {
  if (points.empty()) return {};
  Box box{points.front(), points.front()};
  for (const Point& p : points) box = {box.min.cwiseMin(p), box.max.cwiseMax(p)};
  return box;
}

}  // namespace plica
