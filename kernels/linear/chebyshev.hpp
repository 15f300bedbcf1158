// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inlining.hpp>
#include <plica/kernels/linear/packed_rows.hpp>
#include <plica/kernels/transfer/transfer.hpp>

// Chebyshev polynomials of the fourth kind in D^-1 A, D the vertex blocks (Lottes, Optimal
// polynomial smoothers for multigrid V-cycles, 2022, arXiv:2202.08830, alg. 1). They need the
// largest eigenvalue only (lanczos.hpp).
//   d_1 = 4/(3 lambda) D^-1 r;   x += d_k, r -= A d_k,
//   d_(k+1) = (2k-1)/(2k+3) d_k + (8k+4)/((2k+3) lambda) D^-1 r
// As polynomials in D^-1 A they are self-adjoint, so that a symmetric cycle of them preconditions
// conjugate gradients. All vectors are by the slots of packed_rows.hpp; directions d, which rows
// gather, are stored times the scales of packed_rows.hpp.
namespace plica {

/// Matrix and vectors of a polynomial.
template <class B>
struct Chebyshev {
  PackedRows<B> A;
  SlotBlocks<B> inverse_diagonal;
  Doubles<B> largest;
  SlotVectors<B> r, x;
  SlotVectors<B> product = {};  ///< A d, where A is not stored; empty: by the packed rows

  KOKKOS_INLINE_FUNCTION RowPack<B> over_largest(typename B::Real a) const {
    return RowPack<B>(a / static_cast<typename B::Real>(largest(0)));
  }
};

/// First direction d_1, and x = 0.
template <class B>
struct ChebyshevStart {
  using T = RowPack<B>;
  Chebyshev<B> on;
  Fours<B> d;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    const T w = load_rows<B>(&on.A.scale(at.slot)) * on.over_largest(4.0F / 3);
    set_fours<B>(d, at, w * (blocks_at<B>(on.inverse_diagonal, at) * vectors_at<B>(on.r, at)));
    set_vectors<B>(on.x, at, {});
  }
};

/// Result of a step that others gather: the next direction, or, in the last step, the residual or
/// x. The last step that leaves x adds the next direction to it.
enum class Leaves { direction, residual, answer };

/// Step of a polynomial: x += d, r -= A d. The next direction is keep d + gain/lambda D^-1 r.
template <class B>
struct ChebyshevStep {
  using T = RowPack<B>;
  Chebyshev<B> on;
  Fours<B> d, next;
  typename B::Real keep, gain;
  Leaves leaves;

  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    const T t = load_rows<B>(&on.A.scale(at.slot));
    const Vec3<T> direction = (T(1) / t) * fours_at<B>(d, at);
    const Vec3<T> product = on.product.extent(0) > 0 ? vectors_at<B>(on.product, at)
                                                     : t * packed_product<B>(on.A, at, d);
    const Vec3<T> residual = vectors_at<B>(on.r, at) - product;
    const Vec3<T> x = vectors_at<B>(on.x, at) + direction;
    const Vec3<T> ahead =
        T(keep) * direction +
        on.over_largest(gain) * (blocks_at<B>(on.inverse_diagonal, at) * residual);
    if (leaves == Leaves::answer) return set_fours<B>(next, at, x + ahead);
    set_vectors<B>(on.x, at, x), set_vectors<B>(on.r, at, residual);
    set_fours<B>(next, at, leaves == Leaves::residual ? residual : t * ahead);
  }
};

/// Restriction r = P^T of the residual of a finer level.
template <class B, class To>
struct RestrictFours {
  SparseRows<B> down;
  Fours<B> residual;
  To r;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int row) const {
    set_vector<B>(r, row, row_product<B>(down, row, residual));
  }
};

/// First direction d = P y, from a coarser level.
template <class B>
struct ChebyshevCorrection {
  Scalars<B> scale;
  SparseRows<B> up;
  Fours<B> y, d;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int slot) const {
    const Vec3<typename B::Real> sum = scale(slot) * row_product<B>(up, slot, y);
    for (int k = 0; k < 3; ++k) d(slot, k) = sum[k];
  }
};

/// Copy of a field of the vertices by slots; 0 where a slot has no vertex.
template <class B, class Field>
struct TakeSlots {
  Indices<B> vertex;
  Field from;
  SlotVectors<B> to;
  KOKKOS_INLINE_FUNCTION void operator()(int slot) const {
    const int a = vertex(slot);
    Vec3<typename B::Real> value;
    if (a >= 0)
      for (int k = 0; k < 3; ++k) value[k] = static_cast<typename B::Real>(from(a, k));
    set_vector<B>(to, slot, value);
  }
};
template <class B, class Field>
struct PutSlots {
  Indices<B> vertex;
  Fours<B> from;
  Field to;
  KOKKOS_INLINE_FUNCTION void operator()(int slot) const {
    const int a = vertex(slot);
    if (a < 0) return;
    for (int k = 0; k < 3; ++k) to(a, k) = static_cast<typename Field::value_type>(from(slot, k));
  }
};
template <class B, class From>
struct TakeSlotBlocks {
  Indices<B> vertex;
  From from;
  SlotBlocks<B> to;
  KOKKOS_INLINE_FUNCTION void operator()(int slot) const {
    const int a = vertex(slot);
    for (int k = 0; k < 6; ++k)
      to(slot / slice_height<B>, k, slot % slice_height<B>) =
          a >= 0 ? static_cast<typename B::Real>(from(a, k)) : typename B::Real(0);
  }
};

}  // namespace plica
