// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inlining.hpp>
#include <plica/core/inverse_mass.hpp>
#include <plica/kernels/him/inverse_mass.hpp>
#include <plica/kernels/vectors.hpp>

// Frames of the coarsest level, and the force that follows from their rotation.
//
// The coarsest level's inverse mass is a matrix S that was made for the body at rest. For a body
// that has turned it must be R S R^T, where R turns the frame of each coarse vertex. R comes from
// the finest mesh's displacements in three steps, the last two in one kernel:
//
//   u  --E-->  u_C  --gradient-->  G of each vertex      --polar-->  R of each vertex
//   finest     coarse              deformation gradient,             the nearest rotation
//              vertices            mean over its surroundings
//
// A = A(x) depends on where the body is, and so does the kinetic energy p.A(x)p/2. Its gradient is
// the force of frames: p' = f - d(p.A p/2)/dx, x' = A p keeps energy and angular momentum. That
// force goes the same way back, by the transposes:
//
//   p  <--E^T--  g  <--gradient^T--  torque on each vertex's frame
//
// With q the coarse momentum and y = b R S R^T q, a turn of R_a by w changes the energy by w.(y_a x
// q_a), which gives the torque. R = polar(G) turns by R (tr U 1 - U)^-1 axial(R^T dG), U = R^T G.
//
// The force changes the momentum q that it depends on: CoarseFrames::find_torques repeats until q
// has converged. From the torques to what they add to q all is linear and constant, so that one
// matrix does it; the force itself is needed only once.
namespace plica {

template <class Real, class View>
KOKKOS_INLINE_FUNCTION void set_matrix(const View& x, int a, const Mat3<Real>& A) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) x(3 * a + i, j) = A[i][j];
}

/// Computes `values` numbers for each vertex of a work item, by a matrix of FrameFields.
template <class B, int values, class Matrix>
KOKKOS_INLINE_FUNCTION void group_rows(const Matrix& matrix, int item, int columns,
                                       const Vectors<B>& x,
                                       typename B::Real (&y)[values][group_size<B>]) {
  dense_rows<B, group_size<B>, values, CoarseInverseMass<B>::group>(matrix.data(), item, columns,
                                                                    x.data(), y);
}

/// Computes the rotation Q nearest to A (its polar factor) by Newton's iteration (Higham 1986). The
/// iteration is scaled to determinant 1 and ends at round-off. Where A is inverted or flat, Q is
/// `before`, and the result is false.
template <class Real>
KOKKOS_INLINE_FUNCTION bool nearest_rotation(const Mat3<Real>& A, const Mat3<Real>& before,
                                             Mat3<Real>& Q) {
  const Real det = determinant(A), size = inner(A, A);
  Q = before;
  if (!(det > Real(1e-3) * size * Kokkos::sqrt(size))) return false;
  Q = (Real(1) / Kokkos::cbrt(det)) * A;
  for (int i = 0; i < 10; ++i) {
    const Mat3<Real> next = Real(0.5) * (Q + (Real(1) / determinant(Q)) * cofactor(Q)),
                     change = next - Q;
    Q = next;
    if (inner(change, change) < Real(1e-14)) break;  // quadratic: the next change is its square
  }
  return true;
}

/// Computes R and (tr U 1 - U)^-1 from u_C. Per work item it sums up the squares of the angles
/// since the last call.
template <class B>
struct TurnFrames {
  using Real = typename B::Real;
  FrameFields<B> frames;
  Vectors<B> rotation;
  KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const int n = static_cast<int>(frames.at_rest.extent(0)), first = item * group_size<B>;
    Real derivative[3][3][group_size<B>];
    for (int j = 0; j < 3; ++j)
      group_rows<B, 3>(frames.gradient_of[j], item, n, frames.displacement, derivative[j]);
    double sum = 0;
    for (int i = 0; i < group_size<B> && first + i < n; ++i) {
      Mat3<Real> G;
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
          G[k][j] = derivative[j][k][i] + (k == j ? frames.at_rest(first + i) : Real(0));
      sum += static_cast<double>(turn(first + i, G));
    }
    frames.angles(item) = sum;
  }
  KOKKOS_INLINE_FUNCTION Real turn(int a, const Mat3<Real>& G) const {
    const Mat3<Real> before = matrix_at<Real>(rotation, a);
    Mat3<Real> R, inverse;
    if (nearest_rotation(G, before, R)) {
      Mat3<Real> U = transpose(R) * G;
      U = Real(0.5) * (U + transpose(U));
      const Mat3<Real> Z = Mat3<Real>::diagonal(trace(U)) - U;
      inverse = (Real(1) / determinant(Z)) * cofactor(Z);  // symmetric
    }
    set_matrix(rotation, a, R);
    set_matrix(frames.stiffness, a, inverse);
    return Kokkos::max(Real(0), Real(3) - inner(R, before));
  }
};

/// Momentum of the coarsest level, and what the force of frames adds to it.
template <class B>
struct CoarseMomentum {
  Vectors<B> given;  ///< momentum without the force of frames
  Vectors<B> share;  ///< momentum that the force of frames adds
};

/// Computes R^T q, q = given + share.
template <class B>
struct StartMomentum {
  CoarseInverseMass<B> filter;
  CoarseMomentum<B> momentum;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    turn_force(filter, a, vector_at<B>(momentum.given, a) + vector_at<B>(momentum.share, a));
  }
};

