// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/core/small.hpp>
#include <plica/core/transfer.hpp>

// The adjoint restriction of the corrected cycles. Per entry 4 + s bytes of the row and 6 s, or 3 s, of the finer vertex.
namespace plica {

/// A coarse vertex's state = the average by mass of the finer ones in its elements. Given motions stay.
template <class B>
struct RestrictState {
  using Real = typename B::Real;
  Restriction<B> restriction;
  State<B> fine, coarse;
  Scalars<B> inverse_mass;  ///< of the coarse level

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    if (!(inverse_mass(a) > 0)) return;
    Vec3<Real> u, v;
    for (int s = restriction.first(a); s < restriction.first(a + 1); ++s) {
      const int b = restriction.source(s);
      for (int k = 0; k < 3; ++k) {
        u[k] += restriction.average(s) * fine.u(b, k);
        v[k] += restriction.average(s) * fine.v(b, k);
      }
    }
    for (int k = 0; k < 3; ++k) coarse.u(a, k) = u[k], coarse.v(a, k) = v[k];
  }
};

/// tau = P^T f_fine - f: what the coarse level's own force f lacks to the finer level's (its own correction included), of
/// vertices that forces move (Brandt's full approximation scheme).
template <class B>
struct DefectCorrection {
  using Real = typename B::Real;
  Restriction<B> restriction;
  Vectors<B> fine_force;
  Scalars<B> fine_inverse_mass, inverse_mass;
  Vectors<B> force, correction;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    Vec3<Real> sum;
    for (int s = restriction.first(a); s < restriction.first(a + 1); ++s) {
      const int b = restriction.source(s);
      if (fine_inverse_mass(b) > 0)
        for (int k = 0; k < 3; ++k) sum[k] += restriction.weight(s) * fine_force(b, k);
    }
    for (int k = 0; k < 3; ++k) correction(a, k) = inverse_mass(a) > 0 ? sum[k] - force(a, k) : Real(0);
  }
};

}  // namespace plica
