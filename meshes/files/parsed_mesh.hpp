// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <plica/core/mesh.hpp>
#include <plica/meshes/files/file_bytes.hpp>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace plica {

/// Group of points, lines or triangles in a file. A TetMesh keeps only its vertices, as a set.
struct ElementGroup {
  /// name of the vertex set; several groups may share it
  std::string name;
  int dimension = 0;     ///< 0: points, 1: lines, 2: triangles
  std::int64_t tag = 0;  ///< number of the group in the file
  /// vertices of each element in the mesh; the first dimension + 1 are used
  std::vector<std::array<int, 3>> elements;
};

/// Groups of a mesh as a file numbers and builds them, kept for a conversion to another format.
struct MeshGroups {
  std::vector<std::int64_t> region_tags;  ///< per region; empty: the file has no numbers
  std::vector<ElementGroup> sets;         ///< in the order of dimensions and tags
};

/// Returns the groups with vertex v replaced by `renumbered[v]`. Elements that lose a vertex (-1)
/// or then name one twice are dropped.
MeshGroups renumbered(const MeshGroups& groups, const std::vector<int>& renumbered);

/// Report of a mesh reader: what it found, repaired and left out.
struct MeshReport {
  std::string format;    ///< like "Gmsh MSH 2.2 ASCII"
  int flipped = 0;       ///< tetrahedra that were inside out, turned
  int unreferenced = 0;  ///< vertices of no tetrahedron, dropped
  /// tetrahedra with the vertices of another one, dropped where Flaws::kept allows it
  int repeated = 0;
  /// tetrahedra that name a vertex twice, dropped where Flaws::kept allows it
  int collapsed = 0;
  /// other elements of the file: kind of element -> how many
  std::map<std::string, int> other_elements;
  std::map<std::string, int> cut;  ///< cells cut into tetrahedra: kind of cell -> how many
  /// elements of higher order, of which only the corners were used: kind -> how many
  std::map<std::string, int> linearised;
  int split = 0;  ///< second-order tetrahedra that were split in eight by the nodes on their edges
  std::map<std::string, int> left_out;        ///< regions left out: name -> tetrahedra
  std::vector<std::string> notes;             ///< choices of the reader that the user should know
  std::vector<std::string> skipped_sections;  ///< sections that the reader does not know
  std::vector<std::int64_t> vertex_tags;      ///< per vertex of the mesh its number in the file
  /// per tetrahedron of the mesh its number in the file
  std::vector<std::int64_t> tet_tags;
  MeshGroups groups;  ///< groups with the file's numbers
};

/// Vertex as a file has it, with the file's number.
struct RawVertex {
  std::int64_t tag = 0;
  Point position = Point::Zero();
  Place place;
};

/// Element as a file has it, with the file's numbers.
template <std::size_t corners>
struct RawElement {
  std::int64_t tag = 0;
  std::array<std::int64_t, corners> vertices = {};  ///< tags of vertices
  int region = 0;                                   ///< index in region_names, if there are any
  Place place;
};
using RawTet = RawElement<4>;
using RawTriangle = RawElement<3>;

/// Use of a vertex by some element.
struct RawMention {
  std::int64_t vertex = 0;  ///< tag of the vertex
  Place place;
};

/// Face with any number of corners.
struct RawPolygon {
  std::int64_t tag = 0;
  std::vector<std::int64_t> corners;  ///< tags of vertices
  Place place;
  std::vector<int> texture = {};  ///< per corner as in ParsedMesh::triangle_texture; empty: none
};

/// Invalid faces of a surface.
struct BadFaces {
  int count = 0;
  Place place;          ///< place of the first one
  std::string message;  ///< error of the first one

  /// Counts one more, and keeps the place and message of the first one.
  void add(const Place& where, const std::string& what);
};

/// Group of points, lines or triangles as a file has it.
struct RawGroup {
  std::string name;
  int dimension = 0;
  std::int64_t tag = 0;
  std::vector<RawTriangle> elements;  ///< the first dimension + 1 vertices of each are used
};

/// Named vectors, one per vertex or per element.
struct RawVectors {
  std::string name;
  bool of_vertices = false;
  std::vector<Point> values;
  /// index in `values` of each tag; empty: the tag is the index
  std::unordered_map<std::int64_t, std::size_t> place = {};

  /// Returns the vector of a vertex or element; zero where it has none.
  Point at(std::int64_t tag) const;
};

/// Name of the numbers in a file that are TetMesh::filled.
inline constexpr const char* filled_name = "plica:filled";

