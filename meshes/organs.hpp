// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// A soft lump like a liver: a ball stretched to `length` along x, thick and broad at its lower end
/// and tapering to the other, with a hollow underside. A lump of a third of its volume's extent
/// lies inside the thick end: the region "inclusion", the rest is "tissue". The vertex set "base"
/// is the cap at the thick end. All shapes are of our own making, one smooth map of ball_mesh().
///
/// @param centre  of the ball before it is shaped, finite [m]
/// @param length  along x, above zero [m]
/// @param cells   across, a multiple of 4, so that faces follow the inclusion
/// @return        (cells + 1)^3 vertices, 6 cells^3 tetrahedra; InputError for anything else
TetMesh blob_mesh(const Point& centre, double length, int cells);

/// A pipe with a wall, like a vessel: its axis starts at `start` along z and bends towards x in a
/// circle.
struct Tube {
  Point start = Point::Zero();  ///< centre of the first end [m]
  double radius = 1;            ///< of the inside [m]
  double wall = 1;              ///< its thickness [m]
  double length = 1;            ///< of the axis [m]
  /// angle that the axis turns by, in [0, length / (radius + wall)) [rad]
  double bend = 0;
  int around = 3;  ///< cells around, 3 or more
  int across = 1;  ///< cells through the wall
  int along = 1;   ///< cells along the axis
};

/// Vertex sets: "inlet" and "outlet", the rings at its ends; "lumen" and "outside", the two sides
/// of its wall.
/// @return  (across + 1) around (along + 1) vertices, 6 across around along tetrahedra; InputError
/// for anything else
TetMesh tube_mesh(const Tube& tube);

}  // namespace plica
