// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/vectors.hpp>

// Start values (u~, v~) of the stages of the implicit integrators, see ImplicitWeights; h is the
// step [s]. The acceleration a is (f - c m v)/m, 0 where motion is given.
namespace plica {

/// Computes the accelerations a.
template <class B>
struct Accelerations {
  VertexModel<B> model;
  Vectors<B> f, v, a;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const typename B::Real w = model.inverse_mass(i),
                           c = w > 0 ? model.damping(i) : typename B::Real(0);
    for (int k = 0; k < 3; ++k) a(i, k) = w * f(i, k) - c * v(i, k);
  }
};

/// Computes u~ = u + h1 v + h2 a, v~ = v + h3 a.
template <class B>
struct ExtrapolateState {
  using Real = typename B::Real;
  State<B> start;
  Vectors<B> a;
  State<B> base;
  Real h1, h2, h3;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    for (int k = 0; k < 3; ++k) {
      base.u(i, k) = start.u(i, k) + h1 * start.v(i, k) + h2 * a(i, k);
      base.v(i, k) = start.v(i, k) + h3 * a(i, k);
    }
  }
};

/// Computes u~ and v~ of the second stage of sdirk2 from its first. a_1 = (v_1 - v_n)/(c h) - w f,
/// with f the contact forces and w the inverse mass; `part` is c h, `rest` (1 - c) h.
template <class B>
struct Sdirk2Base {
  using Real = typename B::Real;
  VertexModel<B> model;
  State<B> start, first;
  Vectors<B> f;
  State<B> base;
  Real part, rest;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const Real w = model.inverse_mass(i);
    for (int k = 0; k < 3; ++k) {
      const Real a = (first.v(i, k) - start.v(i, k)) / part - w * f(i, k);
      base.v(i, k) = start.v(i, k) + rest * a;
      base.u(i, k) = start.u(i, k) + rest * first.v(i, k) + part * base.v(i, k);
    }
  }
};

/// Computes the end of the step from the stage of the generalised alpha method; a_n becomes
/// a_{n+1}.
template <class B>
struct GeneralizedAlphaEnd {
  using Real = typename B::Real;
  State<B> start, base, state;
  Vectors<B> a;
  /// Step [s]; cv and mass of v = base + cv (mass a_n + (1 - mass) a_{n+1}); beta and gamma of the
  /// method
  Real h, cv, mass, beta, gamma;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    for (int k = 0; k < 3; ++k) {
      const Real a0 = a(i, k), a1 = ((state.v(i, k) - base.v(i, k)) / cv - mass * a0) / (1 - mass);
      state.u(i, k) =
          start.u(i, k) + h * start.v(i, k) + h * h * ((Real(0.5) - beta) * a0 + beta * a1);
      state.v(i, k) = start.v(i, k) + h * ((1 - gamma) * a0 + gamma * a1);
      a(i, k) = a1;
    }
  }
};

// Vertex kernels of an implicit stage, see ImplicitWeights. The base (u~, v~) is the start of the
// stage; for vertices whose motion is given it is their end. r = a/b, c the mass damping. Balance
// in newtons, as a function of u alone:
//   R(u) = M (u - u~)/a + c M v - f(u, v),   v = v~ + (u - u~)/r

/// Data of a stage at a vertex.
template <class B>
struct StageAt {
  using Real = typename B::Real;
  VertexModel<B> model;
  State<B> base, state;
  Real a, b;

  KOKKOS_INLINE_FUNCTION bool is_free(int i) const { return model.inverse_mass(i) > 0; }
  KOKKOS_INLINE_FUNCTION Real ratio() const { return a / b; }
  /// Returns the displacement that goes with a velocity.
  KOKKOS_INLINE_FUNCTION Real displacement(int i, int k, Real v) const {
    return is_free(i) ? base.u(i, k) + ratio() * (v - base.v(i, k)) : base.u(i, k);
  }
  /// Returns the velocity that goes with a displacement.
  KOKKOS_INLINE_FUNCTION Real velocity(int i, int k, Real u) const {
    return is_free(i) ? base.v(i, k) + (u - base.u(i, k)) / ratio() : base.v(i, k);
  }
};

/// Computes how far the stage's displacement is from where the forces were linearised, the step's
/// start.
template <class B>
struct StageGap {
  StageAt<B> stage;
  Vectors<B> gap;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    for (int k = 0; k < 3; ++k)
      gap(i, k) = stage.displacement(i, k, stage.state.v(i, k)) - stage.state.u(i, k);
  }
};

/// Computes r = M (v~ - v) + b (f - c M v - K gap), the system's right side for a change of v. K
/// gap is minus the sum of the copies in `partial`, or it follows from A gap = ((1 + b c) M + a K)
/// gap in r.
template <class B>
struct StageRightSide {
  using Real = typename B::Real;
  StageAt<B> stage;
  Vectors<B> f, partial, r;
  Vectors<B> gap;   ///< empty: there is none
  bool by_product;  ///< true where r contains A gap

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const Real m = stage.model.mass(i), c = stage.model.damping(i);
    Vec3<Real> sum = vector_at<B>(f, i);
    if (by_product)
      sum += (1 / stage.a) * ((m + stage.b * c * m) * vector_at<B>(gap, i) - vector_at<B>(r, i));
    else if (gap.extent(0) > 0)
      sum = sum_of_shares<B>(stage.model.shares, partial, i, sum);
    for (int k = 0; k < 3; ++k) {
      const Real v = stage.state.v(i, k);
      r(i, k) = stage.is_free(i) ? m * (stage.base.v(i, k) - v) + stage.b * (sum[k] - c * m * v)
                                 : Real(0);
    }
  }
};

