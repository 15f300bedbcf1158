// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// An order of vertices and tetrahedra: per new number the old one.
struct Reordering {
  std::vector<int> vertices;  ///< old numbers
  std::vector<int> tets;      ///< old numbers
};

/// Neighbours in space become neighbours in memory: tetrahedra along a Hilbert curve through their
/// centroids, vertices as these first use them. The same for the same mesh on every machine.
Reordering locality_order(const TetMesh& mesh);

/// The way back: per old number the new one.
Reordering inverse(const Reordering& order);

/// The mesh in another order; what was numbered per vertex or tetrahedron goes along by permuted().
TetMesh reordered(const TetMesh& mesh, const Reordering& order);

/// Per new number the value of the old one; nothing stays nothing.
template <typename Value>
std::vector<Value> permuted(const std::vector<Value>& values, const std::vector<int>& order) {
  std::vector<Value> result;
  if (values.empty()) return result;
  result.reserve(order.size());
  for (const int old : order) result.push_back(values[static_cast<std::size_t>(old)]);
  return result;
}

/// The mean over all tetrahedra of the difference of their largest and smallest vertex number: what
/// locality_order() makes small.
double mean_vertex_span(const TetMesh& mesh);

}  // namespace plica
