// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inverse_mass.hpp>
#include <plica/kernels/transfer/multiply_rows.hpp>

// The answers of the hierarchical inverse mass on each level.
namespace plica {

/// A middle level: acceleration = weight Q force + P (the coarser level's), Q = D^-1 + D^-1 (1 - M D^-1): the lumped mass,
/// corrected once by the consistent one (Richardson).
template <class B>
struct AnswerOfLevel {
  using Real = typename B::Real;
  SparseRows<B> mass, up;
  Scalars<B> inverse_diagonal;
  Vectors<B> force, coarser, acceleration;
  Real weight;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Vec3<Real> lumped = row_product<B>(mass, a, force), below = row_product<B>(up, a, coarser);
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

}  // namespace plica
