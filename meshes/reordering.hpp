// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// New order of vertices and tetrahedra: per new number the old one.
struct Reordering {
  std::vector<int> vertices;  ///< per new vertex its old number
  std::vector<int> tets;      ///< per new tetrahedron its old number
};

/// Returns the tetrahedra along a Hilbert curve through their centroids. Those in one cell of the
/// curve's grid, 2^21 cells along an edge of the bounding cube, ascend.
std::vector<int> tets_along_curve(const TetMesh& mesh);

/// Returns an order in which neighbours in space are neighbours in memory. Tetrahedra follow
/// tets_along_curve(); vertices come in the order in which these tetrahedra first use them. The
/// order of a mesh is equal on every machine.
Reordering locality_order(const TetMesh& mesh);

/// Returns the inverse order: per old number the new one.
Reordering inverse(const Reordering& order);

/// Returns the mesh in another order. Other data per vertex or tetrahedron are reordered by
/// permuted().
TetMesh reordered(const TetMesh& mesh, const Reordering& order);

/// Returns per new number the value of the old one; an empty vector stays empty.
template <typename Value>
std::vector<Value> permuted(const std::vector<Value>& values, const std::vector<int>& order) {
  std::vector<Value> result;
  if (values.empty()) return result;
  result.reserve(order.size());
  for (const int old : order) result.push_back(values[static_cast<std::size_t>(old)]);
  return result;
}

/// Returns the mean over all tetrahedra of their largest minus their smallest vertex number. The
/// order of locality_order() makes it small.
double mean_vertex_span(const TetMesh& mesh);

}  // namespace plica
