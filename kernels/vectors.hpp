// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <optional>
#include <plica/core/matrices.hpp>
#include <plica/core/model.hpp>
#include <plica/core/pack.hpp>
#include <plica/core/small.hpp>
#include <plica/core/transfer.hpp>
#include <plica/kernels/reduce.hpp>

// Building blocks of the vertex kernels: what one vertex, surface point or block is asked for, and
// the updates and sums of whole fields. A kernel is written separately only for what these cannot
// do, or for what would read a field once more. Labels name a launch to profilers; the caller
// passes them.
namespace plica {

// ---- launches ------------------------------------------------------------------------------

/// Runs work(i) for i < n.
template <class B, class Work>
void update_vertices(const typename B::Exec& exec, const char* label, int n, const Work& work) {
  launch(label, Kokkos::RangePolicy<typename B::Exec>(exec, 0, n), like_device::shuffled(n, work));
}

/// Work that is left out where a count on the device is 0, so that the host need not know it. An
/// empty count: the work is always done.
template <class B, class Work>
struct WhereTouching {
  const double* count;
  Work work;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    if (!count || *count > 0) work(i);
  }
};

template <class B, class Work>
void where_touching(const typename B::Exec& exec, const Doubles<B>& count, const char* label, int n,
                    const Work& work) {
  update_vertices<B>(exec, label, n, WhereTouching<B, Work>{count.data(), work});
}

/// Terms of a sum; all are 0 where a count on the device is 0.
template <class B, class Term>
struct TermWhereTouching {
  const double* count;
  Term term;
  KOKKOS_INLINE_FUNCTION auto operator()(int i) const {
    return !count || *count > 0 ? term(i) : decltype(term(i)){};
  }
};

// ---- of one vertex, point or block ---------------------------------------------------------

// Reads by the constant stride of three numbers; a view's own index takes a multiplication.
template <class B>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> vector_at(const Vectors<B>& x, int a) {
  const auto* const at = x.data() + 3 * static_cast<std::ptrdiff_t>(a);
  return {at[0], at[1], at[2]};
}
template <class B>
KOKKOS_INLINE_FUNCTION void set_vector(const Vectors<B>& x, int a,
                                       const Vec3<typename B::Real>& value) {
  auto* const at = x.data() + 3 * static_cast<std::ptrdiff_t>(a);
  at[0] = value[0], at[1] = value[1], at[2] = value[2];
}

template <class B>
KOKKOS_INLINE_FUNCTION SymMat3<typename B::Real> block_at(const Blocks<B>& d, int a) {
  return {{d(a, 0), d(a, 1), d(a, 2), d(a, 3), d(a, 4), d(a, 5)}};
}
template <class B>
KOKKOS_INLINE_FUNCTION void set_block(const Blocks<B>& d, int a,
                                      const SymMat3<typename B::Real>& value) {
  for (int k = 0; k < 6; ++k) d(a, k) = value[k];
}
/// Returns the diagonal block of row a of a matrix.
template <class B>
KOKKOS_INLINE_FUNCTION SymMat3<typename B::Real> own_block(const BlockMatrix<B>& A, int a) {
  const auto* const b = &A.value(A.place(A.diagonal(a)), 0);
  return {{b[0], b[4], b[8], b[1], b[2], b[5]}};
}
/// Adds weight C to a stored block.
template <class B>
KOKKOS_INLINE_FUNCTION void add_block(const BlockMatrix<B>& A, int s, typename B::Real weight,
                                      const SymMat3<typename B::Real>& C) {
  const int at = A.place(s);
  for (int k = 0; k < 9; ++k) A.value(at, k) += weight * C[SymMat3<typename B::Real>::place(k)];
}

