// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inverse_mass.hpp>
#include <plica/core/small.hpp>
#include <plica/kernels/reduce.hpp>

// The coarsest level of the hierarchical inverse mass.
namespace plica {

/// Displacements at the coarsest level's vertices: those of the finest mesh there.
template <class B>
struct SampleDisplacement {
  using Real = typename B::Real;
  Transfer<B> sample;
  Vectors<B> u, sampled;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) {
      Real sum = 0;
      for (int c = 0; c < 4; ++c) sum += sample.weight(a, c) * u(sample.source(a, c), k);
      sampled(a, k) = sum;
    }
  }
};

/// The rotation nearest to A (its polar factor), by Newton's iteration (Higham 1986) scaled to determinant 1; where A is
/// turned inside out or flat, `before`.
template <class Real>
KOKKOS_INLINE_FUNCTION Mat3<Real> nearest_rotation(const Mat3<Real>& A, const Mat3<Real>& before) {
  const Real det = determinant(A), size = inner(A, A);
  if (!(det > Real(1e-3) * size * Kokkos::sqrt(size))) return before;
  Mat3<Real> Q = (Real(1) / Kokkos::cbrt(det)) * A;
  for (int i = 0; i < 6; ++i) Q = Real(0.5) * (Q + (Real(1) / determinant(Q)) * cofactor(Q));
  return Q;
}

/// Turns each coarsest vertex's axes with the volume-averaged deformation gradient of its elements. Returns the square of the
/// angle since the last time [rad^2], and 1.
template <class B>
struct TurnAxes {
  using Real = typename B::Real;
  CoarseFilter<B> filter;

  KOKKOS_INLINE_FUNCTION Mat3<Real> weighted_gradient(int e) const {
    Mat3<Real> F;
    const Real volume = filter.shape(e, 9);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        Real sum = i == j ? Real(1) : Real(0);
        for (int s = 0; s < 3; ++s)
          sum += (filter.displacement(filter.corner(e, s + 1), i) - filter.displacement(filter.corner(e, 0), i)) *
                 filter.shape(e, 3 * s + j);
        F[i][j] = volume * sum;
      }
    return F;
  }

  KOKKOS_INLINE_FUNCTION Sums<2> operator()(int a) const {
    Mat3<Real> F, before;
    for (int s = filter.first(a); s < filter.first(a + 1); ++s) F = F + weighted_gradient(filter.tet(s));
    for (int k = 0; k < 9; ++k) before[k / 3][k % 3] = filter.rotation(3 * a + k / 3, k % 3);
    const Mat3<Real> R = nearest_rotation(F, before);
    for (int k = 0; k < 9; ++k) filter.rotation(3 * a + k / 3, k % 3) = R[k / 3][k % 3];
    return {{static_cast<double>(Kokkos::max(Real(0), Real(3) - inner(R, before))), 1.0}};
  }
};

/// turned = R^T force
template <class B>
struct TurnForces {
  CoarseFilter<B> filter;
  Vectors<B> force;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k)
      filter.turned(a, k) = filter.rotation(3 * a, k) * force(a, 0) + filter.rotation(3 * a + 1, k) * force(a, 1) +
                            filter.rotation(3 * a + 2, k) * force(a, 2);
  }
};

/// x = S turned, dense: a work item takes a whole block of rows on a CPU, where its lanes fill registers, one row on a GPU.
/// 36 n^2 bytes and 18 n^2 flops for n vertices.
template <class B>
struct FilterForces {
  using Real = typename B::Real;
  static constexpr int block = CoarseFilter<B>::block, rows = B::on_host ? block : 1;
  CoarseFilter<B> filter;
  Scalars<B> x;  ///< [3 vertices], rounded up to whole blocks

  KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const int n = 3 * filter.vertices, first = item * rows, inside = first % block;
    const float* matrix = filter.matrix.data() + static_cast<std::size_t>(first / block) * n * block + inside;
    const Real* force = filter.turned.data();
    Real sum[rows] = {};
    for (int j = 0; j < n; ++j, matrix += block)
      for (int i = 0; i < rows; ++i) sum[i] += static_cast<Real>(matrix[i]) * force[j];
    for (int i = 0; i < rows; ++i) x(first + i) = sum[i];
  }
};

/// acceleration = weight R x
template <class B>
struct TurnBack {
  using Real = typename B::Real;
  CoarseFilter<B> filter;
  Scalars<B> x;
  Vectors<B> acceleration;
  Real weight;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k)
      acceleration(a, k) =
          weight * (filter.rotation(3 * a + k, 0) * x(3 * a) + filter.rotation(3 * a + k, 1) * x(3 * a + 1) +
                    filter.rotation(3 * a + k, 2) * x(3 * a + 2));
  }
};

}  // namespace plica
