// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <map>
#include <plica/meshes/mesh_report.hpp>
#include <plica/meshes/msh/msh_elements.hpp>
#include <plica/meshes/numbers.hpp>
#include <plica/meshes/raw_mesh.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace plica {

/// What the MSH formats have in common: nodes, elements, and groups of elements that may have a name.
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
  /// All of it; to be called once.
  RawMesh take();

 private:
  using Group = std::pair<int, std::int64_t>;  // dimension, physical tag
  std::string name_of(const Group& group) const;

  RawMesh raw_;
  MeshReport& report_;
  std::map<Group, std::string> names_;
  std::map<std::string, Group> regions_;             // names of volumes, which are unique
  std::vector<std::int64_t> tet_groups_;             // per tetrahedron its physical tag
  std::map<Group, std::vector<RawMention>> groups_;  // of lower dimension
};

/// A kind of element that we take, else an InputError; `who` has that type.
const ElementKind& taken_element(std::int64_t type, const std::function<std::string()>& who, const Numbers& numbers);

/// A tag of a node or element: 1 or more.
std::int64_t msh_tag(NumberType type, std::string_view what, Numbers& numbers);

/// The tag of a physical group. A minus sign says that the element is turned round against the group, and is left out.
std::int64_t physical_tag(Numbers& numbers);

}  // namespace plica
