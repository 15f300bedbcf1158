// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inlining.hpp>
#include <plica/kernels/contact/concavity.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>
#include <plica/kernels/contact/on_triangle.hpp>

// Contact of a tool that fits between a surface's points.
namespace plica {

/// Finds the contact of each triangle near an obstacle: where the triangle is deepest, unless a
/// corner is as deep. Its depth is the part beyond the depths of the corners, so that nothing is
/// pushed twice. This is all of it where the corners are outside, and nothing where the obstacle is
/// flat. A triangle that the obstacle has grasped by a corner has no contact: grasped points keep
/// their depth.
template <class B, class Shape>
struct FindOnFaces {
  using Real = typename B::Real;
  Shape shape;
  ObstacleMotion<B> place;
  int obstacle;
  Real reach;    ///< distance outside beyond which a triangle is not looked at [m]
  Real between;  ///< distance outside of all corners beyond which a triangle is not looked at [m]
  ContactRecords<B> records;
  /// Distance to the nearest corner over the longest edge: no place has more than 1 / sqrt 3
  static constexpr Real from_corner = Real(0.6);
  /// maximum stretch; a triangle that is stretched more may be found late
  static constexpr Real stretch = 4;

  KOKKOS_INLINE_FUNCTION void operator()(int t) const {
    const int r = records.of_face(obstacle, t);
    if (records.close(0) == 0) return records.leave(r);
    Real deepest = -records.nowhere();
    for (int c = 0; c < 3; ++c)
      deepest = Kokkos::max(
          deepest, records.depth(records.of_point(obstacle, records.mesh.corner(3 * t + c))));
    if (deepest > -between) return look(t, r);
    records.leave(r);
  }

  PLICA_CALL PLICA_FLATTEN KOKKOS_FUNCTION void look(int t, int r) const {
    constexpr Real as_deep = Real(1e-3);  // over the longest edge
    const SurfaceMesh<B>& mesh = records.mesh;
    int p[3];
    Vec3<Real> x[3], depth;
    Real deepest = -records.nowhere();
    for (int c = 0; c < 3; ++c) {
      p[c] = mesh.corner(3 * t + c);
      const int of_corner = records.of_point(obstacle, p[c]);
      if (records.grasps.holds(of_corner)) return records.leave(r);
      depth[c] = records.depth(of_corner);
      deepest = Kokkos::max(deepest, depth[c]);
      x[c] = vector_at<B>(records.places, p[c]);
    }
    const Real size = longest(x);
    const Real enough = Kokkos::max(-reach, deepest + as_deep * size);  // less is not looked at
    if (!(deepest + from_corner * size > enough)) return records.leave(r);
    const ObstaclePose pose = place.now();
    for (int c = 0; c < 3; ++c) x[c] = pose.local(x[c]);
    if (!(most(x) > enough)) return records.leave(r);
    const Vec3<Real> w = records.precise
                             ? deepest_on_triangle<precise_cuts>(shape, x[0], x[1], x[2], size)
                             : deepest_on_triangle(shape, x[0], x[1], x[2], size);
    const Vec3<Real> deepest_place = w[0] * x[0] + w[1] * x[1] + w[2] * x[2];
    const Gap<Real> gap = shape(deepest_place);
    if (!(-gap.distance > enough)) return records.leave(r);
    Real beyond = -gap.distance;
    for (int c = 0; c < 3; ++c) beyond -= w[c] * Kokkos::max(depth[c], Real(0));
    records.set_stencil(r, p[0], p[1], p[2], -1, w[0], w[1], w[2], 0);
    Vec3<Real> at;
    for (int c = 0; c < 3; ++c) at += w[c] * vector_at<B>(records.places, p[c]);
    const Vec3<Real> push =
        meets_neighbour(t, p, w, pose, gap.normal) ? gap.normal : out_of(gap.normal, inward(x));
    records.use(r, records.obstacle_law(obstacle, p[0]), pose.to_world(push), beyond,
                records.span * pose.velocity(at), records.span * pose.template rate<Real>());
    if constexpr (!Shape::convex)
      if (records.concavity.extent(0) > 0)
        set_block<B>(records.concavity, r,
                     pose.is_turning()
                         ? SymMat3<Real>{}
                         : concavity(shape, pose, deepest_place, gap.normal, records.edge / 4));
  }

  static KOKKOS_INLINE_FUNCTION Real longest(const Vec3<Real>* x) {
    Real square = 0;
    for (int c = 0; c < 3; ++c) {
      const Vec3<Real> d = x[(c + 1) % 3] - x[c];
      square = Kokkos::max(square, dot(d, d));
    }
    return Kokkos::sqrt(square);
  }

  /// Returns a bound of the depths on the triangle [m]. In a convex solid it is the least bound
  /// that follows from the distances' tangents in the triangle's corners and its middle.
  KOKKOS_INLINE_FUNCTION Real most(const Vec3<Real>* x) const {
    Real bound = records.nowhere();
    if constexpr (Shape::convex)
      for (int i = 0; i < 4; ++i) {
        const Vec3<Real> at = i < 3 ? x[i] : Real(1) / 3 * (x[0] + x[1] + x[2]);
        const Gap<Real> gap = shape(at);
        Real least = 0;
        for (int c = 0; c < 3; ++c) least = Kokkos::min(least, dot(gap.normal, x[c] - at));
        bound = Kokkos::min(bound, -gap.distance - least);
      }
    return bound;
  }

  /// Returns twice the triangle's area, as a vector into the body.
  static KOKKOS_INLINE_FUNCTION Vec3<Real> inward(const Vec3<Real>* x) {
    return cross(x[1] - x[0], x[0] - x[2]);
  }

  /// Returns the obstacle's normal. Where a thin tool pierces the triangle, that normal is along
  /// the triangle; then it returns the triangle's own, the direction of `inward`, into the body.
  static KOKKOS_INLINE_FUNCTION Vec3<Real> out_of(const Vec3<Real>& normal,
                                                  const Vec3<Real>& inward) {
    const Real along = dot(normal, inward), square = dot(inward, inward);
    if (!(square > 0) || 4 * along * along > square) return normal;
    return (1 / Kokkos::sqrt(square)) * inward;
  }

  /// Returns true where the place is on a side of the triangle, and the obstacle's normal looks
  /// into the body at the neighbour across that side. A tool that lies across the rim of a cut
  /// touches its wall so: the tool pushes the rim down, and not along the wall's normal, which
  /// would push both walls apart.
  KOKKOS_INLINE_FUNCTION bool meets_neighbour(int t, const int* p, const Vec3<Real>& weights,
                                              const ObstaclePose& pose,
                                              const Vec3<Real>& normal) const {
    constexpr Real on_side = Real(0.02);  // weight of the corner across
    const SurfaceMesh<B>& mesh = records.mesh;
    for (int c = 0; c < 3; ++c) {
      if (weights[c] >= on_side) continue;
      const int a = p[(c + 1) % 3], b = p[(c + 2) % 3];
      for (int i = mesh.first(a); i < mesh.first(a + 1); ++i) {
        const int other = mesh.triangle(i);
        bool shares = false;
        Vec3<Real> x[3];
        for (int k = 0; k < 3; ++k) {
          const int q = mesh.corner(3 * other + k);
          shares = shares || q == b;
          x[k] = pose.local(vector_at<B>(records.places, q));
        }
        const Vec3<Real> into = inward(x);
        const Real along = dot(normal, into);
        if (other != t && shares && along > 0 && 4 * along * along > dot(into, into)) return true;
      }
    }
    return false;
  }
};

}  // namespace plica
