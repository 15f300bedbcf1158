// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>
#include <plica/core/nodal_rows.hpp>
#include <plica/core/patches.hpp>

namespace plica {

/// Mass-proportional damping [1/s]: of all vertices, or where regions differ of each.
template <class B>
struct MassDamping {
  typename B::Real everywhere = 0;
  Scalars<B> of_vertex;  ///< [vertices], or empty
  KOKKOS_INLINE_FUNCTION typename B::Real operator()(int a) const {
    return of_vertex.extent(0) > 0 ? of_vertex(a) : everywhere;
  }
};

/// What stays constant at the vertices of one level.
template <class B>
struct VertexModel {
  Scalars<B> mass;          ///< lumped [kg], > 0
  Scalars<B> inverse_mass;  ///< [1/kg]; 0: the vertex's motion is given, forces do not move it
  MassDamping<B> damping;
  VertexShares<B> shares;  ///< in which the elements' forces are left, linear or nodal
};

/// What stays constant on one level. Kernels take the parts that they read: the whole is long to
/// copy.
template <class B>
struct Model : VertexModel<B> {
  int vertices = 0;
  int tets = 0;
  Patches<B> patches;  ///< of linear elements; also where nodal ones of an implicit level are
                       ///< preconditioned by linear ones
  NodalRows<B> rows;   ///< of nodal elements
  /// the same for a preconditioner, no pressures smoothed
  NodalRows<Backend<float, typename B::Exec>> float_rows;
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

  /// Takes the other's values, in the order of `exec`.
  void copy(const typename B::Exec& exec, const State& from) const {
    plica::copy(exec, u, from.u);
    plica::copy(exec, v, from.v);
  }
};

}  // namespace plica
