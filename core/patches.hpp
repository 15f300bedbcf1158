// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <plica/core/backend.hpp>

namespace plica {

/// Where an element kernel leaves what it adds to a vertex: in rows of its own per patch or region,
/// which are added up in this order. Vertex a: rows [first(a), first(a+1)) of `row`.
template <class B>
struct VertexShares {
  int rows = 0;      ///< that the kernel writes; those of no vertex are 0
  Indices<B> first;  ///< [vertices + 1]
  Indices<B> row;
};

/// The tetrahedra of one mesh, cut into patches of neighbours small enough that their vertices and
/// element forces stay in the nearest memory (first-level cache, a GPU's shared memory). Only sums
/// per patch vertex leave it, and they are added up in a fixed order: the same bits for any number
/// of threads.
///
/// * patch p: packs [first_pack(p), first_pack(p+1)) of `lanes` elements each, the last one padded
/// with volume 0;
///   vertices [first_vertex(p), first_vertex(p+1)) of `vertex`: which mesh vertices it touches
/// * pack q: corner(q, c, l) is which of its patch's vertices corner c of element l is; shape(q,
/// 0..8, l) the inverse of the
///   edge matrix with columns X1-X0, X2-X0, X3-X0, row by row [1/m]; shape(q, 9, l) the volume [m^3]
/// * patch p: sums [first_sum(p), first_sum(p+1)), each for `at_once` vertices of the patch, number
/// j of sum i for its vertex
///   summed(first_vertex(p) + (i - first_sum(p)) at_once + j). Its terms: slots [first_slot(i), first_slot(i+1)) of `slot`, `at_once` side by
///   side, one for each of the vertices; a vertex of fewer elements than the others takes `nothing` at the end. Vertices stand by the number
///   of their elements, so that this is seldom, and that a processor foresees where a sum ends
/// * the shares of a mesh vertex: its patch vertices
template <class B>
struct Patches {
  using Real = typename B::Real;
  using Memory = typename B::Memory;
  static constexpr int lanes = B::lanes;
  static constexpr int capacity = 256;  ///< elements of a patch, at most
  /// vertices of a patch, at most: 31 kB with two fields in double
  static constexpr int vertex_capacity = 120;
  static constexpr int at_once = B::for_cpu ? 4 : 1;  ///< vertices that one thread sums up for
  /// behind all element forces: zeros
  static constexpr int nothing = (capacity + lanes - 1) / lanes * lanes * 4 * 3;
  template <class T>
  using Array = Kokkos::View<T, Kokkos::LayoutRight, Memory>;

  int count = 0;
  int vertices = 0;  ///< of the mesh
  int packs = 0;
  Indices<B> first_pack;    ///< [count + 1]
  Indices<B> first_vertex;  ///< [count + 1]
  Indices<B> vertex;        ///< [patch vertices] of a patch, ascending
  Array<std::uint16_t* [4][lanes]> corner;
  Array<Real* [10][lanes]> shape;
  /// [count * n] the n constants of its material: a patch never spans two regions
  Scalars<B> constants;
  /// [packs * lanes * 6] axis and sheet of each element, instead of its patch's; empty: none
  Scalars<B> fibres;
  Scalars<B> damping;            ///< [count] by stiffness [s]; empty: none anywhere
  Array<std::uint16_t*> summed;  ///< [patch vertices]
  Indices<B> first_sum;          ///< [count + 1]
  Indices<B> first_slot;         ///< [sums + 1]
  /// offset of the x component among the patch's element forces [pack][corner][3][lane]
  Array<std::uint16_t*> slot;
  VertexShares<B> shares;
  Indices<B> element;  ///< [packs * lanes] the mesh's tetrahedron, -1: padding
};

}  // namespace plica
