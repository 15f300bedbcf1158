// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <optional>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

/// Composite meshes: a finer mesh where there is one, a coarser one elsewhere. The finer one's
/// vertices at the border follow the coarser tetrahedra that they lie in. This is the composite
/// grid of S. F. McCormick, Multilevel Adaptive Methods for Partial Differential Equations (1989).
namespace plica {

/// Mesh of a part of the body.
struct PartMesh {
  TetMesh mesh;  ///< tetrahedra of the part
  /// Boundary triangles that are the body's skin, in any orientation; the others are the border.
  /// None: compose() tells them apart
  std::optional<std::vector<std::array<int, 3>>> skin = {};
};

/// Returns some tetrahedra of a mesh as a mesh of their own, with what the mesh says of them.
/// Vertices and tetrahedra keep their order.
/// @param of    mesh without pieces
/// @param tets  numbers of tetrahedra, ascending, at least one
PartMesh cut_out(const PartMesh& of, const std::vector<int>& tets);
/// Returns the mesh of a whole body, whose boundary is skin.
PartMesh whole_mesh(const TetMesh& mesh);
/// Returns a part with each tetrahedron cut in eight, see refined(). Its border's vertices then lie
/// on edges of the mesh that the part was cut out of, at their ends and middles.
PartMesh refined(const PartMesh& part);

/// A composite mesh, and what became of the two meshes that it was made of.
struct Composite {
  TetMesh mesh;               ///< vertices and tetrahedra of the part come first
  int cut = 0;                ///< coarser tetrahedra that count in part
  int dropped = 0;            ///< coarser tetrahedra that are left out
  double covered_volume = 0;  ///< volume that the part takes from the coarser mesh [m^3]
  /// Doubts, a sentence each, which begins with "the part"
  std::vector<std::string> doubts = {};
};

/// Completes a part to a mesh of the whole body. Of each coarser tetrahedron the part that the
/// finer ones cover is left out: TetMesh::filled is 1 - o, where o is the volume in common over its
/// own, exact to rounding. Gradients are constant in a tetrahedron, so that this weight is exact.
/// Where the rest of a coarser tetrahedron hangs over the part's skin, it counts as covered, too.
///
/// Boundary triangles of the part are skin where the coarser skin is within 0.15 of its edges and
/// parallel (cosine above 0.8), unless `part.skin` or `border` say which are. The vertices of the
/// others follow the coarser tetrahedron that they lie in. Coarser tetrahedra below 0.02 are
/// dropped, unless a border vertex lies in them alone: these stay at 0.02. Coarser vertices without
/// a tetrahedron are dropped.
///
/// Regions, vertex sets, triangle sets and vectors are joined by name. A mesh without regions has
/// one without name. The composite mesh is reproducible: it depends on the two meshes alone.
///
/// @param part     mesh of one piece
/// @param coarser  mesh of the whole body; may be a composite itself
/// @param border   set of vertices or triangles of the part that is its border; empty: found
/// @throw InputError "the part ...", with numbers: it covers nothing, has no border, sticks out by
/// more than an edge, its border is within an edge of the next one, or the volume changes by more
/// than a tenth of the part's
Composite compose(const PartMesh& part, const TetMesh& coarser, const std::string& border = {});

/// Gives what followers have to their masters, by weight: values_k += w values_s, values_s = 0.
/// Sums and, of forces, moments stay.
template <class Value>
void give_to_masters(const Followers& followers, std::vector<Value>& values) {
  for (std::size_t i = 0; i < followers.vertex.size(); ++i) {
    Value& own = values[static_cast<std::size_t>(followers.vertex[i])];
    for (std::size_t k = 0; k < 4; ++k)
      values[static_cast<std::size_t>(followers.of[i][k])] += followers.weight[i][k] * own;
    own = 0.0 * own;
  }
}

/// Gives followers the weighted mean of their masters: values_s = sum_k w_k values_k.
template <class Value>
void follow_masters(const Followers& followers, std::vector<Value>& values) {
  for (std::size_t i = 0; i < followers.vertex.size(); ++i) {
    Value mean = 0.0 * values[static_cast<std::size_t>(followers.vertex[i])];
    for (std::size_t k = 0; k < 4; ++k)
      mean += followers.weight[i][k] * values[static_cast<std::size_t>(followers.of[i][k])];
    values[static_cast<std::size_t>(followers.vertex[i])] = mean;
  }
}

/// Returns triangles with ascending vertices, ascending themselves: their orientation is lost.
std::vector<std::array<int, 3>> sorted_triangles(std::vector<std::array<int, 3>> triangles);

/// Returns per vertex whether it follows others; empty: none does.
std::vector<char> follows_others(const TetMesh& mesh);

}  // namespace plica
