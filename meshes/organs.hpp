// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// Returns a soft lump like a liver, made by a smooth map of ball_mesh(). It is a ball stretched to
/// `length` along x, thick and broad at its lower end. It tapers to the other end, and has a hollow
/// underside. A smaller lump inside the thick end is the region "inclusion"; the rest is "tissue".
/// The inclusion has 45 to 48 % of the body's extent along each axis. The vertex set "base" is the
/// cap at the thick end.
///
/// @param centre  centre of the ball before it is shaped, finite [m]
/// @param length  length along x, above zero [m]
/// @param cells   number of cells across, a multiple of 4, so that faces follow the inclusion
/// @return        (cells + 1)^3 vertices, 6 cells^3 tetrahedra; InputError for anything else
TetMesh blob_mesh(const Point& centre, double length, int cells);

/// Pipe with a wall, like a vessel. The axis starts at `start` along z and bends towards x in a
/// circle.
struct Tube {
  Point start = Point::Zero();  ///< centre of the first end [m]
  double radius = 1;            ///< inner radius [m]
  double wall = 1;              ///< thickness of the wall [m]
  double length = 1;            ///< length of the axis [m]
  /// angle that the axis turns by, in [0, length / (radius + wall)) [rad]
  double bend = 0;
  int around = 3;  ///< cells around, 3 or more
  int across = 1;  ///< cells through the wall
  int along = 1;   ///< cells along the axis
};

/// Returns a tube with four vertex sets. "inlet" and "outlet" are the rings at its ends; "lumen"
/// and "outside" are the inner and outer sides of its wall.
/// @return  (across + 1) around (along + 1) vertices, 6 across around along tetrahedra; InputError
/// for anything else
TetMesh tube_mesh(const Tube& tube);

}  // namespace plica
