// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/meshes/box_mesh.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/grid_mesh.hpp>

namespace plica {

TetMesh box_mesh(const Box& box, const std::array<int, 3>& cells) {
  checked_point("the lowest corner of the box", box.min);
  checked_point("the highest corner of the box", box.max);
  const char* const axes[] = {"x", "y", "z"};
  for (int a = 0; a < 3; ++a)
    checked_size(std::string("the size of the box along ") + axes[a], box.max[a] - box.min[a]);
  return grid_mesh(cells, {false, false, false}, [&](const Point& unit) {
    return Point(std::lerp(box.min.x(), box.max.x(), unit.x()), std::lerp(box.min.y(), box.max.y(), unit.y()),
                 std::lerp(box.min.z(), box.max.z(), unit.z()));
  });
}

}  // namespace plica
