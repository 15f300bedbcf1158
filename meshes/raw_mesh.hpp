// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <plica/core/mesh.hpp>
#include <plica/meshes/memory_file.hpp>
#include <string>
#include <vector>

namespace plica {

/// A vertex as it is in a file, under the file's own number.
struct RawVertex {
  std::int64_t tag = 0;
  Point position = Point::Zero();
  Place place;
};

/// An element as it is in a file.
template <std::size_t corners>
struct RawElement {
  std::int64_t tag = 0;
  std::array<std::int64_t, corners> vertices = {};  ///< tags
  int region = 0;                                   ///< index into region_names, when there are any
  Place place;
};
using RawTet = RawElement<4>;
using RawTriangle = RawElement<3>;

/// That some element uses a vertex.
struct RawMention {
  std::int64_t vertex = 0;  ///< tag
  Place place;
};

/// What a parser of any format gathers, before anything of it is believed.
struct RawMesh {
  std::string file;
  std::string vertex_file;  ///< when the vertices come from another one
  std::vector<RawVertex> vertices;
  std::vector<RawTet> tets;
  std::vector<RawTriangle> triangles;                          ///< of a surface; for a mesh they are only checked
  std::vector<std::string> region_names;                       ///< unique; empty: one nameless region
  std::map<std::string, std::vector<RawMention>> vertex_sets;  ///< in any order, repeats welcome
  std::vector<RawMention> others;                              ///< of elements that are not kept: only checked
};

/// Regions from a number per tetrahedron, in ascending order; numbers of the same name are one region. Where all are 0
/// there is one nameless region.
void name_regions(RawMesh& raw, const std::vector<std::int64_t>& numbers,
                  const std::function<std::string(std::int64_t)>& name_of);

}  // namespace plica
