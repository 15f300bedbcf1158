// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <plica/core/mesh.hpp>
#include <plica/meshes/files/memory_file.hpp>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace plica {

/// What a reader found, repaired and left out.
struct MeshReport {
  std::string format;                         ///< like "Gmsh MSH 2.2 ASCII"
  int flipped = 0;                            ///< tetrahedra that were inside out
  int unreferenced = 0;                       ///< vertices of no tetrahedron, dropped
  std::map<std::string, int> other_elements;  ///< what else the file holds: kind of element -> how many
  std::vector<std::string> skipped_sections;  ///< that the reader does not know
  std::vector<std::int64_t> vertex_tags;      ///< per vertex of the mesh its number in the file
  std::vector<std::int64_t> tet_tags;         ///< per tetrahedron of the mesh its number in the file
};

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

/// From the numbers of vertices in a file to their positions in raw.vertices.
class VertexNumbers {
 public:
  /// InputError for a vertex that is defined twice or not finite.
  explicit VertexNumbers(const RawMesh& raw);

  /// InputError "WHO names node TAG, ..." for a number that the file does not define.
  int at(std::int64_t tag, const Place& place, const std::function<std::string()>& who) const;

 private:
  const RawMesh& raw_;
  std::unordered_map<std::int64_t, int> index_;
};

/// A kind of element as a format numbers it.
struct ElementKind {
  int type;
  const char* name;
  int dimension;
  int vertices;  ///< 0: any number
  bool taken;    ///< first order, and a tetrahedron or of lower dimension
};

/// The kind with a number if we take it; else an InputError "WHO has type TYPE, a NAME; supported are ...".
const ElementKind& taken_kind(std::span<const ElementKind> kinds, std::int64_t type,
                              const std::function<std::string()>& who, const std::string& file, const Place& place);

}  // namespace plica
