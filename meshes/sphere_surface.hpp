// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// A sphere: an icosahedron whose triangles are cut in four `subdivisions` times, every vertex on the sphere. The
/// vertices of a coarser sphere come first in a finer one.
///
/// @param centre        finite [m]
/// @param radius        above zero [m]
/// @param subdivisions  0 or more
/// @return              10 * 4^s + 2 vertices, 20 * 4^s triangles; InputError for anything else, or when a count does
///                      not fit an int (s above 13)
TriangleSurface sphere_surface(const Point& centre, double radius, int subdivisions);

}  // namespace plica
