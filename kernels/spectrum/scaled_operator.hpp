// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/core/small.hpp>
#include <plica/core/surface.hpp>
#include <plica/kernels/reduce.hpp>

// Vertex kernels of the Lanczos iteration on M^-1/2 (K + contact) M^-1/2, whose largest eigenvalue is w_max^2 [1/s^2]. A zero
// inverse mass takes the vertex out.
namespace plica {

/// A start vector with a part in every mode: a hash of the index, in [-1, 1).
template <class B>
struct FillFromHash {
  Scalars<B> inverse_mass;
  Vectors<B> x;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      unsigned h = static_cast<unsigned>(3 * a + k) * 2654435769u + 12345u;
      h = (h ^ (h >> 15)) * 2246822519u;
      h = (h ^ (h >> 13)) * 3266489917u;
      const double value = inverse_mass(a) > 0 ? static_cast<double>(h >> 8) / (1 << 23) - 1.0 : 0.0;
      x(a, k) = static_cast<typename B::Real>(value);
      sum += value * value;
    }
    return {{sum}};
  }
};

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
    Vec3<Real> s;
    for (int c = 0; c < 4; ++c)
      for (int k = 0; k < 3; ++k) s[k] += surface.embedding.weight(p, c) * x(surface.embedding.source(p, c), k);
    for (int k = 0; k < 3; ++k) y(p, k) = stiffness * s[k];
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
    Vec3<Real> sum;
    for (int i = model.patches.first_copy(a); i < model.patches.first_copy(a + 1); ++i)
      for (int k = 0; k < 3; ++k) sum[k] += partial(model.patches.copy(i), k);
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
