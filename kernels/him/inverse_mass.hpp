// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inverse_mass.hpp>
#include <plica/core/pack.hpp>
#include <plica/core/small.hpp>
#include <plica/kernels/transfer/transfer.hpp>
#include <plica/kernels/vectors.hpp>

// Hierarchical inverse mass, level by level.
namespace plica {

/// Response of a middle level: acceleration = weight Q force + P (the coarser level's
/// acceleration). Q = 1 + (1 - M) is the lumped mass, which is 1, corrected once by the consistent
/// mass M (Richardson). Without P there is no coarser level; where the weight is 0, Q is not
/// computed.
template <class B>
struct AnswerOfLevel {
  using Real = typename B::Real;
  SparseRows<B, float> mass, up;
  Vectors<B> force, coarser, acceleration;
  Real weight;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    Vec3<Real> below;
    if (up.rows > 0) below = row_product<B>(up, a, coarser);
    if (weight == 0) return set_vector<B>(acceleration, a, below);
    const Vec3<Real> consistent = row_product<B>(mass, a, force);
    set_vector<B>(acceleration, a,
                  weight * (Real(2) * vector_at<B>(force, a) - consistent) + below);
  }
};

/// Response of the finest level: acceleration = weight m^-1 force + P (the coarser level's
/// acceleration).
template <class B>
struct AnswerOfFinest {
  using Real = typename B::Real;
  SparseRows<B, float> up;
  Scalars<B> inverse_mass;
  Vectors<B> force, coarser, acceleration;
  Real weight;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    set_vector<B>(acceleration, a, of(a, vector_at<B>(force, a)));
  }
  KOKKOS_INLINE_FUNCTION Vec3<Real> of(int a, const Vec3<Real>& own) const {
    const Vec3<Real> answer = (weight * inverse_mass(a)) * own;
    return up.rows > 0 ? answer + row_product<B>(up, a, coarser) : answer;
  }
};

/// Computes answer = (answer - v) / t: from A p to the mean acceleration.
template <class B>
struct MeanAcceleration {
  using Real = typename B::Real;
  Vectors<B> v, answer;
  Real per_step;  ///< 1/t
  KOKKOS_INLINE_FUNCTION void operator()(int a) const { set(a, vector_at<B>(answer, a)); }
  KOKKOS_INLINE_FUNCTION void set(int a, const Vec3<Real>& now) const {
    set_vector<B>(answer, a, per_step * (now - vector_at<B>(v, a)));
  }
};

/// Returns the matrix of coarse vertex a, in three rows from row 3 a on.
template <class Real, class View>
KOKKOS_INLINE_FUNCTION Mat3<Real> matrix_at(const View& x, int a) {
  Mat3<Real> A;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) A[i][j] = x(3 * a + i, j);
  return A;
}

/// Computes turned = R^T force at a vertex.
template <class B>
KOKKOS_INLINE_FUNCTION void turn_force(const CoarseInverseMass<B>& filter, int a,
                                       const Vec3<typename B::Real>& force) {
  set_vector<B>(filter.turned, a,
                transpose(matrix_at<typename B::Real>(filter.rotation, a)) * force);
}

template <class B>
struct TurnForces {
  CoarseInverseMass<B> filter;
  Vectors<B> force;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    turn_force(filter, a, vector_at<B>(force, a));
  }
};

/// Restricts to the coarsest level, and applies `turn` to the result there.
template <class B, class Turn>
struct RestrictToFrames {
  MultiplyRows<B, float> down;
  Turn turn;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const { down(a), turn(a); }
};

// Dense matrix times vectors. On a CPU a work item takes a whole group of vertices, whose rows fill
// registers; on a GPU one vertex.

/// Number of vertices of a work item.
template <class B>
constexpr int group_size = B::for_cpu ? CoarseInverseMass<B>::group : 1;
template <class B>
constexpr int groups_of(int vertices) {
  return (vertices + group_size<B> - 1) / group_size<B>;
}

/// Computes y = the rows of work item `item` times x, [columns][values]. A block's rows lie
/// together, [columns][block]; an item has `rows` of them.
template <class B, int rows, int values, int block, class Number>
KOKKOS_INLINE_FUNCTION void dense_rows(const Number* matrix, int item, int columns,
                                       const typename B::Real* x,
                                       typename B::Real (&y)[values][rows]) {
  constexpr int lanes = B::lanes, packs = rows / lanes;
  using T = typename PackOf<typename B::Real, lanes>::type;
  T sum[values][packs] = {};
  const int first = item * rows;
  const Number* column =
      matrix + static_cast<std::size_t>(first / block) * columns * block + first % block;
  for (int j = 0; j < columns; ++j, column += block, x += values)
    for (int i = 0; i < packs; ++i) {
      const T number = load_lanes<T>(column + i * lanes);
      for (int v = 0; v < values; ++v) sum[v][i] += T(x[v]) * number;
    }
  for (int v = 0; v < values; ++v)
    for (int i = 0; i < rows; ++i) y[v][i] = lane(sum[v][i / lanes], i % lanes);
}

/// Computes S R^T force of a work item's vertices, in their frames. 36 bytes and 18 flops per pair
/// of vertices.
template <class B>
KOKKOS_INLINE_FUNCTION void filtered(const CoarseInverseMass<B>& filter, int item,
                                     typename B::Real (&y)[1][3 * group_size<B>]) {
  dense_rows<B, 3 * group_size<B>, 1, CoarseInverseMass<B>::block>(
      filter.matrix.data(), item, 3 * filter.vertices, filter.turned.data(), y);
}

/// Response of the coarsest level: acceleration = weight R S R^T force, with R^T force in `turned`.
template <class B>
struct AnswerOfCoarsest {
  using Real = typename B::Real;
  CoarseInverseMass<B> filter;
  Vectors<B> acceleration;
  Real weight;
  KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    Real x[1][3 * group_size<B>];
    filtered(filter, item, x);
    for (int i = 0, a = item * group_size<B>; i < group_size<B> && a < filter.vertices; ++i, ++a)
      set_vector<B>(acceleration, a,
                    weight * (matrix_at<Real>(filter.rotation, a) *
                              Vec3<Real>{x[0][3 * i], x[0][3 * i + 1], x[0][3 * i + 2]}));
  }
};

}  // namespace plica
