// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <map>
#include <plica/meshes/files/raw_mesh.hpp>
#include <plica/meshes/files/reading.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace plica {

/// Of the MSH formats (Gmsh reference manual, "MSH file format").
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

/// What the MSH formats have in common: nodes, elements, and groups of elements that may have a
/// name.
class MshGather {
 public:
  MshGather(std::string file, MeshReport& report) : report_(report) { raw_.file = std::move(file); }

  /// A line of $PhysicalNames.
  void add_name(const TextLines& lines);
  /// A node: three coordinates follow.
  void add_node(std::int64_t tag, Numbers& numbers, const Place& place);
  /// An element of some physical groups, a tetrahedron of one at most (0: none): its nodes follow.
  void add_element(const ElementKind& kind, std::int64_t tag, std::span<const std::int64_t> groups,
                   NumberType node_type, Numbers& numbers, const Place& place);
  /// Vectors of nodes or elements: `count` times tag, x, y, z follow.
  void add_vectors(const std::string& name, bool of_nodes, std::int64_t count, Numbers& numbers);
  /// All of it; to be called once.
  RawMesh take();

 private:
  using Group = std::pair<int, std::int64_t>;  // dimension, physical tag
  std::string name_of(const Group& group) const;

  RawMesh raw_;
  MeshReport& report_;
  std::map<Group, std::string> names_;
  std::map<std::string, Group> regions_;  // names of volumes, which are unique
  std::vector<std::int64_t> nodes_;       // of an element
  std::vector<std::int64_t> tet_groups_;  // per tetrahedron its physical tag
  std::map<Group, RawGroup> groups_;      // of lower dimension
};

/// A kind of element that we take, else an InputError; `who` has that type.
const ElementKind& taken_element(std::int64_t type, const std::function<std::string()>& who,
                                 const Numbers& numbers);

/// A tag of a node or element: 1 or more.
std::int64_t msh_tag(NumberType type, std::string_view what, Numbers& numbers);

/// The tag of a physical group. A minus sign says that the element is turned round against the
/// group, and is left out.
std::int64_t physical_tag(Numbers& numbers);

/// The nodes of MSH 1 and 2, the same in text and in binary: `count` times tag, x, y, z.
void msh2_nodes(std::int64_t count, Numbers& numbers, MshGather& gather);
/// The elements of MSH 1: each with its type, physical and elementary group, and number of nodes.
void msh1_elements(std::int64_t count, Numbers& numbers, MshGather& gather);
/// The elements of MSH 2: in text each with its type and number of tags, in binary in blocks of one
/// type.
void msh2_elements(std::int64_t count, bool binary, Numbers& numbers, MshGather& gather);

/// The sections of MSH 4.1, the same in text and in binary. Entities are parts of the geometry, or
/// of one partition of it; blocks of elements lie in one entity, and so in its physical groups.
class Msh4Bodies {
 public:
  void entities(Numbers& numbers) { read_entities(false, numbers); }
  void partitioned_entities(Numbers& numbers);
  /// Returns how many, as "5 nodes"
  std::string nodes(Numbers& numbers, MshGather& gather) const;
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
