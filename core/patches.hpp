// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <plica/core/backend.hpp>

namespace plica {

/// Rows in which an element kernel leaves what it adds to a vertex, one for each patch or region.
/// They are added up in this order. Vertex a: rows [first(a), first(a+1)) of `row`.
template <class B>
struct VertexShares {
  /// Number of rows that the kernel writes; those of no vertex are 0
  int rows = 0;
  Indices<B> first;  ///< [vertices + 1]
  Indices<B> row;
  /// [places in `row`] part of a row that the vertex takes. Where vertices follow others, their
  /// rows are also among those of their masters, see FollowingVertices. Empty: 1 everywhere
  Scalars<B> weight = {};
};

/// The tetrahedra of one mesh, cut into patches of neighbours. Patches are small enough that their
/// vertices and element forces stay in the nearest memory (first-level cache, a GPU's shared
/// memory). Only sums per patch vertex leave it. These are added up in a fixed order, which gives
/// the same bits for any number of threads.
///
/// * patch p: packs [first_pack(p), first_pack(p+1)) of `lanes` elements each, the last one padded
///   with volume 0;
///   vertices [first_vertex(p), first_vertex(p+1)) of `vertex`: the mesh vertices that it touches
/// * pack q: corner(q, c, l) is the number in the patch of the vertex at corner c of element l;
///   shape(q, 0..8, l) is the inverse of the edge matrix with columns X1-X0, X2-X0, X3-X0, row by
///   row [1/m]; shape(q, 9, l) is the volume [m^3]
/// * patch p: sums [first_sum(p), first_sum(p+1)), each for `at_once` vertices of the patch. Number
///   j of sum i is for vertex summed(first_vertex(p) + (i - first_sum(p)) at_once + j)
/// * sum i: terms are slots [first_slot(i), first_slot(i+1)) of `slot`, `at_once` side by side, one
///   for each of the vertices. A vertex of fewer elements than the others takes `nothing` at the
///   end. Vertices are sorted by the number of their elements, so that this is seldom, and that a
///   processor foresees where a sum ends
/// * the shares of a mesh vertex: its patch vertices
template <class B>
struct Patches {
  using Real = typename B::Real;
  using Memory = typename B::Memory;
  static constexpr int lanes = B::lanes;
  static constexpr int capacity = 256;  ///< maximum number of elements of a patch
  /// Maximum number of vertices of a patch: 31 kB with two fields in double
  static constexpr int vertex_capacity = 120;
  /// Number of vertices whose sums one thread forms together
  static constexpr int at_once = B::for_cpu ? 4 : 1;
  /// Offset behind all element forces, where zeros stand
  static constexpr int nothing = (capacity + lanes - 1) / lanes * lanes * 4 * 3;
  template <class T>
  using Array = Kokkos::View<T, Kokkos::LayoutRight, Memory>;

  int count = 0;
  int vertices = 0;  ///< number of vertices of the mesh
  int packs = 0;
  Indices<B> first_pack;    ///< [count + 1]
  Indices<B> first_vertex;  ///< [count + 1]
  Indices<B> vertex;        ///< [patch vertices] mesh vertices, ascending in a patch
  Array<std::uint16_t* [4][lanes]> corner;
  Array<Real* [10][lanes]> shape;
  /// [count * n] the n constants of a patch's material: a patch never spans two regions
  Scalars<B> constants;
  /// [packs * lanes * 6] axis and sheet of each element, instead of its patch's; empty: none
  Scalars<B> fibres;
  Scalars<B> damping;            ///< [count] damping by stiffness [s]; empty: none
  Array<std::uint16_t*> summed;  ///< [patch vertices]
  Indices<B> first_sum;          ///< [count + 1]
  Indices<B> first_slot;         ///< [sums + 1]
  /// Offset of the x component among the patch's element forces [pack][corner][3][lane]
  Array<std::uint16_t*> slot;
  VertexShares<B> shares;
  Indices<B> element;  ///< [packs * lanes] the mesh's tetrahedron, -1: padding
};

}  // namespace plica
