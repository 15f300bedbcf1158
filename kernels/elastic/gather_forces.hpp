// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/vectors.hpp>

namespace plica {

/// Computes f_a = m_a g + sum of the shares in the vertex, in their order [N]. 24 s bytes per
/// vertex written and, with about 2.6 copies, 14 + 9 s read (s = sizeof(Real)).
template <class B>
struct GatherForces {
  using Real = typename B::Real;
  VertexShares<B> shares;
  Vectors<B> partial;
  Scalars<B> mass;
  Vec3<Real> gravity;  ///< [m/s^2]
  Vectors<B> f;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    set_vector<B>(f, a, sum_of_shares<B>(shares, partial, a, mass(a) * gravity));
  }
};

/// Computes f = m g.
template <class B>
struct WeighVertices {
  Scalars<B> mass;
  Vec3<typename B::Real> gravity;
  Vectors<B> f;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) f(a, k) = mass(a) * gravity[k];
  }
};

template <class B>
void gather_forces(const typename B::Exec& exec, const Model<B>& model, const Vectors<B>& partial,
                   const Vec3<typename B::Real>& gravity, const Vectors<B>& f) {
  update_vertices<B>(exec, "plica::gather_forces", model.vertices,
                     GatherForces<B>{model.shares, partial, model.mass, gravity, f});
}

}  // namespace plica