/// Adds dv to v, and changes the displacement with it. dv is replaced by the change of
/// displacement.
template <class B>
struct StageUpdate {
  using Real = typename B::Real;
  StageAt<B> stage;
  Vectors<B> change;  ///< dv, then du

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    for (int k = 0; k < 3; ++k) {
      const Real v = stage.is_free(i) ? stage.state.v(i, k) + change(i, k) : stage.base.v(i, k);
      const Real u = stage.displacement(i, k, v);
      change(i, k) = u - stage.state.u(i, k);
      stage.state.u(i, k) = u, stage.state.v(i, k) = v;
    }
  }
};

/// Takes back a change of displacement: u -= part * change, for free vertices.
template <class B>
struct StageRetreat {
  using Real = typename B::Real;
  StageAt<B> stage;
  Vectors<B> change;
  Real part;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    if (!stage.is_free(i)) return;
    for (int k = 0; k < 3; ++k) {
      stage.state.u(i, k) -= part * change(i, k);
      stage.state.v(i, k) = stage.velocity(i, k, stage.state.u(i, k));
    }
  }
};

/// Sums of the incremental potential Phi(u) = |u - u~|^2_M/2a + c |u - u~|^2_M/2r + c M v~ u - dead
/// u + elastic and contact energy. grad Phi = R, except for forces that have no potential. In
/// order:
///   0  the vertex terms of Phi [J]
///   1  |R|^2 [N^2]
///   2  R.change [J]
///   3  the inertia of Phi alone, for scale [J]
///   4  the square of the force that accelerates the body [N^2]
///   5  the square of the forces that do not depend on its state [N^2]
///   6  the square of the masses [kg^2]
template <class B>
struct StagePotential {
  using Real = typename B::Real;
  StageAt<B> stage;
  Vectors<B> f, dead, change;
  Real back;  ///< part of `change` by which the state is ahead of the state to evaluate

  KOKKOS_INLINE_FUNCTION Sums<7> operator()(int i) const {
    Sums<7> sums;
    if (!stage.is_free(i)) return sums;
    const double m = static_cast<double>(stage.model.mass(i)),
                 c = static_cast<double>(stage.model.damping(i));
    const double a = static_cast<double>(stage.a), r = a / static_cast<double>(stage.b);
    for (int k = 0; k < 3; ++k) {
      const double w =
          static_cast<double>(stage.state.u(i, k) - back * change(i, k) - stage.base.u(i, k));
      const double start = static_cast<double>(stage.base.v(i, k)),
                   force = static_cast<double>(f(i, k));
      const double balance = m * w / a + c * m * (start + w / r) - force;
      sums[0] +=
          m * w * (w / (2 * a) + c * (w / (2 * r) + start)) - static_cast<double>(dead(i, k)) * w;
      sums[1] += balance * balance;
      sums[2] += balance * static_cast<double>(change(i, k));
      sums[3] += m * w * w / (2 * a);
      sums[4] += m * w / a * (m * w / a);
      sums[5] += static_cast<double>(dead(i, k)) * static_cast<double>(dead(i, k));
      sums[6] += m * m;
    }
    return sums;
  }
};

/// Squared force on a vertex whose motion is given [N^2]; 0 for others. At rest that is the square
/// of its reaction.
template <class B>
struct SquaredReaction {
  VertexModel<B> model;
  Vectors<B> f;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int i) const {
    if (model.inverse_mass(i) > 0) return {};
    const auto force = vector_at<B>(f, i);
    return {{static_cast<double>(dot(force, force))}};
  }
};

/// Squared way of a vertex from `from` to `to` [m^2].
template <class B>
struct SquaredWay {
  Vectors<B> from, to;
  KOKKOS_INLINE_FUNCTION Sums<1, 1> operator()(int i) const {
    const auto way = vector_at<B>(to, i) - vector_at<B>(from, i);
    return {{static_cast<double>(dot(way, way))}};
  }
};

/// Kinetic energy of a vertex [J].
template <class B>
struct KineticEnergy {
  Scalars<B> mass;
  Vectors<B> v;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    const auto speed = vector_at<B>(v, a);
    return {{0.5 * static_cast<double>(mass(a)) * static_cast<double>(dot(speed, speed))}};
  }
};

/// Amount by which a volume ratio is below 1; 0 above.
template <class B>
struct LackOfVolume {
  Scalars<B> J;
  KOKKOS_INLINE_FUNCTION Sums<1, 1> operator()(int i) const {
    return {{Kokkos::max(0.0, 1 - static_cast<double>(J(i)))}};
  }
};

}  // namespace plica
