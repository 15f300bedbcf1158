// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/core/small.hpp>
#include <plica/kernels/reduce.hpp>

// A free body's rigid motion, taken out of the inverse mass and answered exactly: linear and angular momentum then change by
// nothing but the forces' sum and moment, whatever A is.
namespace plica {

/// About the body's centre as it is now, in double.
struct RigidFrame {
  double mass, centre[3];
  double turning[9];                ///< inverse of the inertia [1/(kg m^2)]
  double linear[3], angular[3];     ///< the forces' rigid acceleration [m/s^2], [rad/s^2]
  double left[3], left_turning[3];  ///< what the inverse mass's answer lacks to it
};

template <class B>
using RigidFrameOf = Kokkos::View<RigidFrame, typename B::Memory>;
template <class B>
using Totals = Kokkos::View<double*, typename B::Memory>;

KOKKOS_INLINE_FUNCTION Vec3<double> vector_of(const double* x) { return {x[0], x[1], x[2]}; }
KOKKOS_INLINE_FUNCTION Vec3<double> turned_by(const double* A, const Vec3<double>& x) {
  return {dot(vector_of(A), x), dot(vector_of(A + 3), x), dot(vector_of(A + 6), x)};
}

/// m, m x, m x x^T (xx yy zz xy xz yz) about the placed mesh's origin, and the sum and moment of the forces: 16 sums.
template <class B>
struct BodyMoments {
  Scalars<B> mass;
  Vectors<B> rest, u, f;
  KOKKOS_INLINE_FUNCTION Sums<16> operator()(int a) const {
    Vec3<double> x, force;
    for (int k = 0; k < 3; ++k) {
      x[k] = static_cast<double>(rest(a, k)) + static_cast<double>(u(a, k));
      force[k] = static_cast<double>(f(a, k));
    }
    const double m = static_cast<double>(mass(a));
    const Vec3<double> moment = cross(x, force);
    return {{m, m * x[0], m * x[1], m * x[2], m * x[0] * x[0], m * x[1] * x[1], m * x[2] * x[2], m * x[0] * x[1],
             m * x[0] * x[2], m * x[1] * x[2], force[0], force[1], force[2], moment[0], moment[1], moment[2]}};
  }
};

/// Centre, inverse inertia and the rigid acceleration from those sums; a body on one line turns with none about it.
template <class B>
struct SetRigidFrame {
  Totals<B> sums;
  RigidFrameOf<B> frame;
  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    RigidFrame& r = frame();
    const double m = sums(0);
    Vec3<double> c{sums(1) / m, sums(2) / m, sums(3) / m}, F{sums(10), sums(11), sums(12)};
    const double xx = sums(4) - m * c[0] * c[0], yy = sums(5) - m * c[1] * c[1], zz = sums(6) - m * c[2] * c[2],
                 xy = sums(7) - m * c[0] * c[1], xz = sums(8) - m * c[0] * c[2], yz = sums(9) - m * c[1] * c[2];
    const Mat3<double> inertia{Vec3<double>{yy + zz, -xy, -xz}, Vec3<double>{-xy, xx + zz, -yz},
                               Vec3<double>{-xz, -yz, xx + yy}};
    const double det = determinant(inertia), size = trace(inertia);
    const Mat3<double> inverse = (det > 1e-12 * size * size * size ? 1 / det : 0.0) * transpose(cofactor(inertia));
    const Vec3<double> moment = Vec3<double>{sums(13), sums(14), sums(15)} - cross(c, F), angular = inverse * moment;
    r.mass = m;
    for (int k = 0; k < 3; ++k) r.centre[k] = c[k], r.linear[k] = F[k] / m, r.angular[k] = angular[k];
    for (int k = 0; k < 9; ++k) r.turning[k] = inverse[k / 3][k % 3];
  }
};

/// f -= m (its rigid acceleration)
template <class B>
struct TakeRigidForce {
  using Real = typename B::Real;
  Scalars<B> mass;
  Vectors<B> rest, u, f;
  RigidFrameOf<B> frame;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    Vec3<double> x;
    for (int k = 0; k < 3; ++k)
      x[k] = static_cast<double>(rest(a, k)) + static_cast<double>(u(a, k)) - frame().centre[k];
    const Vec3<double> rigid = vector_of(frame().linear) + cross(vector_of(frame().angular), x);
    for (int k = 0; k < 3; ++k) f(a, k) -= mass(a) * static_cast<Real>(rigid[k]);
  }
};

/// m a and its moment about the centre
template <class B>
struct MomentumOfAnswer {
  Scalars<B> mass;
  Vectors<B> rest, u, a;
  RigidFrameOf<B> frame;
  KOKKOS_INLINE_FUNCTION Sums<6> operator()(int i) const {
    Vec3<double> x, p;
    for (int k = 0; k < 3; ++k) {
      x[k] = static_cast<double>(rest(i, k)) + static_cast<double>(u(i, k)) - frame().centre[k];
      p[k] = static_cast<double>(mass(i)) * static_cast<double>(a(i, k));
    }
    const Vec3<double> moment = cross(x, p);
    return {{p[0], p[1], p[2], moment[0], moment[1], moment[2]}};
  }
};

/// What the answer's rigid part lacks to the forces'.
template <class B>
struct SetRigidRest {
  Totals<B> sums;
  RigidFrameOf<B> frame;
  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    RigidFrame& r = frame();
    const Vec3<double> turning = turned_by(r.turning, {sums(3), sums(4), sums(5)});
    for (int k = 0; k < 3; ++k) {
      r.left[k] = r.linear[k] - sums(k) / r.mass;
      r.left_turning[k] = r.angular[k] - turning[k];
    }
  }
};

/// a += that
template <class B>
struct AddRigidRest {
  using Real = typename B::Real;
  Vectors<B> rest, u, a;
  RigidFrameOf<B> frame;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    Vec3<double> x;
    for (int k = 0; k < 3; ++k)
      x[k] = static_cast<double>(rest(i, k)) + static_cast<double>(u(i, k)) - frame().centre[k];
    const Vec3<double> left = vector_of(frame().left) + cross(vector_of(frame().left_turning), x);
    for (int k = 0; k < 3; ++k) a(i, k) += static_cast<Real>(left[k]);
  }
};

}  // namespace plica
