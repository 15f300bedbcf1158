// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace plica {

/// A group of elements of lower dimension, as a file has it; a TetMesh keeps its vertices only.
struct ElementGroup {
  std::string name;                          ///< that of the vertex set; several groups may share it
  int dimension = 0;                         ///< 0: of points, 1: of lines, 2: of triangles
  std::int64_t tag = 0;                      ///< its number in the file
  std::vector<std::array<int, 3>> elements;  ///< of each, in its first places, the vertices of the mesh
};

/// How a file numbers and builds the groups of a mesh, so that a conversion keeps that.
struct MeshGroups {
  std::vector<std::int64_t> region_tags;  ///< per region; empty: the file has no numbers
  std::vector<ElementGroup> sets;         ///< in the order of dimensions and tags
};

/// The same groups when vertex v has become `renumbered[v]`; elements that lose a vertex (-1) or name one twice are dropped.
MeshGroups renumbered(const MeshGroups& groups, const std::vector<int>& renumbered);

}  // namespace plica
