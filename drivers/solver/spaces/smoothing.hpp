// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/SparseCore>
#include <plica/core/mesh.hpp>

namespace plica {

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Values at a mesh's vertices smoothed over their edges, [vertices x vertices]: each vertex takes a weighted average over itself
/// and its neighbours, by moving least squares of degree one (Lancaster & Salkauskas 1981), so that linear fields stay as they
/// are. The weight is the spline (1 - s)^2 (1 + 2 s) of the distance over 1.2 times the vertex's longest edge. Vertices with too
/// few neighbours, or whose weights would grow beyond 3, keep their value.
RowMatrix ring_smoothing(const TetMesh& mesh);

}  // namespace plica