/// Returns start + the sum of the shares that patches or regions have in vertex a, in their order.
/// A kernel of linear elements leaves a vertex's sum in every patch that the vertex is in, one of
/// nodal elements in every region; this function adds them up:
///
///   patch 0 |. . x . .|  patch 1 |. x . .|  patch 2 |. . . x|      partial
///                 \______________  |  ___________________/
///                                  a                               start + x + x + x
///
/// A vertex that others follow adds their sums, too, each times its weight.
template <class B>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> sum_of_shares(const VertexShares<B>& shares,
                                                            const Vectors<B>& partial, int a,
                                                            Vec3<typename B::Real> start = {}) {
  if (shares.weight.extent(0) > 0) {
    for (int s = shares.first(a); s < shares.first(a + 1); ++s)
      start += shares.weight(s) * vector_at<B>(partial, shares.row(s));
    return start;
  }
  for (int s = shares.first(a); s < shares.first(a + 1); ++s) {
    const int i = shares.row(s);
    for (int k = 0; k < 3; ++k) start[k] += partial(i, k);
  }
  return start;
}

/// Difference x - x0 of two fields, which is stored nowhere. It is for use within a kernel and has
/// references: a copy of a view costs more than reading it.
template <class B>
struct Difference {
  const Vectors<B>&x, &x0;
};
template <class B>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> vector_at(const Difference<B>& d, int a) {
  return vector_at<B>(d.x, a) - vector_at<B>(d.x0, a);
}

/// Returns a vector and the number behind it, the next vector's first. A CPU reads four numbers at
/// once.
template <class B>
KOKKOS_INLINE_FUNCTION Pack<typename B::Real, 4> four_at(const Vectors<B>& x, int a) {
  return load_lanes<Pack<typename B::Real, 4>>(x.data() + 3 * static_cast<std::ptrdiff_t>(a));
}
template <class B>
KOKKOS_INLINE_FUNCTION Pack<typename B::Real, 4> four_at(const Difference<B>& d, int a) {
  return four_at<B>(d.x, a) - four_at<B>(d.x0, a);
}

/// Returns the sum of weight(s) * x at vertex(s), over s from first to before last. x: Vectors or a
/// Difference. The greatest vertex is the last: behind it there may be nothing to read.
template <class B, class Field, class Vertex, class Weight>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> weighted_sum(const Field& x, int first, int last,
                                                           const Vertex& vertex,
                                                           const Weight& weight) {
  using Four = Pack<typename B::Real, 4>;
  Vec3<typename B::Real> sum;
  int s = first;
  if constexpr (B::for_cpu) {
    Four fours;
    for (; s + 1 < last; ++s) fours += Four(weight(s)) * four_at<B>(x, vertex(s));
    sum = {fours[0], fours[1], fours[2]};
  }
  for (; s < last; ++s) sum += weight(s) * vector_at<B>(x, vertex(s));
  return sum;
}

/// Returns start + the value of a field at point p, which lies in a tetrahedron. The value is the
/// sum of weight * x over its four vertices.
template <class B, class Field>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> value_at(const Transfer<B>& points, const Field& x,
                                                       int p,
                                                       const Vec3<typename B::Real>& start = {}) {
  return start + weighted_sum<B>(
                     x, 0, 4, [&](int c) { return points.source(p, c); },
                     [&](int c) { return points.weight(p, c); });
}

/// Returns the sum of |weight| * x over the four vertices of point p's tetrahedron. Where the point
/// is outside of it, some weights are negative.
template <class B>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> sum_of_parts_at(const Transfer<B>& points,
                                                              const Vectors<B>& x, int p) {
  Vec3<typename B::Real> sum;
  for (int c = 0; c < 4; ++c)
    sum += Kokkos::abs(points.weight(p, c)) * vector_at<B>(x, points.source(p, c));
  return sum;
}

// ---- of whole fields, compiled once in vectors.cpp -----------------------------------------

namespace vectors {

template <class B>
void add(const typename B::Exec& exec, const char* label, std::size_t count, typename B::Real a,
         const typename B::Real* x, typename B::Real* y);
template <class B>
void combine(const typename B::Exec& exec, const char* label, std::size_t count, typename B::Real a,
             const typename B::Real* x, typename B::Real b, const typename B::Real* y,
             typename B::Real* out);
template <class Exec, class From, class To>
void convert(const Exec& exec, const char* label, std::size_t count, const From* from, To* to);

}  // namespace vectors

