// SPDX-License-Identifier: BSD-3-Clause
#pragma once
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
  Real drag = 0;    ///< tangential force over sliding speed [N s/m]
  Vec3<Real> slip;  ///< unit sliding direction where the point slips, else 0
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

}  // namespace plica
