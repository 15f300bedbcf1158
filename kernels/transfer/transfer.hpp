// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/vectors.hpp>

namespace plica {

/// Values that a level hands to its neighbour, of one field at one target vertex. A field is
/// displacements or velocities.
template <class Real>
struct Mapped {
  Vec3<Real> state;      ///< sum of weight * the source's values
  Vec3<Real> variation;  ///< the target's base + sum of weight * the source's change
};

/// Rule that takes the state. Like all three rules, it is a pure function of the displacements;
/// both fields of a vertex switch together.
struct MapState {
  static constexpr bool needs_variation = false, needs_state = true;
  template <class Real>
  static KOKKOS_INLINE_FUNCTION bool take_state(const Mapped<Real>&, Real) {
    return true;
  }
};
/// Rule that takes the variation.
struct MapVariation {
  static constexpr bool needs_variation = true, needs_state = false;
  template <class Real>
  static KOKKOS_INLINE_FUNCTION bool take_state(const Mapped<Real>&, Real) {
    return false;
  }
};
/// Rule that takes the state where the levels have drifted apart by more than `limit` (epsilon *
/// local edge length), the variation elsewhere. The paper leaves the criterion to its reference
/// [6]; this criterion is our own.
struct MapSwitched {
  static constexpr bool needs_variation = true, needs_state = true;
  template <class Real>
  static KOKKOS_INLINE_FUNCTION bool take_state(const Mapped<Real>& u, Real limit) {
    const Vec3<Real> d = u.state - u.variation;
    return dot(d, d) > limit * limit;
  }
};

/// Maps the fields of one target vertex per row: to = W from (state), or base + W (from -
/// from_start) (variation). `to` and `base` may be equal. Per row 16 + 4 s bytes, and 6 s in and 6
/// s out per field set.
template <class B, class Rule>
struct MapFields {
  using Real = typename B::Real;
  Transfer<B> transfer;
  State<B> from, from_start, base, to;
  Scalars<B> limit;  ///< [target vertices] m; empty unless switched

  KOKKOS_INLINE_FUNCTION Mapped<Real> at(const Vectors<B>& x, const Vectors<B>& x0,
                                         const Vectors<B>& b, int row) const {
    Mapped<Real> m{value_at<B>(transfer, x, row), {}};
    if constexpr (Rule::needs_variation)
      m.variation =
          value_at<B>(transfer, Difference<B>{x, x0}, row, vector_at<B>(b, transfer.target(row)));
    return m;
  }

  KOKKOS_INLINE_FUNCTION void operator()(int row) const {
    const int a = transfer.target(row);
    const Mapped<Real> u = at(from.u, from_start.u, base.u, row),
                       v = at(from.v, from_start.v, base.v, row);
    Real bound = 0;
    if constexpr (Rule::needs_state && Rule::needs_variation) bound = limit(a);
    const bool state = Rule::take_state(u, bound);
    set_vector<B>(to.u, a, state ? u.state : u.variation);
    set_vector<B>(to.v, a, state ? v.state : v.variation);
  }
};

template <class B, class Rule>
void map_fields(const typename B::Exec& exec, const char* label, const Transfer<B>& transfer,
                const State<B>& from, const State<B>& from_start, const State<B>& base,
                const State<B>& to, const Scalars<B>& limit) {
  update_vertices<B>(exec, label, transfer.rows,
                     MapFields<B, Rule>{transfer, from, from_start, base, to, limit});
}

// Adjoint restriction of the corrected cycles. Per entry 4 + s bytes of the row and 6 s, or 3 s, of
// the finer vertex.

/// Sets a coarse vertex's state to the average by mass of the finer vertices in its elements. Given
/// motions stay.
template <class B>
struct RestrictState {
  using Real = typename B::Real;
  Restriction<B> restriction;
  State<B> fine, coarse;
  Scalars<B> inverse_mass;  ///< inverse masses of the coarse level

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    if (!(inverse_mass(a) > 0)) return;
    const auto mean = [&](const Vectors<B>& x) {
      return weighted_sum<B>(
          x, restriction.first(a), restriction.first(a + 1),
          [&](int s) { return restriction.source(s); },
          [&](int s) { return restriction.average(s); });
    };
    set_vector<B>(coarse.u, a, mean(fine.u));
    set_vector<B>(coarse.v, a, mean(fine.v));
  }
};

