// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/core/transfer.hpp>
#include <plica/kernels/contact/concavity.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>
#include <plica/kernels/contact/gap.hpp>
#include <plica/kernels/contact/penalty.hpp>
#include <plica/kernels/exchange.hpp>
#include <plica/kernels/reduce.hpp>

// Penalty contact and friction, implicit in the acceleration of the step h that they act in, so that their stiffness does not bound
// that step. Per point and obstacle, with the depth d and the velocity v against the obstacle at the state, N out of the obstacle, e
// the point's acceleration without contact, r that by contact:
//   normal      n = k (d - ahead N.v - h^2/2 N.(e + r)) - c N.(v + h/2 (e + r)), never pulling
//   tangential  q = -c_t (v + h (e + r)) across N, at most friction times n
// solved by sweeps of projected Jacobi from 0. Points are coupled by A, the inverse mass: r = W A W^T n. The relaxation of a point
// is that of rho, the sum of its row of W A W^T over the touching points: exact for an even pressure, and never too much. Weights of points
// outside the mesh are not all positive: rho then takes their absolute values.
//
//   points                                    vertices
//   1. unit force on each that touches  --W^T-->  f  --A-->  a  --W-->  r: gives rho
//   2. forces from e and the last r     --W^T-->  f  --A-->  a  --W-->  r      once for every sweep
//
// A pair is a point and the triangle it touches: W takes the point's value less the triangle's where it is nearest, and the triangle's
// corners get the opposite of the point's force by the same weights. Or it is two edges, likewise. Then rho sums up absolute values,
// which bounds the row's sum.
//
// A point that an obstacle or another body holds has, in place of these two, the force in all directions that takes it back by its
// stretch s:
//   -k (s + ahead v + h^2/2 (e + r)) - c (v + h/2 (e + r))
//
// W takes values from vertices to points (value_at), its transpose forces from points to vertices (ScatterToVertices). Why no number
// of sweeps takes stability away is in cmake/docs/contact.md.
namespace plica {

/// Depth, normal and velocity of every point near this obstacle.
template <class B, class Shape>
struct FindTouching {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  State<B> state;
  Shape shape;
  ObstaclePlace<B> place;
  DepthWatch<B> watch;
  int first;  ///< its first record
  TouchingPoints<B> points;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    const Vec3<Real> x = value_at<B>(surface.embedding, state.u, p, vector_at<B>(surface.rest, p));
    const Vec3<Real> speed = value_at<B>(surface.embedding, state.v, p) - place.velocity(x);
    Gap<Real> gap = gap_along(shape, place.local(x), place.inward(points.span * speed), points.reach);
    const Vec3<Real> local_normal = gap.normal;
    gap.normal = place.outward(gap.normal);
    watch.look(p, gap.distance);
    const int r = first + p;
    const bool near = gap.distance < points.reach || gap.distance + points.span * dot(gap.normal, speed) < 0;
    points.depth(r) = -gap.distance, points.mobility(r) = near ? Real(1) : Real(0);
    if constexpr (!Shape::convex)
      if (points.concavity.extent(0) > 0) {
        const bool bends = gap.distance + points.span * dot(gap.normal, speed) < points.edge && !place.is_turning();
        set_block<B>(
            points.concavity, r,
            bends ? concavity<B>(shape, place, place.local(x), local_normal, points.edge / 4) : SymMat3<Real>{});
      }
    if (!near) return;
    set_vector<B>(points.normal, r, gap.normal);
    set_vector<B>(points.velocity, r, speed);
  }
};

/// An obstacle takes hold of every point that is no further than `reach` from it; after FindTouching. What it holds stays as it is.
template <class B>
struct TakeHold {
  EmbeddedSurface<B> surface;
  Vectors<B> u;
  ObstaclePlace<B> place;
  TouchingPoints<B> points;
  int obstacle;
  typename B::Real reach;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    const int r = points.record(obstacle, p);
    if (points.held.holds(r) || !points.held.may_hold(r) || !(-points.depth(r) <= reach)) return;
    const auto x = points.place(surface, u, obstacle, p);
    points.held.hold(r, x, place.way(x));
  }
};

/// It lets them go.
template <class B>
struct LetGo {
  HeldPoints<B> held;
  int first;  ///< its first record
  KOKKOS_INLINE_FUNCTION void operator()(int p) const { held.release(first + p); }
};

/// The records of points that an obstacle holds, in place of what FindTouching found.
template <class B>
struct StretchHeld {
  EmbeddedSurface<B> surface;
  State<B> state;
  ObstaclePlace<B> place;
  TouchingPoints<B> points;
  int obstacle;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    const int r = points.record(obstacle, p);
    if (!points.held.holds(r)) return;
    points.mobility(r) = 1;
    const auto x = points.place(surface, state.u, obstacle, p);
    set_vector<B>(points.normal, r, place.outward(points.held.stretch(r, x, place.way(x))));
    set_vector<B>(points.velocity, r, value_at<B>(surface.embedding, state.v, p) - place.velocity(x));
  }
};

