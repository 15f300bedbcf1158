// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/obstacle_place.hpp>
#include <plica/kernels/contact/touching_points.hpp>
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

/// Force of one obstacle, and its torque about a point; 0 where nothing touches.
template <class B>
struct ObstacleWrench {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  Vectors<B> u;
  TouchingPoints<B> points;
  int obstacle;
  ObstaclePlace<B> at;
  KOKKOS_INLINE_FUNCTION Sums<6> operator()(int site) const {
    const int r = points.record(obstacle, site);
    if (!(points.count(0) > 0) || !(points.mobility(r) > 0)) return {};
    return wrench_at(points.place(surface, u, obstacle, site), vector_at<B>(points.force, r), at.about());
  }
};

/// What the other bodies do to one of several, the same about a point.
template <class B>
struct BodyWrench {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  Vectors<B> u;
  TouchingPoints<B> points;
  int body;
  KOKKOS_INLINE_FUNCTION Sums<6> operator()(int p) const {
    if (!(points.count(0) > 0) || points.law.body(p) != body) return {};
    const Vec3<Real> by_pairs = points.force_on_point(p) - points.force_of_obstacles(p);
    return wrench_at(points.place(surface, u, 0, p), by_pairs, {});
  }
};

/// impulse += weight sums, of one obstacle or body
template <class B>
struct AddImpulse {
  Doubles<B> sums, impulse;
  int first;  ///< the obstacle's first number
  double weight;
  KOKKOS_INLINE_FUNCTION void operator()() const {
    for (int k = 0; k < 6; ++k) impulse(first + k) += weight * sums(k);
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
