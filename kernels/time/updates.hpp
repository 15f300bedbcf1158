// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/contact_records.hpp>
#include <plica/kernels/vectors.hpp>

// Vertex updates of the explicit integrators, h the sub-step [s], c the mass damping [1/s], a =
// f/m. Where the motion is given, a is 0 and prescribe() replaces the result. Undamped, each update
// moves 12 s bytes in and 6 s out per vertex, s = sizeof(Real).
namespace plica {

/// Symplectic Euler: v += h a, damped implicitly, v = (v + h a)/(1 + h c); then u += h v. It is
/// second-order in the velocity's staggered sense and symplectic for c = 0 (Hairer, Lubich &
/// Wanner, Geometric Numerical Integration, I.1.2).
template <class B>
struct SymplecticEulerUpdate {
  static constexpr const char* label = "plica::symplectic_euler";
  static ContactStep contact(double h) { return {.span = h, .damped = h}; }
  using Real = typename B::Real;
  VertexModel<B> model;
  Vectors<B> f, u, v;
  Real h;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Real w = h * model.inverse_mass(a),
               keep = w > 0 ? 1 / (1 + h * model.damping(a)) : Real(1);
    const Vec3<Real> speed = keep * (vector_at<B>(v, a) + w * vector_at<B>(f, a)),
                     at = vector_at<B>(u, a);
    set_vector<B>(v, a, speed), set_vector<B>(u, a, at + h * speed);
  }
};

/// First half of a central-difference step: v += h (a - c v), h half a step; then u += 2 h v.
template <class B>
struct HalfKickAndDrift {
  using Real = typename B::Real;
  VertexModel<B> model;
  Vectors<B> f;
  State<B> state;
  Real h;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Real w = h * model.inverse_mass(a), c = w > 0 ? h * model.damping(a) : Real(0);
    const Vec3<Real> before = vector_at<B>(state.v, a),
                     speed = before + w * vector_at<B>(f, a) - c * before,
                     at = vector_at<B>(state.u, a);
    set_vector<B>(state.v, a, speed), set_vector<B>(state.u, a, at + 2 * h * speed);
  }
};

/// Second half of a central-difference step: v = (v + h a)/(1 + h c), h half a step.
template <class B>
struct HalfKick {
  using Real = typename B::Real;
  VertexModel<B> model;
  Vectors<B> f, v;
  Real h;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Real w = h * model.inverse_mass(a),
               keep = w > 0 ? 1 / (1 + h * model.damping(a)) : Real(1);
    set_vector<B>(v, a, keep * (vector_at<B>(v, a) + w * vector_at<B>(f, a)));
  }
};

/// Forward Euler: u += h v with the old v; v += h (a - c v).
template <class B>
struct ForwardEulerUpdate {
  static constexpr const char* label = "plica::euler";
  static ContactStep contact(double h) { return {.span = h, .ahead = h}; }
  using Real = typename B::Real;
  VertexModel<B> model;
  Vectors<B> f, u, v;
  Real h;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Real w = h * model.inverse_mass(a), c = w > 0 ? h * model.damping(a) : Real(0);
    const Vec3<Real> speed = vector_at<B>(v, a), force = vector_at<B>(f, a),
                     at = vector_at<B>(u, a);
    set_vector<B>(u, a, at + h * speed), set_vector<B>(v, a, speed + (w * force - c * speed));
  }
};

/// Stage of an explicit Runge-Kutta method in displacement and velocity. With k_u = v_s and k_v =
/// a(u_s, v_s) - c v_s of the stage state s, it adds weight * h * k to the sum. It sets the next
/// stage state to start + ahead * h * k.
template <class B>
struct RungeKuttaStage {
  using Real = typename B::Real;
  VertexModel<B> model;
  Vectors<B> f;
  State<B> start, stage, sum;
  Real h, weight, ahead;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Real w = model.inverse_mass(a), c = w > 0 ? model.damping(a) : Real(0);
    const Vec3<Real> ku = vector_at<B>(stage.v, a), kv = w * vector_at<B>(f, a) - c * ku;
    const Vec3<Real> u = vector_at<B>(start.u, a), v = vector_at<B>(start.v, a);
    set_vector<B>(sum.u, a, vector_at<B>(sum.u, a) + weight * h * ku);
    set_vector<B>(sum.v, a, vector_at<B>(sum.v, a) + weight * h * kv);
    set_vector<B>(stage.u, a, u + ahead * h * ku), set_vector<B>(stage.v, a, v + ahead * h * kv);
  }
};

}  // namespace plica
