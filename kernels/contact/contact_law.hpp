// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/small.hpp>

// The law of one contact, the same in all steppers. Over a step h, D is the way of a site against
// its partner (a displacement), d0 its depth at the start (above 0: inside), and N the unit normal
// out of the partner. s is the stretch that the contact carries from step to step:
//
//   normal      kn  = k + c/h      lam = kn max(0, d0 - N.D - d*)      d* = (c/h) max(0, d0) / kn
//   tangential  kt' = kt + ct/h    x = (1 - N N^T) D + (kt/kt') s  q = kt' x, at most tau = mu lam
//   force       F = lam N - q
//
// Both are derivatives of incremental potentials: phi = lam^2 / (2 kn); psi is Huber's function of
// x, kt'/2 x^2 up to the cap tau and straight beyond it. Damping shifts the depth at which the
// spring sets in, so that the force does not jump where a site touches. The stretch makes friction
// stick. It follows the way, and slips where the cap is met. After Simo & Laursen (Computers &
// Structures 42, 1992), with the cap of the last iterate.
//
// A tie is a record without a normal: q acts in all directions, and its cap is the tie's strength.
namespace plica {

/// Constants of the law of a contact or a tie.
template <class Real>
struct ContactLaw {
  Real stiffness = 0;        ///< k [N/m]; of a tie in all directions
  Real damping = 0;          ///< c [N s/m]; of a tie in all directions
  Real shear_stiffness = 0;  ///< kt [N/m]
  Real shear_damping = 0;    ///< ct [N s/m]
  Real friction = 0;         ///< Coulomb's coefficient mu
  /// Strength of a tie [N]: the force at which it tears, infinity: never; 0: this is a contact
  Real strength = 0;
  KOKKOS_INLINE_FUNCTION bool is_tie() const { return strength > 0; }
};

/// Law over a step of h [s].
template <class Real>
struct LawOfStep {
  Real kn, shift;     ///< kn [N/m]; d* over max(0, d0)
  Real kt, memory;    ///< kt' [N/m]; kt/kt'
  Real spring, rate;  ///< kt [N/m]; ct/h [N/m]

  KOKKOS_INLINE_FUNCTION LawOfStep(const ContactLaw<Real>& law, Real h) {
    const bool tie = law.is_tie();
    spring = tie ? law.stiffness : law.shear_stiffness;
    rate = (tie ? law.damping : law.shear_damping) / h;
    kt = spring + rate;
    memory = kt > 0 ? spring / kt : Real(0);
    kn = law.stiffness + law.damping / h;
    shift = law.damping / h / kn;
  }
  /// Returns the normal force for the depths at the start and at the end of the step [N].
  KOKKOS_INLINE_FUNCTION Real normal_force(Real start, Real end) const {
    return Kokkos::max(Real(0), pressure(start, end));
  }
  /// Returns the normal force before it is bounded by 0 from below [N].
  KOKKOS_INLINE_FUNCTION Real pressure(Real start, Real end) const {
    return kn * (end - shift * Kokkos::max(Real(0), start));
  }
};

/// Returns a vector cut to a maximum length.
template <class Real>
KOKKOS_INLINE_FUNCTION Vec3<Real> at_most(const Vec3<Real>& x, Real most) {
  const Real square = dot(x, x);
  return square > most * most ? (most / Kokkos::sqrt(square)) * x : x;
}

/// Returns a vector without its part along a unit vector.
template <class Real>
KOKKOS_INLINE_FUNCTION Vec3<Real> across(const Vec3<Real>& x, const Vec3<Real>& N) {
  return x - dot(x, N) * N;
}

}  // namespace plica
