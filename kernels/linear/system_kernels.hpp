// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/implicit_weights.hpp>
#include <plica/kernels/vectors.hpp>

// Vertex kernels of the system of an implicit stage, A = (1 + b c) M + a K* + contact blocks; see
// ImplicitWeights. Rows of vertices whose motion is given are zero in the preconditioner, which
// keeps every search direction zero there.
namespace plica {

/// Computes q = (1 + b c) M p - a * (sum of the copies of -K p) + `beside`. q and `beside` may have
/// another precision and order.
template <class B, class Other = B, class To = Vectors<B>>
struct SystemProduct {
  using Real = typename B::Real;
  VertexModel<B> model;
  Vectors<B> p, partial;
  To q;
  Real a, b;
  Vectors<Other> beside = {};  ///< product of the parts without elements; empty: there are none

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const Real inertia = (1 + b * model.damping(i)) * model.mass(i);
    Vec3<Real> row = inertia * vector_at<B>(p, i) - a * sum_of_shares<B>(model.shares, partial, i);
    if (beside.extent(0) > 0)
      for (int k = 0; k < 3; ++k) row[k] += static_cast<Real>(beside(i, k));
    set_vector<B>(q, i, row);
  }
};

/// Sets one column of the vertex blocks of A: (1 + b c) m on the diagonal, plus a times column
/// `direction` of the stiffness' own block. It sets the rows of the diagonal and the next (cyclic).
/// A vertex that others follow adds their blocks, each times its squared weight. What couples two
/// of its followers is left out.
template <class B>
struct DiagonalColumn {
  using Real = typename B::Real;
  VertexModel<B> model;
  Vectors<B> partial;
  Blocks<B> diagonal;
  Real a, b;
  int direction;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const Vec3<Real> sum = sum_of_blocks(i);
    diagonal(i, direction) = (1 + b * model.damping(i)) * model.mass(i) + a * sum[direction];
    const int beside = direction == 0 ? 3 : direction == 1 ? 5 : 4;
    diagonal(i, beside) = a * sum[(direction + 1) % 3];
  }
  KOKKOS_INLINE_FUNCTION Vec3<Real> sum_of_blocks(int i) const {
    const VertexShares<B>& shares = model.shares;
    if (shares.weight.extent(0) == 0) return sum_of_shares<B>(shares, partial, i);
    Vec3<Real> sum;
    for (int s = shares.first(i); s < shares.first(i + 1); ++s)
      sum += (shares.weight(s) * shares.weight(s)) * vector_at<B>(partial, shares.row(s));
    return sum;
  }
};

/// Adds scale * block p to q, with symmetric vertex blocks that are not from elements.
template <class B>
struct AddBlockProduct {
  using Real = typename B::Real;
  Blocks<B> block;
  Vectors<B> p, q;
  Real scale;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    set_vector<B>(q, a, vector_at<B>(q, a) + block_at<B>(block, a) * (scale * vector_at<B>(p, a)));
  }
};

/// Inverts the vertex blocks in place. A block that is not positive definite (a material that
/// softens) is replaced by the vertex's mass term.
template <class B>
struct InvertBlocks {
  using Real = typename B::Real;
  VertexModel<B> model;
  Blocks<B> d;
  Real b;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    SymMat3<Real> inverse;
    if (model.inverse_mass(a) > 0 && !invert_positive(block_at<B>(d, a), inverse)) {
      const Real s = 1 / ((1 + b * model.damping(a)) * model.mass(a));
      inverse = {{s, s, s, 0, 0, 0}};
    }
    set_block<B>(d, a, inverse);
  }
};

}  // namespace plica
