// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <functional>
#include <plica/core/mesh.hpp>

namespace plica {

/// Maps the cube [-1, 1]^3 to the unit ball, and its square z = 0 to the unit disc.
///
/// The surfaces of smaller cubes around the centre become shells of the ball. On a shell the angle
/// is proportional to the coordinate (an "equiangular cubed sphere"), which spreads the vertices
/// evenly. Towards the centre the shells become cubes again, where the regular grid is best.
Point rounded(const Point& p);

/// Returns a grid of cells, each cut into the six tetrahedra around one of its diagonals (Kuhn's
/// triangulation). The grid fills the unit cube; `map` takes its vertices to the body.
///
/// Vertices are numbered x fastest, then y, then z. Along an axis that is not mirrored every
/// diagonal points up; along a mirrored one it points away from the middle. Neighbours agree on the
/// cut of their common face in either case. The cut depends on the two axes of the face only, and
/// both cells have the same index along these axes.
///
/// @param cells     per axis, 1 or more; InputError otherwise, or when a count does not fit an int
/// @param mirrored  per axis, whether the diagonals are mirrored at the middle
/// @param map       from the unit cube to the body [m]; it must keep the orientation
/// @return          (cells + 1) vertices along each axis, six tetrahedra per cell
TetMesh grid_mesh(const std::array<int, 3>& cells, const std::array<bool, 3>& mirrored,
                  const std::function<Point(const Point&)>& map);

/// Returns a box of cells, each cut into six tetrahedra around the diagonal from its lowest to its
/// highest corner. Vertices are numbered x fastest; the outermost lie exactly on the box.
///
/// @param box    both ends finite [m], min below max along every axis; InputError otherwise
/// @param cells  per axis, 1 or more; InputError otherwise, or when a count does not fit an int
/// @return       prod(cells + 1) vertices, 6 prod(cells) tetrahedra
TetMesh box_mesh(const Box& box, const std::array<int, 3>& cells);

/// Returns a ball: a cube of cells whose shells become spheres. The diagonals of the cells point
/// away from the centre. No tetrahedron thus has two faces on the sphere, where it would be flat.
///
/// @param centre  finite [m]
/// @param radius  above zero [m]
/// @param cells   across the diameter, 1 or more
/// @return        (cells + 1)^3 vertices, 6 cells^3 tetrahedra; InputError for anything else
TetMesh ball_mesh(const Point& centre, double radius, int cells);

/// Returns a cylinder that stands on `base` and rises along z. Each layer is a square of cells
/// whose rings become circles.
///
/// @param base    centre of the lower disc, finite [m]
/// @param radius  above zero [m]
/// @param length  above zero [m]
/// @param across  cells across the diameter, 1 or more
/// @param along   cells along the axis, 1 or more
/// @return        (across + 1)^2 (along + 1) vertices, 6 across^2 along tetrahedra; InputError for
/// anything else
TetMesh cylinder_mesh(const Point& base, double radius, double length, int across, int along);

/// Returns a sphere: an icosahedron whose triangles are cut in four `subdivisions` times, with
/// every vertex on the sphere. The vertices of a coarser sphere come first in a finer one.
///
/// @param centre        finite [m]
/// @param radius        above zero [m]
/// @param subdivisions  0 or more
/// @return              10 * 4^s + 2 vertices, 20 * 4^s triangles; InputError for anything else, or
/// when a count does not fit an int (s above 13)
TriangleSurface sphere_surface(const Point& centre, double radius, int subdivisions);

}  // namespace plica
