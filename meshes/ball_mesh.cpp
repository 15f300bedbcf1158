// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/ball_mesh.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/grid_mesh.hpp>
#include <plica/meshes/rounded.hpp>

namespace plica {

TetMesh ball_mesh(const Point& centre, double radius, int cells) {
  checked_point("the centre of the ball", centre);
  checked_size("the radius of the ball", radius);
  return grid_mesh({cells, cells, cells}, {true, true, true},
                   [&](const Point& unit) -> Point { return centre + radius * rounded(2.0 * unit - Point::Ones()); });
}

}  // namespace plica
