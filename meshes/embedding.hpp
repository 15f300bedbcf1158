// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/meshes/barycentric.hpp>
#include <plica/meshes/tet_locator.hpp>
#include <vector>

namespace plica {

/// What becomes of a point outside every tetrahedron.
enum class Outside {
  clamp,        ///< it moves with the nearest point of the mesh: no weight below zero
  extrapolate,  ///< it continues the nearest tetrahedron, each weight held at -0.5 or above
  keep          ///< it has no counterpart: a row of zero weights, for the caller to leave out
};

/// How points hang on a mesh: one row per point, value(point) = sum over k of weights[k] * value(vertices[k]).
///
/// Rows sum to 1 (but kept ones), so translations are exact; linear fields are exact inside to rounding and, unless a
/// weight was held, where extrapolated.
struct Embedding {
  std::vector<std::array<int, 4>> vertices;  ///< of the tetrahedron, also in kept rows
  std::vector<Weights> weights;              ///< of these vertices
  std::vector<char> outside;                 ///< 1 for a miss
  int misses = 0;                            ///< points outside
  int held = 0;                              ///< misses whose weights were held back (extrapolate)
  double largest_distance_over_edge = 0.0;   ///< of a miss to the mesh, over the mean edge of its tetrahedron
};

/// @param points   finite [m]; InputError otherwise, with the point's index
/// @param locator  of the mesh; build it once when several sets of points hang on the same mesh
/// @param outside  what becomes of points outside it
Embedding embed(const std::vector<Point>& points, const TetLocator& locator, Outside outside);

/// The same with a locator of its own.
Embedding embed(const std::vector<Point>& points, const TetMesh& mesh, Outside outside);

}  // namespace plica
