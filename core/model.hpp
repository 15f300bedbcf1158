// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>
#include <plica/core/nodal_rows.hpp>
#include <plica/core/patches.hpp>
#include <plica/core/transfer.hpp>

namespace plica {

/// Mass-proportional damping [1/s]: one for all vertices, or one for each where regions differ.
template <class B>
struct MassDamping {
  typename B::Real everywhere = 0;
  Scalars<B> of_vertex;  ///< [vertices], or empty
  KOKKOS_INLINE_FUNCTION typename B::Real operator()(int a) const {
    return of_vertex.extent(0) > 0 ? of_vertex(a) : everywhere;
  }
};

/// Constants of the vertices of one level.
template <class B>
struct VertexModel {
  Scalars<B> mass;  ///< lumped [kg], > 0
  /// [1/kg]; 0: the motion of the vertex is given, forces do not move it
  Scalars<B> inverse_mass;
  MassDamping<B> damping;
  /// Rows in which elements, linear or nodal, leave their forces
  VertexShares<B> shares;
};

/// Vertices that follow tetrahedra of a coarser piece of the mesh, see Followers; none: no arrays.
/// With T the rows of `place`, u = T y gives the motion of all vertices from that of the free ones,
/// y. Forces on y are T^T f, and followers have no mass.
template <class B>
struct FollowingVertices {
  Transfer<B> place;    ///< a row per follower: its value from those of its masters
  int masters = 0;      ///< number of vertices that others follow
  Indices<B> master;    ///< [masters]
  Indices<B> first;     ///< [masters + 1] into follower and weight
  Indices<B> follower;  ///< a vertex that follows the master, ascending for each
  Scalars<B> weight;    ///< weight of the master in that vertex

  bool any() const { return place.rows > 0; }
};

/// Constants of one level. Kernels take the parts that they read, because the whole takes long to
/// copy.
template <class B>
struct Model : VertexModel<B> {
  int vertices = 0;
  int tets = 0;
  /// Patches of linear elements; also where nodal ones of an implicit level are preconditioned by
  /// linear ones
  Patches<B> patches;
  NodalRows<B> rows;  ///< rows of nodal elements
  /// Rows of nodal elements for a preconditioner, in float; no pressures are smoothed
  NodalRows<Backend<float, typename B::Exec>> float_rows;
  FollowingVertices<B> followers;
};

/// Displacement from rest u [m] and velocity v [m/s], each [vertices][3].
template <class B>
struct State {
  Vectors<B> u;
  Vectors<B> v;

  State() = default;
  State(const Vectors<B>& u_, const Vectors<B>& v_) : u(u_), v(v_) {}
  State(const std::string& name, int vertices)
      : u(zeros<Vectors<B>>("plica::" + name + ".u", vertices)),
        v(zeros<Vectors<B>>("plica::" + name + ".v", vertices)) {}

  template <class Self, class Use>
  static void each_array(Self& self, const Use& use) {
    use(self.u), use(self.v);
  }
  /// Copies the values of another state, in the order of `exec`.
  void copy(const typename B::Exec& exec, const State& from) const {
    plica::copy(exec, u, from.u);
    plica::copy(exec, v, from.v);
  }
};

}  // namespace plica
