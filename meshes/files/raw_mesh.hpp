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

/// A group of elements of lower dimension, as a file has it; a TetMesh keeps its vertices only.
struct ElementGroup {
  /// that of the vertex set; several groups may share it
  std::string name;
  int dimension = 0;     ///< 0: of points, 1: of lines, 2: of triangles
  std::int64_t tag = 0;  ///< its number in the file
  /// of each, in its first places, the vertices of the mesh
  std::vector<std::array<int, 3>> elements;
};

/// How a file numbers and builds the groups of a mesh, so that a conversion keeps that.
struct MeshGroups {
  std::vector<std::int64_t> region_tags;  ///< per region; empty: the file has no numbers
  std::vector<ElementGroup> sets;         ///< in the order of dimensions and tags
};

/// The same groups when vertex v has become `renumbered[v]`; elements that lose a vertex (-1) or
/// name one twice are dropped.
MeshGroups renumbered(const MeshGroups& groups, const std::vector<int>& renumbered);

/// What a reader found, repaired and left out.
struct MeshReport {
  std::string format;    ///< like "Gmsh MSH 2.2 ASCII"
  int flipped = 0;       ///< tetrahedra that were inside out
  int unreferenced = 0;  ///< vertices of no tetrahedron, dropped
  /// tetrahedra with the vertices of another one, dropped where that is allowed
  int repeated = 0;
  int collapsed = 0;  ///< tetrahedra that name a vertex twice, likewise
  /// what else the file holds: kind of element -> how many
  std::map<std::string, int> other_elements;
  std::map<std::string, int> cut;  ///< cells cut into tetrahedra, likewise
  /// elements of higher order, of which the corners were taken, likewise
  std::map<std::string, int> linearised;
  std::vector<std::string> skipped_sections;  ///< that the reader does not know
  std::vector<std::int64_t> vertex_tags;      ///< per vertex of the mesh its number in the file
  /// per tetrahedron of the mesh its number in the file
  std::vector<std::int64_t> tet_tags;
  MeshGroups groups;  ///< as the file has them
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

/// A face with any number of corners.
struct RawPolygon {
  std::int64_t tag = 0;
  std::vector<std::int64_t> corners;  ///< tags of vertices
  Place place;
};

/// Faces that are none.
struct BadFaces {
  int count = 0;
  Place place;          ///< of the first one
  std::string message;  ///< what is wrong with it

  /// One more.
  void add(const Place& where, const std::string& what);
};

/// A group of points, lines or triangles.
struct RawGroup {
  std::string name;
  int dimension = 0;
  std::int64_t tag = 0;
  std::vector<RawTriangle> elements;  ///< of which the first dimension + 1 vertices count
};

/// Vectors with a name, of vertices or of elements.
struct RawVectors {
  std::string name;
  bool of_vertices = false;
  std::vector<Point> values;
  /// of a tag's value; empty: tags are the places
  std::unordered_map<std::int64_t, std::size_t> place = {};

  /// The one of a vertex or element; zero where it has none.
  Point at(std::int64_t tag) const;
};

/// What a parser of any format gathers, before anything of it is believed.
struct RawMesh {
  std::string file;
  std::string vertex_file;  ///< when the vertices come from another one
  std::vector<RawVertex> vertices;
  std::vector<RawTet> tets;
  /// where in `tets` each cell begins that was cut, and where it ends, in turns
  std::vector<std::size_t> cut;
  std::vector<RawTriangle> triangles;     ///< of a surface; for a mesh they are only checked
  std::vector<RawPolygon> polygons;       ///< likewise
  BadFaces bad_faces;                     ///< left out
  std::vector<std::string> region_names;  ///< unique; empty: one nameless region
  std::vector<std::int64_t> region_tags;  ///< their numbers in the file
  std::vector<RawVectors> vectors;        ///< those of cells first
  std::vector<RawGroup> groups;           ///< their vertices become the vertex set of their name
  std::vector<RawMention> others;         ///< of elements that are not kept: only checked
  /// vertices of elements of higher order that are no corners
  std::vector<RawMention> middles;
};

/// Regions from a number per tetrahedron, in ascending order; numbers of the same name are one
/// region. Where all are 0 there is one nameless region.
void name_regions(RawMesh& raw, const std::vector<std::int64_t>& numbers,
                  const std::function<std::string(std::int64_t)>& name_of);

/// From the numbers of vertices in a file to their positions in raw.vertices.
class VertexNumbers {
 public:
  /// InputError for a vertex that is defined twice or not finite.
  explicit VertexNumbers(const RawMesh& raw);

  /// InputError "WHO names node TAG, ..." for a number that the file does not define.
  int at(std::int64_t tag, const Place& place, const std::function<std::string()>& who) const;
  /// -1 for a number that the file does not define.
  int find(std::int64_t tag) const;

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
  int corners;   ///< its first vertices; 0: all of them; not_taken
};
inline constexpr int not_taken = -1;

/// The kind with a number if we take it; else an InputError "WHO has type TYPE, a NAME; supported
/// are ...".
const ElementKind& taken_kind(std::span<const ElementKind> kinds, std::int64_t type,
                              const std::function<std::string()>& who, const std::string& file,
                              const Place& place);

/// Adds a face, as a triangle or a polygon.
void add_face(std::int64_t tag, std::span<const std::int64_t> corners, const Place& place,
              RawMesh& raw);

/// Adds an element of any kind: a tetrahedron as it is, other cells cut into tetrahedra, faces as
/// triangles or polygons; what is of lower dimension is only checked. Elements of higher order are
/// taken by their corners.
///
/// A cell is cut from its vertex with the lowest number, and each quadrangle across from it from
/// the lowest of its own: two cells that share a quadrangle cut it alike, whatever they are.
/// @return how many tetrahedra
std::size_t add_element(const ElementKind& kind, std::int64_t tag,
                        std::span<const std::int64_t> vertices, const Place& place, RawMesh& raw,
                        MeshReport& report);

/// Adds an element of lower dimension to a group; a quadrangle as two triangles, cut as a cell's.
void add_to_group(const ElementKind& kind, std::int64_t tag, std::span<const std::int64_t> vertices,
                  const Place& place, RawGroup& group);

}  // namespace plica
