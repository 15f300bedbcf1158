// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/patches.hpp>

namespace plica {

/// Nodal elements of one mesh (elements `nodal`): constants of the mesh at rest, by rows of
/// domains. A domain is what one region has around one vertex: a quarter of each of its tetrahedra
/// there. A vertex between regions has several domains. So has one between tetrahedra whose four
/// vertices have a given motion, and others. Neighbours are domains of one region that share a
/// tetrahedron. With V_t a tetrahedron's volume and N_b its shape functions, these are sums
/// over the tetrahedra t of the pair:
///
///   C_ab = sum V_t/4 grad N_b     w_ab = sum V_t grad N_a . grad N_b
///   s_ab = sum V_t/16             V_a  = sum V_t/4
///
/// The sums of a domain with itself follow from the others. Over b, C_ab and w_ab add up to 0, s_ab
/// to V_a. C_ba = -C_ab, unless both lie on the surface of the region. For these pairs C_ab + C_ba
/// = S_ab is stored.
///
/// Rows are stored in slices of `height` side by side (sliced ELLPACK, Monakov, Lokhmotov &
/// Avetisyan 2010). Each row has a lane of a register, or a thread. A slice has the rows of one
/// region and of one block of vertices, see vertex_block. Rows that fill it up have volume 0 and
/// point to themselves. The entries of a row ascend by their vertices.
///
/// * slice q: entries [first(q), first(q+1)) of neighbour, gradient (C_ab, row a), coupling (w_ab),
///   smoothing (s_ab);
///   surface entries [first_surface(q), first_surface(q+1)) of surface_neighbour,
///   surface_gradient (S_ab)
/// * slot = slice * height + row of the slice: vertex, volume, inverse_volume
template <class B>
struct NodalRows {
  using Real = typename B::Real;
  using Memory = typename B::Memory;
  static constexpr int lanes = B::lanes;
  static constexpr int height = slice_height<B>;
  template <class T>
  using Array = Kokkos::View<T, Kokkos::LayoutRight, Memory>;

  int slices = 0;
  int domains = 0;
  Indices<B> first;   ///< [slices + 1]
  Indices<B> region;  ///< [slices]
  Indices<B> vertex;  ///< [slots] -1: none
  Scalars<B> volume;  ///< [slots] V_a [m^3]
  Scalars<B> inverse_volume;
  Array<int* [height]> neighbour;  ///< slots of the neighbours
  Array<Real* [3][height]> gradient;
  Array<Real* [height]> coupling;
  Array<Real* [height]> smoothing;  ///< s_ab, only where pressures are smoothed
  Indices<B> first_surface;
  Array<int* [height]> surface_neighbour;
  Array<Real* [3][height]> surface_gradient;
  Scalars<B> constants;  ///< [regions * n] constants of the material
  /// [slots * 6] axis and sheet of each domain, instead of its region's; empty: none
  Scalars<B> fibres;
  Scalars<B> stabiliser;  ///< [regions] beta mu [Pa]
  /// [regions] part of lambda that acts on smoothed volumes [Pa]; empty: none
  Scalars<B> bulk_excess;
  Scalars<B> damping;  ///< [regions] damping by stiffness [s]; empty: none
  VertexShares<B> shares;

  int slots() const { return slices * height; }
};

/// Numbers that the kernels of nodal elements pass on to each other, by slots.
template <class B>
struct NodalWork {
  Scalars<B> near;  ///< [slots * 8] up to two fields in the order of the slots, x y z 0 each
  /// [slots * 12] for each column j of the stress: Q_0j Q_1j Q_2j, and component j of the field
  Scalars<B> records;
  /// [slots * 2] dilatations (volume ratios in most laws) and their changes; empty: pressures are
  /// not smoothed
  Scalars<B> ratio;
  /// [slots * 2] smoothed pressures and their changes; empty: pressures are not smoothed. Mixed
  /// dilatations follow where there are any, see carried_dilatations()
  Scalars<B> pressure;
  /// [slots * 9] G of the state that tangents are about, see packed(); empty: not stored
  Scalars<B> gradient;
  /// [slots * 45] projected tangents at that state, see packed(); empty: none yet. Levels of linear
  /// elements have them, too, where there is no matrix
  Scalars<B> tangent;
};

}  // namespace plica
