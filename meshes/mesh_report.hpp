// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace plica {

/// What a reader found, mended and left out.
struct MeshReport {
  std::string format;                         ///< like "Gmsh MSH 2.2 ASCII"
  int flipped = 0;                            ///< tetrahedra that were inside out
  int unreferenced = 0;                       ///< vertices of no tetrahedron, dropped
  std::map<std::string, int> other_elements;  ///< what else the file holds: kind of element -> how many
  std::vector<std::string> skipped_sections;  ///< that the reader does not know
  std::vector<std::int64_t> vertex_tags;      ///< per vertex of the mesh its number in the file
  std::vector<std::int64_t> tet_tags;         ///< per tetrahedron of the mesh its number in the file
};

}  // namespace plica
