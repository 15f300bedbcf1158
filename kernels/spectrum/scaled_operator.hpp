// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/surface.hpp>
#include <plica/kernels/vectors.hpp>

// Vertex kernels of the Lanczos iteration on M^-1/2 (K + contact) M^-1/2, whose largest eigenvalue is w_max^2 [1/s^2]. A zero
// inverse mass takes the vertex out.
namespace plica {

/// p = scale M^-1/2 x
template <class B>
struct ScaleByMass {
  using Real = typename B::Real;
  Scalars<B> inverse_mass;
  Vectors<B> x, p;
  Real scale;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Real s = scale * Kokkos::sqrt(inverse_mass(a));
    for (int k = 0; k < 3; ++k) p(a, k) = s * x(a, k);
  }
};

/// y_p = stiffness * sum of weight * x: contact at every point, in every direction.
template <class B>
struct PointStiffness {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  Vectors<B> x, y;
  Real stiffness;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    set_vector<B>(y, p, stiffness * value_at<B>(surface.embedding, x, p));
  }
};

/// w = M^-1/2 (force - elastic) - beta v_before, and v.w: force holds the contact part, the copies of -K p the elastic one.
template <class B>
struct LanczosProduct {
  using Real = typename B::Real;
  Model<B> model;
  Vectors<B> partial, contact, v, before, w;
  Real beta;
  bool with_contact;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    const Real s = Kokkos::sqrt(model.inverse_mass(a));
    const Vec3<Real> sum = sum_of_shares<B>(model.shares, partial, a);
    double dot = 0;
    for (int k = 0; k < 3; ++k) {
      w(a, k) = s * ((with_contact ? contact(a, k) : Real(0)) - sum[k]) - beta * before(a, k);
      dot += static_cast<double>(w(a, k)) * static_cast<double>(v(a, k));
    }
    return {{dot}};
  }
};

/// w -= alpha v, and w.w
template <class B>
struct LanczosOrthogonalise {
  using Real = typename B::Real;
  Vectors<B> v, w;
  Real alpha;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      w(a, k) -= alpha * v(a, k);
      sum += static_cast<double>(w(a, k)) * static_cast<double>(w(a, k));
    }
    return {{sum}};
  }
};

/// before = v, v = scale w
template <class B>
struct LanczosShift {
  using Real = typename B::Real;
  Vectors<B> v, w, before;
  Real scale;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) before(a, k) = v(a, k), v(a, k) = scale * w(a, k);
  }
};

}  // namespace plica
