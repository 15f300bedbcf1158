// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>

namespace plica {

/// Weights of the four corners of a tetrahedron; they sum to 1.
using Weights = std::array<double, 4>;

/// The weights that make up `p`, negative on the far side of a face.
/// @param corners  of a tetrahedron with positive volume [m]
Weights barycentric(const Point& p, const std::array<Point, 4>& corners);

/// The weights of the point of the tetrahedron that is nearest to `p`, none below zero; those of `p` when it is inside.
/// A triangle's nearest point after C. Ericson, Real-Time Collision Detection (2005), section 5.1.5.
Weights nearest_inside(const Point& p, const std::array<Point, 4>& corners);

/// The point with these weights. [m]
Point weighted(const Weights& weights, const std::array<Point, 4>& corners);

/// The corners of one tetrahedron of a mesh. [m]
std::array<Point, 4> corners_of(const TetMesh& mesh, int tet);

}  // namespace plica