/// Sums of a round of the search for the force of frames. They are the squares of the change of its
/// share, of the share and of all the momentum, added up by every work item for itself. Rounds
/// after one that changed little do nothing, and leave sums of 0.
template <class B>
struct FrameRound {
  static constexpr double tolerance = 1e-3, least = 1e-6;
  /// [groups]; empty before the first round
  Kokkos::View<double* [3], Kokkos::LayoutRight, typename B::Memory> sums;
  /// Returns the change divided by the share. It is 0 where that is within `tolerance`, or the
  /// change within `least` of all the momentum.
  KOKKOS_INLINE_FUNCTION double change() const {
    const int groups = static_cast<int>(sums.extent(0));
    if (groups == 0) return 1;
    double change = 0, share = 0, all = 0;
    for (int i = 0; i < groups; ++i) change += sums(i, 0), share += sums(i, 1), all += sums(i, 2);
    const double part = change > least * least * all ? Kokkos::sqrt(change / share) : 0.0;
    return part > tolerance ? part : 0.0;
  }
  KOKKOS_INLINE_FUNCTION bool goes_on() const { return change() > 0; }
};

/// Computes torque = R [h]x, h = (tr U 1 - U)^-1 R^T (q x y), y = weight R S R^T q.
template <class B>
struct TorqueOnFrames {
  using Real = typename B::Real;
  FrameFields<B> frames;
  CoarseInverseMass<B> filter;
  FrameRound<B> last;
  Real weight;
  KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    if (!last.goes_on()) return;
    Real x[1][3 * group_size<B>];
    filtered(filter, item, x);
    for (int i = 0, a = item * group_size<B>; i < group_size<B> && a < filter.vertices; ++i, ++a) {
      const Vec3<Real> answer{x[0][3 * i], x[0][3 * i + 1], x[0][3 * i + 2]};
      const Vec3<Real> h = matrix_at<Real>(frames.stiffness, a) *
                           (weight * cross(vector_at<B>(filter.turned, a), answer));
      set_matrix(frames.torque, a,
                 transpose(matrix_at<Real>(filter.rotation, a) * cross_matrix(h)));
    }
  }
};

/// Computes the share that follows from the torques, and R^T q, on which the next torques depend.
template <class B>
struct NextMomentum {
  using Real = typename B::Real;
  FrameFields<B> frames;
  CoarseInverseMass<B> filter;
  CoarseMomentum<B> momentum;
  FrameRound<B> last, now;
  Real t;
  KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    double sums[3] = {};
    if (last.goes_on()) {
      Real added[3][group_size<B>];
      group_rows<B, 3>(frames.response, item, 3 * filter.vertices, frames.torque, added);
      for (int i = 0, a = item * group_size<B>; i < group_size<B> && a < filter.vertices;
           ++i, ++a) {
        const Vec3<Real> next = t * Vec3<Real>{added[0][i], added[1][i], added[2][i]},
                         change = next - vector_at<B>(momentum.share, a),
                         q = vector_at<B>(momentum.given, a) + next;
        set_vector<B>(momentum.share, a, next);
        turn_force(filter, a, q);
        sums[0] += static_cast<double>(dot(change, change)),
            sums[1] += static_cast<double>(dot(next, next));
        sums[2] += static_cast<double>(dot(q, q));
      }
    }
    for (int k = 0; k < 3; ++k) now.sums(item, k) = sums[k];
  }
};

/// Computes the force g of the torques.
template <class B>
struct ForceOfTorques {
  using Real = typename B::Real;
  FrameFields<B> frames;
  KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const int n = static_cast<int>(frames.force.extent(0)), first = item * group_size<B>;
    Real g[3][group_size<B>];
    group_rows<B, 3>(frames.force_of, item, 3 * n, frames.torque, g);
    for (int i = 0; i < group_size<B> && first + i < n; ++i)
      set_vector<B>(frames.force, first + i, {g[0][i], g[1][i], g[2][i]});
  }
};

/// Computes the force of the torques and the coarsest level's response to the momenta in one
/// launch: neither needs the other.
template <class B>
struct ForceAndAnswer {
  ForceOfTorques<B> force;
  AnswerOfCoarsest<B> answer;
  KOKKOS_INLINE_FUNCTION void operator()(int item) const { force(item), answer(item); }
};

/// Adds t E^T g to p of vertices that forces move, and to q, where there is one. Returns p.
template <class B>
struct PushByFrames {
  using Real = typename B::Real;
  SparseRows<B> spread;
  Scalars<B> inverse_mass;
  Vectors<B> force, p, q;
  Real t;
  KOKKOS_INLINE_FUNCTION Vec3<Real> operator()(int a) const {
    const Vec3<Real> before = vector_at<B>(p, a);
    if (!(inverse_mass(a) > 0)) return before;
    const Vec3<Real> push = t * row_product<B>(spread, a, force), pushed = before + push;
    set_vector<B>(p, a, pushed);
    if (q.extent(0) > 0) set_vector<B>(q, a, vector_at<B>(q, a) + push);
    return pushed;
  }
};

/// Adds the force of frames to p, and computes the finest level's response to p.
template <class B>
struct AnswerOfPushed {
  PushByFrames<B> push;
  AnswerOfFinest<B> answer;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    set_vector<B>(answer.acceleration, a, answer.of(a, push(a)));
  }
};

/// Adds the force of frames to p, and computes the mean acceleration that follows.
template <class B>
struct AccelerationOfPushed {
  AnswerOfPushed<B> pushed;
  MeanAcceleration<B> mean;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    mean.set(a, pushed.answer.of(a, pushed.push(a)));
  }
};

/// Adds a middle level's share of the force of frames to its momentum: t Pi^T E^T g.
template <class B>
struct AddShareOfFrames {
  using Real = typename B::Real;
  SparseRows<B, float> response;
  Vectors<B> force, momentum;
  Real t;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    set_vector<B>(momentum, a, vector_at<B>(momentum, a) + t * row_product<B>(response, a, force));
  }
};

}  // namespace plica
