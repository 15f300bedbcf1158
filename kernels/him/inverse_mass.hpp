// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inverse_mass.hpp>
#include <plica/core/small.hpp>
#include <plica/kernels/transfer.hpp>
#include <plica/kernels/vectors.hpp>

// The coarsest level of the hierarchical inverse mass: acceleration = weight R S R^T force.
namespace plica {

/// A middle level: acceleration = weight Q force + P (the coarser level's), Q = D^-1 + D^-1 (1 - M D^-1): the lumped mass,
/// corrected once by the consistent one (Richardson). Without a P there is no coarser one; Q without weight is not worked out.
template <class B>
struct AnswerOfLevel {
  using Real = typename B::Real;
  SparseRows<B> mass, up;
  Scalars<B> inverse_diagonal;
  Vectors<B> force, coarser, acceleration;
  Real weight;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    Vec3<Real> below;
    if (up.rows > 0) below = row_product<B>(up, a, coarser);
    if (weight == 0) return set_vector<B>(acceleration, a, below);
    const Vec3<Real> lumped = row_product<B>(mass, a, force);
    const Real w = weight * inverse_diagonal(a);
    for (int k = 0; k < 3; ++k) acceleration(a, k) = w * (2 * force(a, k) - lumped[k]) + below[k];
  }
};

/// The finest level: acceleration = weight m^-1 force + P (the coarser level's).
template <class B>
struct AnswerOfFinest {
  using Real = typename B::Real;
  SparseRows<B> up;
  Scalars<B> inverse_mass;
  Vectors<B> force, coarser, acceleration;
  Real weight;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    Vec3<Real> below;
    if (up.rows > 0) below = row_product<B>(up, a, coarser);
    const Real w = weight * inverse_mass(a);
    for (int k = 0; k < 3; ++k) acceleration(a, k) = w * force(a, k) + below[k];
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
    Real even[rows] = {}, odd[rows] = {};  // so that an addition need not wait for the last one
    int j = 0;
    for (; j + 1 < n; j += 2, matrix += 2 * block)
      for (int i = 0; i < rows; ++i) {
        even[i] += static_cast<Real>(matrix[i]) * force[j];
        odd[i] += static_cast<Real>(matrix[block + i]) * force[j + 1];
      }
    for (int i = 0; i < rows; ++i)
      x(first + i) = even[i] + odd[i] + (j < n ? static_cast<Real>(matrix[i]) * force[j] : Real(0));
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