/// Numbers of the tetrahedra that may tell their regions.
struct RawNumbers {
  std::string name;                  ///< name of the array in the file, or of the format's own kind
  std::vector<std::int64_t> values;  ///< one per tetrahedron; only used where `wrong` is empty
  /// name of the region with a number
  std::function<std::string(std::int64_t)> name_of;
  bool own = false;   ///< true: the format has them for regions
  std::string wrong;  ///< first value that is no integer; empty: all are integers
  Place place = {};   ///< place of that value

  /// Adds a value, which may be a real number that is an integer, such as 2.0.
  void add(double value, const Place& where);
};

/// Unchecked content of a mesh file, as the parser of any format returns it.
struct ParsedMesh {
  std::string file;
  std::string vertex_file;  ///< file of the vertices, if it is another one
  std::vector<RawVertex> vertices;
  std::vector<RawTet> tets;
  /// begin and end of the tetrahedra of each cell that was cut: indices in `tets`, in turns
  std::vector<std::size_t> cut;
  std::vector<RawTriangle> triangles;          ///< triangles of a surface; only checked for a mesh
  std::vector<RawPolygon> polygons;            ///< polygons of a surface; only checked for a mesh
  BadFaces bad_faces;                          ///< invalid faces, left out
  std::vector<std::array<double, 2>> texture;  ///< texture coordinates u, v; empty: none
  /// per triangle the index in `texture` of each corner, -1 for a corner without; empty: none
  std::vector<std::array<int, 3>> triangle_texture;
  std::vector<std::string> region_names;  ///< unique; empty: one nameless region
  std::vector<std::int64_t> region_tags;  ///< numbers of the regions in the file
  std::vector<RawNumbers> numbers;        ///< numbers of which choose_regions() takes one
  /// per second-order tetrahedron its index in `tets` and the nodes on its edges, in any order
  std::vector<std::pair<std::size_t, std::array<std::int64_t, 6>>> second_order;
  std::vector<RawVectors> vectors;  ///< named vectors: those of cells before those of points
  RawVectors filled;                ///< part of each cell that is body, in x; empty: all of each
  std::vector<RawGroup> groups;     ///< groups whose vertices become the set of their name
  std::vector<RawMention> others;   ///< vertices of points and lines: only checked
  /// vertices of elements of higher order that are no corners
  std::vector<RawMention> middles;
};

/// Map from the numbers of vertices in a file to their indices in raw.vertices.
class VertexNumbers {
 public:
  /// Builds the map; throws an InputError for a vertex that is defined twice or not finite.
  explicit VertexNumbers(const ParsedMesh& raw);

  /// Returns the index of a vertex. Throws an InputError "WHO names node TAG, ..." for a number
  /// that the file does not define.
  int at(std::int64_t tag, const Place& place, const std::function<std::string()>& who) const;
  /// Returns the index of a vertex; -1 for a number that the file does not define.
  int find(std::int64_t tag) const;

 private:
  const ParsedMesh& raw_;
  std::unordered_map<std::int64_t, int> index_;
};

/// Kind of element of a format.
struct ElementKind {
  int type;  ///< number of the kind in the format
  const char* name;
  int dimension;
  int vertices;  ///< number of vertices; 0: any number
  int corners;   ///< number of corners, which come first; 0: all vertices; not_taken
};
inline constexpr int not_taken = -1;  ///< ElementKind::corners of a kind that is not supported

/// Returns the kind with a number. Throws an InputError "WHO has type TYPE, a NAME; supported are
/// ..." if the kind is not supported.
const ElementKind& taken_kind(std::span<const ElementKind> kinds, std::int64_t type,
                              const std::function<std::string()>& who, const std::string& file,
                              const Place& place);

/// Adds a face, as a triangle or a polygon.
void add_face(std::int64_t tag, std::span<const std::int64_t> corners, const Place& place,
              ParsedMesh& raw);

/// Adds an element of any kind. Cells become tetrahedra, faces become triangles or polygons; points
/// and lines are only checked. Elements of higher order are reduced to their corners; the nodes on
/// the edges of second-order tetrahedra are kept for split_second_order().
///
/// A cell is cut from its vertex with the lowest number. Each quadrangle across from this vertex is
/// cut from its own lowest vertex. Two cells of any kind that share a quadrangle thus cut it in one
/// way.
/// @return the number of tetrahedra that were added
std::size_t add_element(const ElementKind& kind, std::int64_t tag,
                        std::span<const std::int64_t> vertices, const Place& place, ParsedMesh& raw,
                        MeshReport& report);

/// Adds a point, line or face to a group. A quadrangle becomes two triangles, cut from its vertex
/// with the lowest number as add_element() cuts the faces of cells.
void add_to_group(const ElementKind& kind, std::int64_t tag, std::span<const std::int64_t> vertices,
                  const Place& place, RawGroup& group);

}  // namespace plica
