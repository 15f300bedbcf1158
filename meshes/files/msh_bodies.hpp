// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <map>
#include <plica/meshes/files/parsed_mesh.hpp>
#include <plica/meshes/files/reading.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace plica {

/// Kinds of elements of the MSH formats (Gmsh reference manual, "MSH file format").
inline constexpr ElementKind msh_elements[] = {
    {15, "point", 0, 1, 1},
    {1, "line", 1, 2, 2},
    {2, "triangle", 2, 3, 3},
    {3, "quadrangle", 2, 4, 4},
    {4, "tetrahedron", 3, 4, 4},
    {5, "hexahedron", 3, 8, 8},
    {6, "prism", 3, 6, 6},
    {7, "pyramid", 3, 5, 5},
    {8, "second-order line", 1, 3, 2},
    {9, "second-order triangle", 2, 6, 3},
    {10, "second-order quadrangle", 2, 9, 4},
    {11, "second-order tetrahedron", 3, 10, 4},
    {12, "second-order hexahedron", 3, 27, 8},
    {13, "second-order prism", 3, 18, 6},
    {14, "second-order pyramid", 3, 14, 5},
    {16, "second-order quadrangle", 2, 8, 4},
    {17, "second-order hexahedron", 3, 20, 8},
    {18, "second-order prism", 3, 15, 6},
    {19, "second-order pyramid", 3, 13, 5},
    {20, "third-order triangle", 2, 9, 3},
    {21, "third-order triangle", 2, 10, 3},
    {26, "third-order line", 1, 4, 2},
    {29, "third-order tetrahedron", 3, 20, 4},
    {30, "fourth-order tetrahedron", 3, 35, 4},
    {92, "third-order hexahedron", 3, 64, 8},
};

/// Builder of a ParsedMesh from the parts that all MSH formats have: nodes, elements, and groups of
/// elements that may have a name.
class MshGather {
 public:
  MshGather(std::string file, MeshReport& report) : report_(report) { raw_.file = std::move(file); }

  /// Adds the name of a group from a line of $PhysicalNames.
  void add_name(const TextLines& lines);
  /// Adds a node; reads its three coordinates from `numbers`.
  void add_node(std::int64_t tag, Numbers& numbers, const Place& place);
  /// Adds an element; reads its nodes from `numbers`.
  /// @param groups  physical groups (0: none); a volume uses the first one only
  void add_element(const ElementKind& kind, std::int64_t tag, std::span<const std::int64_t> groups,
                   NumberType node_type, Numbers& numbers, const Place& place);
  /// Adds vectors of nodes or elements; reads `count` times tag, x, y, z from `numbers`.
  void add_vectors(const std::string& name, bool of_nodes, std::int64_t count, Numbers& numbers);
  /// Adds the parts of elements that are body; reads `count` times tag and part from `numbers`.
  void add_filled(std::int64_t count, Numbers& numbers);
  /// Returns the mesh and empties this; call it once.
  ParsedMesh take();

 private:
  using Group = std::pair<int, std::int64_t>;  // dimension, physical tag
  static std::string name_of(const Group& group, const std::map<Group, std::string>& names);

  ParsedMesh raw_;
  MeshReport& report_;
  std::map<Group, std::string> names_;
  std::map<std::string, Group> regions_;  // names of volumes, which are unique
  std::vector<std::int64_t> nodes_;       // nodes of the element that is being read
  std::vector<std::int64_t> tet_groups_;  // per tetrahedron its physical tag
  std::map<Group, RawGroup> groups_;      // groups of points, lines and faces
};

/// Returns the kind of element of a type. Throws an InputError if it is not supported.
/// @param who  names the element or block with that type
const ElementKind& taken_element(std::int64_t type, const std::function<std::string()>& who,
                                 const Numbers& numbers);

/// Reads the tag of a node or element, which is 1 or more.
std::int64_t msh_tag(NumberType type, std::string_view what, Numbers& numbers);

/// Reads the tag of a physical group, and returns it without its sign. A minus sign means that the
/// element has the opposite orientation of the group.
std::int64_t physical_tag(Numbers& numbers);

/// Reads the nodes of MSH 1 and 2, from text or binary: `count` times tag, x, y, z.
void msh2_nodes(std::int64_t count, Numbers& numbers, MshGather& gather);
/// Reads the elements of MSH 1: each has its type, physical and elementary group, and number of
/// nodes.
void msh1_elements(std::int64_t count, Numbers& numbers, MshGather& gather);
/// Reads the elements of MSH 2. In text each has its type and number of tags; in binary they are in
/// blocks of one type.
void msh2_elements(std::int64_t count, bool binary, Numbers& numbers, MshGather& gather);

/// Reader of the sections of MSH 4.1, text or binary. Entities are parts of the geometry, or of one
/// partition of it. A block of elements belongs to one entity, and so to its physical groups.
class Msh4Bodies {
 public:
  /// Reads $Entities.
  void entities(Numbers& numbers) { read_entities(false, numbers); }
  /// Reads $PartitionedEntities.
  void partitioned_entities(Numbers& numbers);
  /// Reads $Nodes; returns their number, as "5 nodes".
  std::string nodes(Numbers& numbers, MshGather& gather) const;
  /// Reads $Elements; returns their number, as "5 elements".
  std::string elements(Numbers& numbers, MshGather& gather) const;

 private:
  using Entity = std::pair<std::int64_t, std::int64_t>;  // dimension, tag
  void read_entities(bool partitioned, Numbers& numbers);
  void read_entity(std::int64_t dimension, bool partitioned, Numbers& numbers,
                   std::map<Entity, std::size_t>& here);
  const std::vector<std::int64_t>& groups_of(const Entity& entity, const Numbers& numbers) const;

  bool known_ = false;
  std::map<Entity, std::vector<std::int64_t>> groups_;
};

}  // namespace plica
