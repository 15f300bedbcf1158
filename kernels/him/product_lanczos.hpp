// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/core/small.hpp>
#include <plica/kernels/reduce.hpp>

// Vertex kernels of the Lanczos iteration on A K in the inner product of K.
namespace plica {

/// y = K x from the elements' copies of -K x; none where the motion is given.
template <class B>
struct GatherStiffness {
  Model<B> model;
  Vectors<B> partial, y;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    Vec3<typename B::Real> sum;
    if (model.inverse_mass(a) > 0)
      for (int i = model.patches.first_copy(a); i < model.patches.first_copy(a + 1); ++i)
        for (int k = 0; k < 3; ++k) sum[k] -= partial(model.patches.copy(i), k);
    for (int k = 0; k < 3; ++k) y(a, k) = sum[k];
  }
};

template <class B>
struct DotVectors {
  Vectors<B> x, y;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += static_cast<double>(x(a, k)) * static_cast<double>(y(a, k));
    return {{sum}};
  }
};

/// x *= s, y *= s
template <class B>
struct ScaleBoth {
  Vectors<B> x, y;
  typename B::Real s;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) x(a, k) *= s, y(a, k) *= s;
  }
};

/// w -= alpha v + beta before
template <class B>
struct OrthogonaliseToTwo {
  Vectors<B> w, v, before;
  typename B::Real alpha, beta;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) w(a, k) -= alpha * v(a, k) + beta * before(a, k);
  }
};

}  // namespace plica