/// What the sweeps need of a step.
template <class B>
struct TouchLaw {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  TouchingPoints<B> points;
  Vectors<B> smooth, answer;  ///< accelerations without contact, and by the last contact forces [m/s^2]
  Real h, ahead, entry;
  bool by_work;    ///< see ContactByWork; `ahead` is h/2
  bool isotropic;  ///< A answers a force of any direction alike: unit forces of one direction bound all rows of W A W^T

  KOKKOS_INLINE_FUNCTION Vec3<Real> at(const Vectors<B>& x, int row, int p, bool bounding = false) const {
    return points.difference(surface, x, row, p, bounding);
  }
  KOKKOS_INLINE_FUNCTION Vec3<Real> normal(int r) const { return vector_at<B>(points.normal, r); }
  /// Whether the force is that of the work between two depths; see ContactByWork. A face's deepest place is another one in every step: with
  /// the mean of two depths, or with their work, it would gain energy by that. It goes by the depth after the step, which loses some.
  KOKKOS_INLINE_FUNCTION bool goes_by_work(int r) const { return by_work && !points.is_on_face(r); }
  /// What is outside comes in within the step.
  KOKKOS_INLINE_FUNCTION Real looks_ahead(int r) const {
    return points.depth(r) > 0 && !points.is_on_face(r) ? ahead : Kokkos::max(ahead, entry);
  }
  /// What an acceleration adds to the position that the law goes by [s^2].
  KOKKOS_INLINE_FUNCTION Real weight(int r) const { return Real(0.5) * h * (by_work ? h : h + looks_ahead(r)); }
  /// The depth that the law goes by, for an acceleration at the point.
  KOKKOS_INLINE_FUNCTION Real depth(int r, const Vec3<Real>& e) const {
    const Vec3<Real> N = normal(r), v = vector_at<B>(points.velocity, r);
    return points.depth(r) - looks_ahead(r) * dot(N, v) - weight(r) * dot(N, e);
  }
  /// n for that acceleration
  KOKKOS_INLINE_FUNCTION Real pressure(const PenaltyLaw<Real>& law, int r, const Vec3<Real>& e) const {
    const Vec3<Real> v = vector_at<B>(points.velocity, r);
    return law.stiffness * depth(r, e) - law.damping * dot(normal(r), v + Real(0.5) * h * e);
  }
  /// Between the depths half a step before the state and half a step after it, which is depth().
  KOKKOS_INLINE_FUNCTION ContactByWork<Real> work(const PenaltyLaw<Real>& of, int r) const {
    const Vec3<Real> v = vector_at<B>(points.velocity, r);
    return {of.stiffness, of.damping / h, points.depth(r) + Real(0.5) * h * dot(normal(r), v)};
  }
  /// q for that acceleration, before its bound
  KOKKOS_INLINE_FUNCTION Vec3<Real> drag(const PenaltyLaw<Real>& law, int r, const Vec3<Real>& e) const {
    const Vec3<Real> N = normal(r), v = vector_at<B>(points.velocity, r) + h * e;
    return -law.tangential * (v - dot(v, N) * N);
  }
  /// How far ahead a stretch is taken [s], and what an acceleration adds to it [s^2].
  KOKKOS_INLINE_FUNCTION Real stretched_ahead() const { return by_work ? Real(0) : ahead; }
  KOKKOS_INLINE_FUNCTION Real stretching() const { return Real(0.5) * h * (h + stretched_ahead()); }
  /// The force on a held point for that acceleration.
  KOKKOS_INLINE_FUNCTION Vec3<Real> pull(const PenaltyLaw<Real>& law, int r, const Vec3<Real>& e) const {
    const Vec3<Real> stretch = vector_at<B>(points.normal, r), v = vector_at<B>(points.velocity, r);
    return -law.stiffness * (stretch + stretched_ahead() * v + stretching() * e) -
           law.damping * (v + Real(0.5) * h * e);
  }
  /// The unit force that finds rho of a held point, whose force may have any direction: no less than 1/sqrt 3 of the largest.
  KOKKOS_INLINE_FUNCTION Vec3<Real> any_direction() const {
    if (isotropic) return {Real(1), Real(0), Real(0)};
    const Real part = Real(0.57735027);
    return {part, part, part};
  }
};

