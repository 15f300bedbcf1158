// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/contact_records.hpp>
#include <plica/kernels/contact/obstacle_pose.hpp>
#include <plica/kernels/reduce.hpp>

// Forces and torques of obstacles on the body, and of bodies on each other.
namespace plica {

/// Returns a force at a place, and its torque about another place.
template <class Real>
KOKKOS_INLINE_FUNCTION Sums<6> wrench_at(const Vec3<Real>& x, const Vec3<Real>& f,
                                         const Vec3<double>& about) {
  Vec3<double> arm, force;
  for (int k = 0; k < 3; ++k) {
    arm[k] = static_cast<double>(x[k]) - about[k];
    force[k] = static_cast<double>(f[k]);
  }
  const Vec3<double> torque = cross(arm, force);
  return {{force[0], force[1], force[2], torque[0], torque[1], torque[2]}};
}

/// Force of one obstacle, and its torque about the obstacle's origin.
template <class B>
struct ObstacleWrench {
  EmbeddedSurface<B> surface;
  Vectors<B> u;
  ContactRecords<B> records;
  int obstacle;
  ObstacleMotion<B> at;
  KOKKOS_INLINE_FUNCTION Sums<6> operator()(int i) const {
    const int r = records.list.item(i);
    if (records.row(r) != obstacle) return {};
    return wrench_at(records.place(surface, u, r), vector_at<B>(records.force, r), at.about());
  }
};

/// Force of the other bodies on one of several bodies, and its torque about [0, 0, 0].
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

/// Weights of the last forces in a step's impulse, for methods that carry something on. x = weight
/// F + again x_before is carried, and the impulse is now x + before x_before.
struct CarriedImpulse {
  double weight = 0, again = 0, now = 1, before = 0;
};

/// Adds the impulse of one obstacle or body.
template <class B>
struct AddImpulse {
  Doubles<B> sums, impulse, carried;
  int first;  ///< first number of the obstacle or body
  CarriedImpulse of;
  KOKKOS_INLINE_FUNCTION void operator()() const {
    for (int k = first; k < first + 6; ++k) {
      const double x_before = of.again != 0 || of.before != 0 ? carried(k) : 0.0;
      carried(k) = of.weight * sums(k - first) + of.again * x_before;
      impulse(k) += of.now * carried(k) + of.before * x_before;
    }
  }
};

/// Adds a sum to work.
template <class B>
struct AddWork {
  Doubles<B> sums, work;
  KOKKOS_INLINE_FUNCTION void operator()() const { work(0) += sums(0); }
};

/// Counts the records of an obstacle that press, and those that slip: friction is at its cap.
template <class B>
struct CountSlips {
  using Real = typename B::Real;
  ContactRecords<B> records;
  int obstacle;
  KOKKOS_INLINE_FUNCTION Sums<2> operator()(int i) const {
    constexpr Real nearly = Real(0.9999);
    const int r = records.list.item(i);
    const ContactLaw<Real> law = records.law_at(r);
    if (records.row(r) != obstacle || law.is_tie()) return {};
    const Vec3<Real> F = vector_at<B>(records.force, r), N = vector_at<B>(records.normal, r);
    const Real lam = dot(F, N);
    if (!(lam > 0)) return {};
    const Vec3<Real> q = across(F, N);
    return {{1.0, Kokkos::sqrt(dot(q, q)) >= nearly * law.friction * lam ? 1.0 : 0.0}};
  }
};

/// Computes wrench = the sum of the levels' impulses over the time that they took, `per_time` its
/// inverse.
template <class B>
struct SumImpulses {
  Doubles<B> impulse, wrench;
  double per_time;
  bool first;  ///< true for the first of the levels
  KOKKOS_INLINE_FUNCTION void operator()(int k) const {
    wrench(k) = (first ? 0.0 : wrench(k)) + per_time * impulse(k);
  }
};

}  // namespace plica
