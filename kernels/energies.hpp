// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/core/small.hpp>
#include <plica/kernels/reduce.hpp>

namespace plica {

/// Kinetic energy and gravity's potential energy of a vertex [J], the latter zero at rest. Not finite where u or v is not.
template <class B>
struct MotionEnergies {
  using Real = typename B::Real;
  Scalars<B> mass;
  State<B> state;
  Vec3<Real> gravity;

  KOKKOS_INLINE_FUNCTION Sums<2> operator()(int a) const {
    double speed2 = 0, along = 0;
    for (int k = 0; k < 3; ++k) {
      speed2 += static_cast<double>(state.v(a, k)) * static_cast<double>(state.v(a, k));
      along += static_cast<double>(gravity[k]) * static_cast<double>(state.u(a, k));
    }
    const double m = static_cast<double>(mass(a));
    return {{0.5 * m * speed2, -m * along}};
  }
};

/// The x component of a field of the patches' vertices, for sums over it.
template <class B>
struct FirstComponent {
  Vectors<B> field;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int i) const { return {{static_cast<double>(field(i, 0))}}; }
};

}  // namespace plica
