// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <functional>
#include <plica/core/mesh.hpp>

namespace plica {

/// Carries the cube [-1, 1]^3 to the unit ball, the square z = 0 to the unit disc, shell by shell.
///
/// On a shell the angle is proportional to the coordinate (an "equiangular cubed sphere"), which
/// spreads the vertices evenly; towards the centre the shells become cubes again, where the grid is
/// best left alone.
Point rounded(const Point& p);

/// A grid of cells, each cut into the six tetrahedra around one of its diagonals (Kuhn's
/// triangulation), carried to space by `map`, which takes the unit cube to the body and must keep
/// its orientation.
///
/// Vertices are numbered x fastest, then y, then z. Along an axis that is not mirrored every
/// diagonal points up; along a mirrored one it points away from the middle. Neighbours agree on the
/// cut of their common face in either case: it depends on the two axes of the face only, and along
/// those both cells have the same index.
///
/// @param cells     per axis, 1 or more; InputError otherwise, or when a count does not fit an int
/// @param mirrored  per axis
/// @param map       from the unit cube
/// @return          (cells + 1) vertices along each axis, six tetrahedra per cell
TetMesh grid_mesh(const std::array<int, 3>& cells, const std::array<bool, 3>& mirrored,
                  const std::function<Point(const Point&)>& map);

/// A box of cells, each cut into six tetrahedra around the diagonal from its lowest to its highest
/// corner. Vertices are numbered x fastest; the outermost lie exactly on the box.
///
/// @param box    both ends finite [m], min below max along every axis; InputError otherwise
/// @param cells  per axis, 1 or more; InputError otherwise, or when a count does not fit an int
/// @return       prod(cells + 1) vertices, 6 prod(cells) tetrahedra
TetMesh box_mesh(const Box& box, const std::array<int, 3>& cells);

/// A ball: a cube of cells whose shells become spheres. The diagonals of the cells point away from
/// the centre, so that no tetrahedron has two faces on the sphere, where it would be flat.
///
/// @param centre  finite [m]
/// @param radius  above zero [m]
/// @param cells   across the diameter, 1 or more
/// @return        (cells + 1)^3 vertices, 6 cells^3 tetrahedra; InputError for anything else
TetMesh ball_mesh(const Point& centre, double radius, int cells);

/// A cylinder that stands on `base` and rises along z: layers of a square of cells whose rings
/// become circles.
///
/// @param base    centre of the lower disc, finite [m]
/// @param radius  above zero [m]
/// @param length  above zero [m]
/// @param across  cells across the diameter, 1 or more
/// @param along   cells along the axis, 1 or more
/// @return        (across + 1)^2 (along + 1) vertices, 6 across^2 along tetrahedra; InputError for anything else
TetMesh cylinder_mesh(const Point& base, double radius, double length, int across, int along);

/// A sphere: an icosahedron whose triangles are cut in four `subdivisions` times, every vertex on
/// the sphere. The vertices of a coarser sphere come first in a finer one.
///
/// @param centre        finite [m]
/// @param radius        above zero [m]
/// @param subdivisions  0 or more
/// @return              10 * 4^s + 2 vertices, 20 * 4^s triangles; InputError for anything else, or when a count does
///                      not fit an int (s above 13)
TriangleSurface sphere_surface(const Point& centre, double radius, int subdivisions);

}  // namespace plica
