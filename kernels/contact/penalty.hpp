// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/penalty.hpp>
#include <plica/kernels/contact/shapes.hpp>

namespace plica {

/// Constants of one surface point's contact.
template <class Real>
struct PenaltyLaw {
  Real stiffness;   ///< [N/m]
  Real damping;     ///< along the normal [N s/m]
  Real tangential;  ///< the largest coefficient of the regularised friction [N s/m]; 0: frictionless
  Real friction;    ///< Coulomb's coefficient
};

/// Force on a surface point and what it takes to linearise it.
template <class Real>
struct PointContact {
  Vec3<Real> force;  ///< [N]
  bool active = false;
  Vec3<Real> normal;
  Real pressure = 0;  ///< along it [N]
  Real drag = 0;      ///< tangential force over sliding speed [N s/m]
  Vec3<Real> slip;    ///< unit sliding direction where the point slips, else 0
};

/// Penalty with damping, never pulling: n = k p - d v.n >= 0 with the penetration p = -(distance + ahead * v.n); friction
/// regularised by a viscous branch: -min(tangential, friction n / |v_t|) v_t. v is relative to the obstacle; `ahead` [s]
/// predicts the penetration for implicit steps, which would otherwise detect the contact of a fast body one step too late.
template <class Real>
KOKKOS_INLINE_FUNCTION PointContact<Real> penalty_contact(const PenaltyLaw<Real>& law, const Gap<Real>& gap,
                                                          const Vec3<Real>& v, Real ahead) {
  PointContact<Real> c;
  const Real vn = dot(gap.normal, v), penetration = -(gap.distance + ahead * vn);
  const Real pressure = law.stiffness * penetration - law.damping * vn;
  if (!(penetration > 0) || !(pressure > 0)) return c;
  c.active = true;
  c.normal = gap.normal;
  c.pressure = pressure;
  c.force = pressure * gap.normal;
  const Vec3<Real> vt = v - vn * gap.normal;
  const Real speed = sqrt(dot(vt, vt)), cap = law.friction * pressure;
  c.drag = law.tangential;
  if (c.drag * speed > cap) {
    c.drag = cap / speed;
    c.slip = (Real(1) / speed) * vt;
  }
  c.force -= c.drag * vt;
  return c;
}

/// The contact of one point in a step, by the work that it does. With the depths b half a step before the state that forces act in
/// and y half a step after it, and the energy V(d) = k/2 d^2 of a depth above 0, the force is
///   n = (V(y) - V(b)) / (y - b) + c (y - b) / h, never pulling.
/// The kinetic energy changes by -n (y - b): what the body loses is what the penalty and the damping take, and what it gets back the
/// penalty had, whatever the step and the stiffness. y = D - g n, D the depth without n and g what n changes of it.
template <class Real>
struct ContactByWork {
  Real k, c;  ///< [N/m], [N s/m] over h
  Real b;

  /// n for a given depth y.
  KOKKOS_INLINE_FUNCTION Real force(Real y) const {
    const Real way = y - b, viscous = c * way;
    if (b >= 0 && y >= 0) return positive(Real(0.5) * k * (y + b) + viscous);
    if (y > 0) return Real(0.5) * k * y * y / way + viscous;
    return b > 0 ? positive(viscous - Real(0.5) * k * b * b / way) : Real(0);
  }

  /// n for y = D - g n
  KOKKOS_INLINE_FUNCTION Real solve(Real D, Real g) const {
    const Real half = Real(0.5) * g * k, gc = g * c;
    if (b >= 0) {
      const Real n = positive((half * (D + b) + gc * (D - b)) / (1 + half + gc));  // times g
      return D >= n ? n / g : force(b - root(1 + gc, D - b, half * b * b));        // inside, or it leaves
    }
    if (!(D > 0)) return 0;
    const Real last = (D + gc * b) * -b;
    return last > 0 ? force(root(1 + half + gc, -(1 + 2 * gc) * b - D, last)) : D / g;  // it enters, or c stops it at 0
  }

 private:
  KOKKOS_INLINE_FUNCTION static Real positive(Real n) { return Kokkos::max(Real(0), n); }
  /// x >= 0 of q x^2 + p x = r, for q > 0 and r >= 0.
  KOKKOS_INLINE_FUNCTION static Real root(Real q, Real p, Real r) {
    const Real w = Kokkos::sqrt(p * p + 4 * q * r);
    return p > 0 ? 2 * r / (p + w) : (w - p) / (2 * q);
  }
};

}  // namespace plica
