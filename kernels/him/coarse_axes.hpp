// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inverse_mass.hpp>
#include <plica/kernels/him/inverse_mass.hpp>
#include <plica/kernels/vectors.hpp>

// The axes of the coarsest level, and the force that follows from their rotation.
//
// The coarsest level's inverse mass is a matrix S that was made for the body at rest. For a body that has turned it must be
// R S R^T, where R turns each coarse vertex's axes. R comes from the finest mesh's displacements in three steps, each a kernel:
//
//   u  --E-->  u_C  --gradient-->  D of each vertex  --W, polar-->  R of each vertex
//   finest     coarse              deformation gradient,           means, then the nearest rotation
//              vertices            weighed
//
// Because A = A(x) depends on where the body is, the kinetic energy p.A(x)p/2 does, too, and its gradient is a force:
// p' = f - d(p.A p/2)/dx, x' = A p keeps energy and angular momentum. That force goes the same way back, by the transposes:
//
//   p  <--E^T--  g  <--gradient^T--  forces on gradients  <--W^T--  torque on each vertex's axes
//
// With q the coarse momentum and y = b R S R^T q, turning R_a by w changes the energy by w.(y_a x q_a): that is the torque.
// R = polar(G), G = W D, turns by R (tr U 1 - U)^-1 axial(R^T dG), U = R^T G.
//
// The force changes the momentum q that it depends on: TurningAxes::push repeats until it no longer does.
namespace plica {

template <class Real, class View>
KOKKOS_INLINE_FUNCTION Mat3<Real> matrix_at(const View& x, int a) {
  Mat3<Real> A;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) A[i][j] = x(3 * a + i, j);
  return A;
}

template <class Real, class View>
KOKKOS_INLINE_FUNCTION void set_matrix(const View& x, int a, const Mat3<Real>& A) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) x(3 * a + i, j) = A[i][j];
}

/// A row of A times matrices.
template <class B>
KOKKOS_INLINE_FUNCTION Mat3<typename B::Real> row_of_matrices(const SparseRows<B>& A, int row, const Vectors<B>& x) {
  using Real = typename B::Real;
  Real sum[9] = {};
  for (int s = A.first(row); s < A.first(row + 1); ++s) {
    const Real w = A.value(s), *m = x.data() + 9 * A.column(s);
    for (int k = 0; k < 9; ++k) sum[k] += w * m[k];
  }
  return {Vec3<Real>{sum[0], sum[1], sum[2]}, Vec3<Real>{sum[3], sum[4], sum[5]}, Vec3<Real>{sum[6], sum[7], sum[8]}};
}

/// The rotation nearest to A (its polar factor), by Newton's iteration (Higham 1986) scaled to determinant 1, to round-off;
/// where A is turned inside out or flat, `before`, and false.
template <class Real>
KOKKOS_INLINE_FUNCTION bool nearest_rotation(const Mat3<Real>& A, const Mat3<Real>& before, Mat3<Real>& Q) {
  const Real det = determinant(A), size = inner(A, A);
  Q = before;
  if (!(det > Real(1e-3) * size * Kokkos::sqrt(size))) return false;
  Q = (Real(1) / Kokkos::cbrt(det)) * A;
  for (int i = 0; i < 10; ++i) {
    const Mat3<Real> next = Real(0.5) * (Q + (Real(1) / determinant(Q)) * cofactor(Q)), change = next - Q;
    Q = next;
    if (inner(change, change) < Real(1e-14)) break;  // quadratic: the next change is its square
  }
  return true;
}

/// D, [vertices][3][3].
template <class B>
struct CoarseGradients {
  using Real = typename B::Real;
  CoarseAxes<B> axes;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const GradientRows<B>& rows = axes.gradient_of;
    Mat3<Real> D = Mat3<Real>::diagonal(axes.at_rest(a));
    for (int s = rows.first(a); s < rows.first(a + 1); ++s)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) D[i][j] += axes.displacement(rows.column(s), i) * rows.derivative(s, j);
    set_matrix(axes.gradient, a, D);
  }
};

/// R and (tr U 1 - U)^-1. Returns the square of the angle since the last time [rad^2], and 1.
template <class B>
struct TurnAxes {
  using Real = typename B::Real;
  CoarseAxes<B> axes;
  Vectors<B> rotation;
  KOKKOS_INLINE_FUNCTION Sums<2> operator()(int a) const {
    const Mat3<Real> G = row_of_matrices<B>(axes.smoothing, a, axes.gradient), before = matrix_at<Real>(rotation, a);
    Mat3<Real> R, inverse;
    if (nearest_rotation(G, before, R)) {
      Mat3<Real> U = transpose(R) * G;
      U = Real(0.5) * (U + transpose(U));
      const Mat3<Real> Z = Mat3<Real>::diagonal(trace(U)) - U;
      inverse = (Real(1) / determinant(Z)) * cofactor(Z);  // symmetric
    }
    set_matrix(rotation, a, R);
    set_matrix(axes.stiffness, a, inverse);
    return {{static_cast<double>(Kokkos::max(Real(0), Real(3) - inner(R, before))), 1.0}};
  }
};

