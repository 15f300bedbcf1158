// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/contact_records.hpp>
#include <plica/kernels/contact/obstacle_place.hpp>
#include <plica/kernels/reduce.hpp>

// What obstacles do to the body, and bodies to each other.
namespace plica {

/// A force at a place, and its torque about another.
template <class Real>
KOKKOS_INLINE_FUNCTION Sums<6> wrench_at(const Vec3<Real>& x, const Vec3<Real>& f, const Vec3<double>& about) {
  Vec3<double> arm, force;
  for (int k = 0; k < 3; ++k) {
    arm[k] = static_cast<double>(x[k]) - about[k];
    force[k] = static_cast<double>(f[k]);
  }
  const Vec3<double> torque = cross(arm, force);
  return {{force[0], force[1], force[2], torque[0], torque[1], torque[2]}};
}

/// Force of one obstacle, and its torque about a point.
template <class B>
struct ObstacleWrench {
  EmbeddedSurface<B> surface;
  Vectors<B> u;
  ContactRecords<B> records;
  int obstacle;
  ObstaclePlace<B> at;
  KOKKOS_INLINE_FUNCTION Sums<6> operator()(int i) const {
    const int r = records.list.item(i);
    if (records.row(r) != obstacle) return {};
    return wrench_at(records.place(surface, u, r), vector_at<B>(records.force, r), at.about());
  }
};

/// What the other bodies do to one of several, the same about a point.
template <class B>
struct BodyWrench {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  Vectors<B> u;
  ContactRecords<B> records;
  int body;
  KOKKOS_INLINE_FUNCTION Sums<6> operator()(int i) const {
    const int r = records.list.item(i);
    Sums<6> sum;
    if (!records.is_pair(r)) return sum;
    const Vec3<Real> force = vector_at<B>(records.force, r);
    for (int c = 0; c < 4; ++c) {
      const int p = records.point(r, c);
      if (p < 0 || records.body_of(p) != body) continue;
      const Vec3<Real> x = value_at<B>(surface.embedding, u, p, vector_at<B>(surface.rest, p));
      sum += wrench_at(x, records.weight(r, c) * force, {});
    }
    return sum;
  }
};

/// impulse += weight sums + again times what the last step added, of one obstacle or body
template <class B>
struct AddImpulse {
  Doubles<B> sums, impulse, last;
  int first;  ///< the obstacle's first number
  double weight, again;
  KOKKOS_INLINE_FUNCTION void operator()() const {
    for (int k = first; k < first + 6; ++k) {
      last(k) = weight * sums(k - first) + (again > 0 ? again * last(k) : 0.0);
      impulse(k) += last(k);
    }
  }
};

/// wrench = what levels' impulses sum up to over the time that they took, `per_time` its inverse.
template <class B>
struct SumImpulses {
  Doubles<B> impulse, wrench;
  double per_time;
  bool first;  ///< of the levels
  KOKKOS_INLINE_FUNCTION void operator()(int k) const { wrench(k) = (first ? 0.0 : wrench(k)) + per_time * impulse(k); }
};

}  // namespace plica
