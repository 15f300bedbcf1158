// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/files/parsed_mesh.hpp>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace plica {

/// Element of an input deck.
struct DeckElement {
  const ElementKind* kind = nullptr;
  std::int64_t tag = 0;
  std::vector<std::int64_t> nodes;  ///< tags of nodes
  Place place;
};

/// Kind of element and the name that a program gives it.
struct NamedKind {
  std::string_view name;
  ElementKind kind;
};

/// Gathers the mesh of an input deck of a finite-element program: nodes, elements, and named sets
/// of both, in any order. The parsers of all such formats use it.
///
/// Sets of cells become regions. The sets that have a material come first; where they make one
/// region only, the other sets do. A set of all cells is no region where there are smaller ones,
/// and no set is that shares a cell with one before it: a note names these. Cells of no set are the
/// region "unassigned". Sets of nodes, faces and lines become vertex sets.
class DeckGather {
 public:
  DeckGather(const std::string& file, MeshReport& report) : report_(report) { raw_.file = file; }

  /// Adds a node.
  void add_node(std::int64_t tag, const Point& position, const Place& place);
  /// Adds an element; returns its index. Throws an InputError for a number that is taken.
  std::size_t add_element(DeckElement element);
  /// Adds a set of elements by their indices, ascending.
  /// @param has_material  true for the parts that the deck gives a material
  void add_elements(const std::string& set, std::vector<std::size_t> elements, bool has_material);
  /// Adds nodes to a vertex set. Throws an InputError for a node that is not defined: call it last.
  void add_nodes(const std::string& set, const std::vector<std::int64_t>& nodes,
                 const Place& place);
  /// Adds a face, or a line of two corners, to a vertex set.
  void add_face(const std::string& set, std::span<const std::int64_t> corners, const Place& place);

  const std::vector<DeckElement>& elements() const { return elements_; }
  const std::vector<RawVertex>& nodes() const { return raw_.vertices; }
  /// Returns the index of an element; throws an InputError "WHO names element TAG, ..." for a
  /// number that is not defined.
  std::size_t element(std::int64_t tag, const std::string& who, const Place& place) const;

  /// Returns the mesh, after all was added.
  ParsedMesh take();

 private:
  struct Set {
    std::string name;
    std::vector<std::size_t> elements;
    bool has_material;
  };
  bool is_cell(std::size_t element) const { return elements_[element].kind->dimension == 3; }
  RawGroup& group(const std::string& name, int dimension);
  std::vector<const Set*> regions(bool with_material, std::size_t cells,
                                  std::vector<std::int64_t>& region_of, std::string& unused) const;
  void choose_sets(ParsedMesh& raw);

  ParsedMesh raw_;
  MeshReport& report_;
  std::vector<DeckElement> elements_;
  std::unordered_map<std::int64_t, std::size_t> index_;
  std::unordered_set<std::int64_t> defined_;  // tags of nodes
  std::vector<Set> sets_;
};

}  // namespace plica
