// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/core/surface.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>
#include <plica/kernels/exchange.hpp>
#include <plica/kernels/reduce.hpp>

// Penalty contact and friction of a step t of the hierarchical inverse mass, implicit in the step's own acceleration: what an
// explicit penalty force is far too stiff when it acts through A. Per point, with the depth d and the velocity v at the state, N out
// of the obstacle, e the point's acceleration without contact, r that by contact:
//   normal      n = k (d - t^2/2 N.(e + r)) - c N.(v + t/2 (e + r)), never pulling
//   tangential  q = -c_t (v + t/2 (e + r)) across N, at most friction times n
// solved by two sweeps of projected Jacobi, preconditioned by rho = N . (acceleration by a unit force on every touching point).
// Points are coupled only by A, the inverse mass of the whole body, which is applied three times.
//
//   points                                    vertices
//   1. unit force on each that touches  --W^T-->  f  --A-->  a  --W-->  r: gives rho
//   2. first forces, from e alone       --W^T-->  f  --A-->  a  --W-->  r
//   3. forces corrected by r            --W^T-->  f  --A-->  a: the accelerations by contact
//
// W takes values from vertices to points (value_at), its transpose forces from points to vertices (ScatterToVertices).
namespace plica {

/// The nearest obstacle of every surface point, and the contact with it.
template <class B>
struct TouchingPoints {
  Vectors<B> normal;      ///< [points][3] out of the obstacle
  Vectors<B> velocity;    ///< relative to it [m/s]
  Scalars<B> depth;       ///< > 0 inside [m]
  Scalars<B> tangential;  ///< its c_t [N s/m]
  Scalars<B> friction;    ///< its coefficient
  Scalars<B> mobility;    ///< rho [1/kg]
  Vectors<B> force;       ///< on the point [N]
  Doubles<B> count;       ///< [1] that touch
};

/// Depth, normal and velocity where this obstacle is nearer than those before it.
template <class B, class Shape>
struct FindTouching {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  State<B> state;
  Shape shape;
  Vec3<Real> offset, velocity;  ///< of the obstacle
  PenaltyLaw<Real> law;
  DepthWatch<B> watch;
  bool first;
  TouchingPoints<B> points;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    Vec3<Real> x, speed;
    surface_point(surface, state.u, state.v, p, x, speed);
    const Gap<Real> gap = shape(x - offset);
    watch.look(p, gap.distance);
    if (!first && -gap.distance <= points.depth(p)) return;
    points.depth(p) = -gap.distance, points.tangential(p) = law.tangential, points.friction(p) = law.friction;
    for (int k = 0; k < 3; ++k) points.normal(p, k) = gap.normal[k], points.velocity(p, k) = speed[k] - velocity[k];
  }
};

/// What the sweeps need of a step.
template <class B>
struct TouchLaw {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  TouchingPoints<B> points;
  Vectors<B> smooth, answer;  ///< accelerations without contact, and by the last contact forces [m/s^2]
  Real t, stiffness, damping;

  KOKKOS_INLINE_FUNCTION Vec3<Real> at(const Vectors<B>& x, int p) const {
    return value_at<B>(surface.embedding, x, p);
  }
  KOKKOS_INLINE_FUNCTION Vec3<Real> normal(int p) const { return vector_at<B>(points.normal, p); }
  /// n for an acceleration at the point
  KOKKOS_INLINE_FUNCTION Real pressure(int p, const Vec3<Real>& e) const {
    const Vec3<Real> N = normal(p), v = vector_at<B>(points.velocity, p);
    return stiffness * (points.depth(p) - Real(0.5) * t * t * dot(N, e)) - damping * dot(N, v + Real(0.5) * t * e);
  }
  /// q for an acceleration, before its bound
  KOKKOS_INLINE_FUNCTION Vec3<Real> drag(int p, const Vec3<Real>& e) const {
    const Vec3<Real> N = normal(p);
    Vec3<Real> v = vector_at<B>(points.velocity, p);
    v += Real(0.5) * t * e;
    return -points.tangential(p) * (v - dot(v, N) * N);
  }
};

/// A unit force out of the obstacle on every point that would be inside it; counts them.
template <class B>
struct StartTouching {
  TouchLaw<B> law;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int p) const {
    const auto e = law.at(law.smooth, p), N = law.normal(p);
    const typename B::Real depth = law.points.depth(p) - typename B::Real(0.5) * law.t * law.t * dot(N, e);
    const bool touches = depth > 0 && law.pressure(p, e) > 0;
    set_vector<B>(law.points.force, p, touches ? N : Vec3<typename B::Real>{});
    law.points.mobility(p) = 0;
    return {{touches ? 1.0 : 0.0}};
  }
};

/// One sweep; the first finds the answer to the unit forces and none to the contact's.
template <class B>
struct SweepTouching {
  using Real = typename B::Real;
  TouchLaw<B> law;
  bool first;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    const TouchingPoints<B>& points = law.points;
    Vec3<Real> force = vector_at<B>(points.force, p);
    const Vec3<Real> N = law.normal(p), r = law.at(law.answer, p);
    if (first) {
      if (!(dot(force, force) > 0)) return;
      points.mobility(p) = Kokkos::max(dot(N, r), Real(0));
      force = {};
    } else if (!(points.mobility(p) > 0)) {
      return;
    }
    const Vec3<Real> e = first ? law.at(law.smooth, p) : law.at(law.smooth, p) + r;
    const Real rho = points.mobility(p), half = Real(0.5) * law.t, before = dot(force, N);
    const Real stiff = half * (law.t * law.stiffness + law.damping);
    const Real pressure = Kokkos::max(Real(0), before + (law.pressure(p, e) - before) / (1 + stiff * rho));
    Vec3<Real> across = force - before * N;
    across += (1 / (1 + half * points.tangential(p) * rho)) * (law.drag(p, e) - across);
    const Real size = Kokkos::sqrt(dot(across, across)), most = points.friction(p) * pressure;
    if (size > most) across = (most / size) * across;
    set_vector<B>(law.points.force, p, pressure * N + across);
  }
};

}  // namespace plica
