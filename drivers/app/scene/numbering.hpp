// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/reordering.hpp>
#include <vector>

namespace plica::app {

/// How a level's mesh is numbered where it comes from. What is read from a file is put in an order that is faster to
/// simulate; whatever people see has the file's order and numbers.
struct Numbering {
  Reordering input;             ///< per place in the input its number here; empty: the same
  std::vector<int> vertex_ids;  ///< per vertex here its number in the file; empty: the same, from 0
  std::vector<int> tet_ids;     ///< per tetrahedron, likewise
};

/// The number in the input of vertex or tetrahedron `index`; -1 stays -1.
inline int input_number(const std::vector<int>& ids, int index) {
  return index < 0 || ids.empty() ? index : ids[static_cast<std::size_t>(index)];
}

/// Values per vertex or tetrahedron in the order of the input.
template <class Value>
std::vector<Value> in_input_order(const std::vector<Value>& values, const std::vector<int>& order) {
  return order.empty() ? values : permuted(values, order);
}

/// The mesh as the input has it.
inline TetMesh in_input_order(const TetMesh& mesh, const Numbering& numbering) {
  return numbering.input.vertices.empty() ? mesh : reordered(mesh, numbering.input);
}

}  // namespace plica::app