/// torque = R [h]x, h = (tr U 1 - U)^-1 R^T (q x y), y = weight R x
template <class B>
struct TorqueOnAxes {
  using Real = typename B::Real;
  CoarseAxes<B> axes;
  Vectors<B> rotation, q;
  Scalars<B> x;  ///< S R^T q
  Real weight;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Mat3<Real> R = matrix_at<Real>(rotation, a);
    const Vec3<Real> turned = transpose(R) * Vec3<Real>{q(a, 0), q(a, 1), q(a, 2)};
    const Vec3<Real> h =
        matrix_at<Real>(axes.stiffness, a) * (weight * cross(turned, {x(3 * a), x(3 * a + 1), x(3 * a + 2)}));
    set_matrix(axes.torque, a, R * cross_matrix(h));
  }
};

/// The same of D: through the transpose of W.
template <class B>
struct TorqueOnGradients {
  CoarseAxes<B> axes;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    set_matrix(axes.gradient, a, row_of_matrices<B>(axes.smoothing_of, a, axes.torque));
  }
};

/// g: through the transpose of D(u_C).
template <class B>
struct ForcesOfGradients {
  using Real = typename B::Real;
  CoarseAxes<B> axes;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const GradientRows<B>& rows = axes.gradient_to;
    Vec3<Real> g;
    for (int s = rows.first(a); s < rows.first(a + 1); ++s)
      g = g + matrix_at<Real>(axes.gradient, rows.column(s)) *
                  Vec3<Real>{rows.derivative(s, 0), rows.derivative(s, 1), rows.derivative(s, 2)};
    set_vector<B>(axes.force, a, g);
  }
};

/// The coarse momentum with that force in it, towards what it itself depends on. Returns the squares of its change, of the
/// force's whole share and of all of it.
template <class B>
struct NextMomentum {
  using Real = typename B::Real;
  SparseRows<B> response;
  Vectors<B> force, given, share;  ///< g; without it; what it adds
  Vectors<B> q;                    ///< their sum
  Doubles<B> open;
  Real t;
  KOKKOS_INLINE_FUNCTION Sums<3> operator()(int a) const {
    Sums<3> sums;
    if (!(open(0) > 0)) return sums;
    const Vec3<Real> answer = row_product<B>(response, a, force);
    for (int k = 0; k < 3; ++k) {
      const Real next = t * answer[k], change = next - share(a, k);
      sums[0] += static_cast<double>(change) * static_cast<double>(change);
      sums[1] += static_cast<double>(next) * static_cast<double>(next);
      share(a, k) = next, q(a, k) = given(a, k) + next;
      sums[2] += static_cast<double>(q(a, k)) * static_cast<double>(q(a, k));
    }
    return sums;
  }
};

/// Whether to go on: the change over the share while that is more than `tolerance`, and the change more than `least` of all.
template <class B>
struct DecideToGoOn {
  Doubles<B> sums, open;
  double tolerance, least;
  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    const bool matters = sums(0) > least * least * sums(2);
    const double change = matters ? Kokkos::sqrt(sums(0) / sums(1)) : 0.0;
    if (open(0) > 0) open(0) = change > tolerance ? change : 0.0;
  }
};

/// p += t E^T g, of vertices that forces move.
template <class B>
struct PushByAxes {
  using Real = typename B::Real;
  SparseRows<B> spread;
  Scalars<B> inverse_mass;
  Vectors<B> force, p;
  Real t;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    if (!(inverse_mass(a) > 0)) return;
    const Vec3<Real> f = row_product<B>(spread, a, force);
    for (int k = 0; k < 3; ++k) p(a, k) += t * f[k];
  }
};

/// The same, and the finest level's answer to p.
template <class B>
struct AnswerOfPushed {
  PushByAxes<B> push;
  AnswerOfFinest<B> answer;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const { push(a), answer(a); }
};

/// A middle level's share of that: += t Pi^T E^T g.
template <class B>
struct AddShareOfAxes {
  using Real = typename B::Real;
  SparseRows<B> response;
  Vectors<B> force, momentum;
  Real t;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    set_vector<B>(momentum, a, vector_at<B>(momentum, a) + t * row_product<B>(response, a, force));
  }
};

}  // namespace plica
