// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <plica/core/mesh.hpp>
#include <plica/meshes/mesh_report.hpp>
#include <string>
#include <vector>

namespace plica {

/// A vertex as it is in a file, under the file's own number; `line`: where, 0 in formats without lines.
struct RawVertex {
  std::int64_t tag = 0;
  Point position = Point::Zero();
  int line = 0;
};

/// A tetrahedron as it is in a file.
struct RawTet {
  std::int64_t tag = 0;
  std::array<std::int64_t, 4> vertices = {};  ///< tags
  int region = 0;                             ///< index into region_names, when there are any
  int line = 0;
};

/// That some element uses a vertex.
struct RawMention {
  std::int64_t vertex = 0;  ///< tag
  int line = 0;
};

/// What a reader of any format gathers, before anything of it is believed.
struct RawMesh {
  std::string file;
  std::vector<RawVertex> vertices;
  std::vector<RawTet> tets;
  std::vector<std::string> region_names;                       ///< unique; empty: one nameless region
  std::map<std::string, std::vector<RawMention>> vertex_sets;  ///< in any order, repeats welcome
  std::vector<RawMention> others;                              ///< of elements that are not kept: only checked
};

/// The one way from a file to a mesh. Turns tetrahedra that are inside out, drops vertices of no tetrahedron (also from
/// the sets), and writes both and the original numbers into `report`.
///
/// InputError with file, line and the numbers in the file: no tetrahedron; a coordinate that is not finite; a vertex
/// defined twice, or not at all; a tetrahedron that names a vertex twice, repeats another, or has no volume (six times
/// the volume is at most 1e-9 of the longest edge cubed).
TetMesh sound_mesh(const RawMesh& raw, MeshReport& report);

}  // namespace plica
