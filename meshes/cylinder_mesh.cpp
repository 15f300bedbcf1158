// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/checked.hpp>
#include <plica/meshes/cylinder_mesh.hpp>
#include <plica/meshes/grid_mesh.hpp>
#include <plica/meshes/rounded.hpp>

namespace plica {

TetMesh cylinder_mesh(const Point& base, double radius, double length, int across, int along) {
  checked_point("the base of the cylinder", base);
  checked_size("the radius of the cylinder", radius);
  checked_size("the length of the cylinder", length);
  return grid_mesh({across, across, along}, {true, true, false}, [&](const Point& unit) -> Point {
    const Point disc = rounded(Point(2.0 * unit.x() - 1.0, 2.0 * unit.y() - 1.0, 0.0));
    return base + Point(radius * disc.x(), radius * disc.y(), length * unit.z());
  });
}

}  // namespace plica
