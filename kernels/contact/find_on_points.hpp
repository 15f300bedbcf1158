// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inlining.hpp>
#include <plica/core/model.hpp>
#include <plica/kernels/contact/concavity.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>
#include <plica/kernels/contact/gap.hpp>

// Contact of a surface's points with an obstacle, and the points that the obstacle grasps.
namespace plica {

/// Finds the contact of every point with this obstacle. Most points are further away than the
/// fastest of them gets in the step; nothing else is computed for those.
template <class B, class Shape>
struct FindOnPoints {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  Vectors<B> v;
  Shape shape;
  ObstacleMotion<B> place;
  DepthWatch<B> watch;
  int obstacle;
  Real between;  ///< distance outside of all corners beyond which a triangle touches nothing [m]
  ContactRecords<B> records;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    const int r = records.of_point(obstacle, p);
    const Vec3<Real> x = vector_at<B>(records.places, p);
    const ObstaclePose at = place.now();
    const Vec3<Real> its = at.velocity(x);
    const Real most =
        Kokkos::sqrt(static_cast<Real>(records.fastest(0))) + Kokkos::sqrt(dot(its, its));
    const Real distance = shape(at.local(x)).distance;
    if (!(distance > Kokkos::max(between, records.reach + records.span * most)) ||
        records.grasps.holds(r))
      return look(p, r, x, at);
    records.depth(r) = -distance;
    records.leave(r);
  }
  PLICA_CALL KOKKOS_FUNCTION void look(int p, int r, const Vec3<Real>& x,
                                       const ObstaclePose& at) const {
    const Vec3<Real> own = value_at<B>(surface.embedding, v, p), its = at.velocity(x),
                     speed = own - its;
    if (records.grasps.holds(r)) {
      if (!records.is_torn(r)) return hold(r, p, x, at, its);
      records.grasps.release(r);
    }
    const Vec3<Real> local = at.local(x);
    const Real far = records.reach + records.span * Kokkos::sqrt(dot(speed, speed));
    Gap<Real> gap = records.long_steps
                        ? shape(local)
                        : gap_along(shape, local, at.to_local(records.span * speed), records.reach);
    watch.look(surface.number.extent(0) > 0 ? surface.number(p) : p, gap.distance);
    if (gap.distance < between) records.close(0) = 1;
    if (!(gap.distance < far)) {
      records.depth(r) = -gap.distance;
      return records.leave(r);
    }
    const Vec3<Real> local_normal = gap.normal, N = at.to_world(gap.normal);
    records.set_stencil(r, p, -1, -1, -1, 1, 0, 0, 0);
    records.use(r, records.obstacle_law(obstacle, p), N, -gap.distance, records.span * its,
                records.span * at.template rate<Real>());
    if constexpr (!Shape::convex)
      if (records.concavity.extent(0) > 0) {
        const bool bends =
            gap.distance + records.span * dot(N, speed) < records.edge && !at.is_turning();
        set_block<B>(
            records.concavity, r,
            bends ? concavity(shape, at, local, local_normal, records.edge / 4) : SymMat3<Real>{});
      }
  }
  KOKKOS_INLINE_FUNCTION void hold(int r, int p, const Vec3<Real>& x, const ObstaclePose& at,
                                   const Vec3<Real>& its) const {
    records.set_stencil(r, p, -1, -1, -1, 1, 0, 0, 0);
    records.tie(r, records.held_law(obstacle, p),
                at.to_world(records.grasps.stretch(r, x, at.way(x))), records.span * its);
    if (records.concavity.extent(0) > 0) set_block<B>(records.concavity, r, {});
  }
};

/// Makes an obstacle grasp every point that is no further than `reach` from it. Points that it has
/// grasped already stay as they are.
template <class B, class Shape>
struct Grasp {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  Vectors<B> u;
  Shape shape;
  ObstacleMotion<B> place;
  ContactRecords<B> records;
  int obstacle;
  Real reach;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    const int r = records.of_point(obstacle, p);
    if (records.grasps.holds(r) || !records.grasps.may_hold(r)) return;
    const Vec3<Real> x = value_at<B>(surface.embedding, u, p, vector_at<B>(surface.rest, p));
    const ObstaclePose at = place.now();
    if (shape(at.local(x)).distance <= reach) records.grasps.hold(r, x, at.way(x));
  }
};

/// Releases the points that an obstacle has grasped.
template <class B>
struct LetGo {
  Grasps<B> grasps;
  int first;  ///< first place of the obstacle
  KOKKOS_INLINE_FUNCTION void operator()(int p) const { grasps.release(first + p); }
};

}  // namespace plica