/// Computes tau = P^T f_fine - f of vertices that forces move: the difference from the coarse
/// level's own force f to that of the finer level. The finer level's force includes its own
/// correction. Brandt's full approximation scheme.
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
    for (int k = 0; k < 3; ++k)
      correction(a, k) = inverse_mass(a) > 0 ? sum[k] - force(a, k) : Real(0);
  }
};

// Sparse matrix of numbers times vectors. Per entry 4 bytes, those of a number, and 3 s of the
// vector it points at, which a cache holds; 6 flops.

/// Returns row `row` of A x, with three or four numbers for each vector of x. A CPU takes four
/// entries at a time, and vectors as four numbers. The fourth, the next vector's first, is not
/// used. So the row's last entry, which may point at the last vector, is taken by itself, and a
/// single vector number by number.
template <class B, class Value, class Field>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> row_product(const SparseRows<B, Value>& A, int row,
                                                          const Field& x) {
  using Real = typename B::Real;
  int s = A.first(row);
  const int last = A.first(row + 1);
  Vec3<Real> y;
#if (defined(__clang__) || __GNUC__ >= 12) && !defined(__CUDACC__)
  if (B::for_cpu && x.extent(0) > 1) {
    typedef Real Four
        __attribute__((vector_size(4 * sizeof(Real)), may_alias, aligned(alignof(Real))));
    typedef Value Numbers
        __attribute__((vector_size(4 * sizeof(Value)), may_alias, aligned(alignof(Value))));
    constexpr std::ptrdiff_t stride = Field::static_extent(1);
    const auto vector = [&](int entry) { return x.data() + stride * A.column(entry); };
    const auto add = [&](int entry, const Four& factor, Four& to) {
      to += *reinterpret_cast<const Four*>(vector(entry)) * factor;
    };
    const Value* const value = A.value.data();
    // four sums, so that an addition need not wait for the last one; an array would go to memory
    Four a = {}, b = {}, c = {}, d = {};
    for (; s + 4 < last; s += 4) {
      const Four number =
          __builtin_convertvector(*reinterpret_cast<const Numbers*>(value + s), Four);
      add(s, __builtin_shufflevector(number, number, 0, 0, 0, 0), a);
      add(s + 1, __builtin_shufflevector(number, number, 1, 1, 1, 1), b);
      add(s + 2, __builtin_shufflevector(number, number, 2, 2, 2, 2), c);
      add(s + 3, __builtin_shufflevector(number, number, 3, 3, 3, 3), d);
    }
    const Four number = __builtin_convertvector(*reinterpret_cast<const Numbers*>(value + s), Four);
    add(s, __builtin_shufflevector(number, number, 0, 0, 0, 0), a);
    add(s + 1, __builtin_shufflevector(number, number, 1, 1, 1, 1), b);
    add(s + 2, __builtin_shufflevector(number, number, 2, 2, 2, 2), c);
    const Four all = (a + b) + (c + d);
    const Real* const at = vector(s + 3);
    for (int k = 0; k < 3; ++k) y[k] = all[k] + number[3] * at[k];
    return y;
  }
#endif
  for (; s < last; ++s)
    for (int k = 0; k < 3; ++k) y[k] += static_cast<Real>(A.value(s)) * x(A.column(s), k);
  return y;
}

/// Computes y = A x.
template <class B, class Value = typename B::Real>
struct MultiplyRows {
  SparseRows<B, Value> A;
  Vectors<B> x, y;
  KOKKOS_INLINE_FUNCTION void operator()(int row) const {
    set_vector<B>(y, row, row_product<B>(A, row, x));
  }
};

}  // namespace plica