/// Adds a x to y, number by number; both are fields of one kind.
template <class B, class View>
void add(const typename B::Exec& exec, const char* label, typename B::Real a, const View& x,
         const View& y) {
  vectors::add<B>(exec, label, y.span(), a, x.data(), y.data());
}
/// Computes out = a x + b y, number by number; out may be one of them.
template <class B, class View, class Number = typename View::value_type>
void combine(const typename B::Exec& exec, const char* label, typename B::Real a, const View& x,
             typename B::Real b, const View& y, const View& out) {
  vectors::combine<B>(exec, label, out.span(), a, x.data(), b, y.data(), out.data());
}
/// Computes out = a x + b y for displacements and velocities.
template <class B>
void combine(const typename B::Exec& exec, const char* label, typename B::Real a, const State<B>& x,
             typename B::Real b, const State<B>& y, const State<B>& out) {
  combine<B>(exec, label, a, x.u, b, y.u, out.u);
  combine<B>(exec, label, a, x.v, b, y.v, out.v);
}
/// Multiplies x by a.
template <class B, class View>
void scale(const typename B::Exec& exec, const char* label, typename B::Real a, const View& x) {
  combine<B>(exec, label, a, x, typename B::Real(0), x, x);
}
/// Converts the values of a field to another precision.
template <class Exec, class From, class To>
void convert(const Exec& exec, const char* label, const From& from, const To& to) {
  vectors::convert(exec, label, to.span(),
                   static_cast<const typename From::value_type*>(from.data()), to.data());
}

/// Computes out = a x + b y at vertices that forces move; the other vertices keep their values.
template <class B>
void combine_free(const typename B::Exec& exec, const char* label, const Scalars<B>& inverse_mass,
                  typename B::Real a, const Vectors<B>& x, typename B::Real b, const Vectors<B>& y,
                  const Vectors<B>& out);
/// Computes out = a m x + b y at vertices that forces move, 0 at the others; m: their masses.
template <class B>
void weigh(const typename B::Exec& exec, const char* label, const Model<B>& model,
           typename B::Real a, const Vectors<B>& x, typename B::Real b, const Vectors<B>& y,
           const Vectors<B>& out);

/// Product x . y at a vertex, in double.
template <class B>
struct Dot {
  Vectors<B> x, y;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += static_cast<double>(x(a, k)) * static_cast<double>(y(a, k));
    return {{sum}};
  }
};
/// Computes result(0) = x . y, in double.
template <class B>
void dot(const typename B::Exec& exec, const char* label, const Vectors<B>& x, const Vectors<B>& y,
         const BlockSums<B>& blocks, const Doubles<B>& result);
/// Computes result(0) = the sum of the x components.
template <class B>
void sum_first(const typename B::Exec& exec, const char* label, const Vectors<B>& x,
               const BlockSums<B>& blocks, const Doubles<B>& result);
/// Returns a number in [-1, 1) that looks random: a hash of component k of vertex a, from its 53
/// highest bits (SplitMix64: Steele, Lea & Flood 2014).
KOKKOS_INLINE_FUNCTION double hashed(std::int64_t a, int k) {
  std::uint64_t h = static_cast<std::uint64_t>(3 * a + k + 1) * 0x9e3779b97f4a7c15;
  h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9;
  h = (h ^ h >> 27) * 0x94d049bb133111eb;
  return static_cast<double>((h ^ h >> 31) >> 11) * 0x1p-52 - 1;
}
/// Fills x with a start vector that has a part in every mode, and computes result(0) = x . x. Its
/// numbers are hashed() ones; they are 0 where the inverse mass is 0.
/// @param owned   vertices that are summed over; none: all
/// @param number  number that is hashed for each vertex; empty: its own
template <class B>
void fill_from_hash(const typename B::Exec& exec, const char* label, const Scalars<B>& inverse_mass,
                    const Vectors<B>& x, const BlockSums<B>& blocks, const Doubles<B>& result,
                    const std::optional<Items>& owned = {}, const Indices<B>& number = {});

}  // namespace plica