/// A unit force on every site that would be inside an obstacle; counts them.
template <class B>
struct StartTouching {
  using Real = typename B::Real;
  TouchLaw<B> law;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int p) const {
    const TouchingPoints<B>& points = law.points;
    double count = 0;
    for (int row = 0; row < points.rows_of(p); ++row) {
      const int r = points.record(row, p);
      const bool near = points.near(r);
      points.mobility(r) = 0;
      Vec3<Real> unit, e;
      if (near) set_vector<B>(points.smooth, r, e = law.at(law.smooth, row, p));
      if (near && points.is_held(row, p)) {
        unit = law.any_direction();
        count += 1;
      } else if (near) {
        const PenaltyLaw<Real> of = points.law_of(row, p);
        const Real depth = law.depth(r, e);
        if (law.goes_by_work(r) ? law.work(of, r).force(depth) > 0 : depth > 0 && law.pressure(of, r, e) > 0) {
          unit = law.isotropic ? Vec3<Real>{Real(1), Real(0), Real(0)} : law.normal(r);
          count += 1;
        }
      }
      set_vector<B>(points.force, r, unit);
    }
    return {{count}};
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
    for (int row = 0; row < points.rows_of(p); ++row) {
      const int r = points.record(row, p);
      const Vec3<Real> force = vector_at<B>(points.force, r);
      if (!(first ? dot(force, force) > 0 : points.mobility(r) > 0)) continue;
      const Vec3<Real> answer = law.at(law.answer, row, p, first && (law.isotropic || row < points.obstacles));
      Vec3<Real> e = vector_at<B>(points.smooth, r);
      if (first) {
        constexpr Real smallest = Kokkos::Experimental::norm_min_v<Real>;
        points.mobility(r) = Kokkos::max(Kokkos::sqrt(dot(answer, answer)), smallest);
      } else {
        e += answer;
      }
      if (points.is_held(row, p))
        hold(points.spring_of(row, p), r, first ? Vec3<Real>{} : force, e);
      else
        sweep(points.law_of(row, p), r, first ? Vec3<Real>{} : force, e);
    }
  }

  KOKKOS_INLINE_FUNCTION void hold(const PenaltyLaw<Real>& of, int r, const Vec3<Real>& force,
                                   const Vec3<Real>& e) const {
    const Real stiff = law.stretching() * of.stiffness + Real(0.5) * law.h * of.damping;
    set_vector<B>(law.points.force, r,
                  force + (1 / (1 + stiff * law.points.mobility(r))) * (law.pull(of, r, e) - force));
  }

  KOKKOS_INLINE_FUNCTION void sweep(const PenaltyLaw<Real>& of, int r, const Vec3<Real>& force,
                                    const Vec3<Real>& e) const {
    const Vec3<Real> N = law.normal(r);
    const Real rho = law.points.mobility(r), h = law.h, before = dot(force, N);
    Real pressure = 0;
    if (law.goes_by_work(r)) {
      const Real g = law.weight(r) * rho;
      pressure = law.work(of, r).solve(law.depth(r, e) + g * before, g);
    } else {
      const Real stiff = law.weight(r) * of.stiffness + Real(0.5) * h * of.damping;
      pressure = Kokkos::max(Real(0), before + (law.pressure(of, r, e) - before) / (1 + stiff * rho));
    }
    Vec3<Real> across = force - before * N;
    across += (1 / (1 + h * of.tangential * rho)) * (law.drag(of, r, e) - across);
    const Real size = Kokkos::sqrt(dot(across, across)), most = of.friction * pressure;
    if (size > most) across = (most / size) * across;
    set_vector<B>(law.points.force, r, pressure * N + across);
  }
};

// Where A is the lumped masses' inverse. Contact acts on the vertices whose tetrahedra hold a point, and on no other.

/// What mass damping leaves of an acceleration; see ContactStep.
template <class B>
KOKKOS_INLINE_FUNCTION typename B::Real kept(const VertexModel<B>& model, int a, typename B::Real damped) {
  return 1 / (1 + damped * model.damping(a));
}

/// e = (f/m - c v) / (1 + damped c); 0 where the motion is given.
template <class B>
struct FreeAcceleration {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  VertexModel<B> model;
  Vectors<B> f, v, e;
  Real damped;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int a = surface.vertex(i);
    const Real w = model.inverse_mass(a), c = model.damping(a), part = w > 0 ? kept<B>(model, a, damped) : Real(0);
    for (int k = 0; k < 3; ++k) e(a, k) = part * (w * f(a, k) - c * v(a, k));
  }
};

/// answer = m^-1 W^T force / (1 + damped c). The first answers the unit forces, and finds the vertices that contact reaches; the others
/// have 0 from then on.
template <class B>
struct AnswerByMass {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  VertexModel<B> model;
  TouchingPoints<B> points;
  Vectors<B> answer;
  Indices<B> reached;  ///< [touched] 1 or 0
  Real damped;
  bool first;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    if (!first && reached(i) == 0) return;
    const int a = surface.vertex(i);
    const Vec3<Real> force = points.force_on(surface, i, first);
    if (first) reached(i) = force[0] > 0 ? 1 : 0;  // of parts that are all along x
    set_vector<B>(answer, a, (model.inverse_mass(a) * kept<B>(model, a, damped)) * force);
  }
};

}  // namespace plica
