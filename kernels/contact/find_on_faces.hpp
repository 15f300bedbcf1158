// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/concavity.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>
#include <plica/kernels/contact/on_triangle.hpp>

// Contact of a tool that fits between a surface's points.
namespace plica {

/// The record of each triangle near an obstacle, after those of the points: where the triangle is deepest, unless a corner is as deep.
/// Its depth is what it is beyond the depths of the corners, so that nothing is pushed twice: all of it where they are outside,
/// nothing where the obstacle is flat. A triangle that the obstacle holds by a corner has none: held points keep their depth.
///
/// In an implicit step the place goes on from that of the last step, see followed(). The step pushes the body out there; after a long one what was
/// next to it is the deepest. If it were taken at once, places would change from step to step, and forces with them.
template <class B, class Shape>
struct FindOnFaces {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  State<B> state;
  Shape shape;
  ObstaclePlace<B> place;
  int obstacle;
  TouchingPoints<B> points;
  Real nowhere;  ///< the depth of what does not touch, negative [m]
  Real ahead;    ///< an implicit step [s]; 0: a state is looked at

  KOKKOS_INLINE_FUNCTION void operator()(int t) const {
    constexpr Real from_corner = Real(0.6),  // no place is further from all corners, over the longest edge: 1 / sqrt 3
        as_deep = Real(1e-3),                // over the longest edge
        stretch = 4;                         // what is stretched more may be found late
    const FaceSites<B>& faces = points.faces;
    const int r = points.record(obstacle, points.points + t);
    points.depth(r) = nowhere, points.mobility(r) = 0;
    const bool follows = ahead > 0 && faces.kept.extent(0) > 0;
    Vec3<Real> last;
    if (const int site = faces.site(obstacle, t); follows) {
      last = vector_at<B>(faces.kept, site);
      set_vector<B>(faces.kept, site, {});
    }
    Vec3<Real> x[3], depth;
    Real deepest = nowhere;
    for (int c = 0; c < 3; ++c) {
      const int p = faces.corner(3 * t + c), of_corner = points.record(obstacle, p);
      if (points.held.holds(of_corner)) return;
      depth[c] = points.depth(of_corner);
      deepest = Kokkos::max(deepest, depth[c]);
      x[c] = vector_at<B>(surface.rest, p);
    }
    if (!(deepest + stretch * from_corner * longest(x) > -faces.reach)) return;
    for (int c = 0; c < 3; ++c) x[c] = value_at<B>(surface.embedding, state.u, faces.corner(3 * t + c), x[c]);
    const Vec3<Real> speed = place.velocity(x[0]);
    for (int c = 0; c < 3; ++c) x[c] = place.local(x[c]);
    const Real size = longest(x);
    const Real enough = Kokkos::max(-faces.reach, deepest + as_deep * size);  // less is not looked at
    if (!(deepest + from_corner * size > enough) || !(most(x) > enough)) return;
    Vec3<Real> w = deepest_on_triangle(shape, x[0], x[1], x[2], size);
    if (last[0] + last[1] + last[2] > 0) w = followed(last, w, size, speed);
    const Vec3<Real> deepest_place = w[0] * x[0] + w[1] * x[1] + w[2] * x[2];
    const Gap<Real> gap = shape(deepest_place);
    if (!(-gap.distance > enough)) return;
    points.depth(r) = -gap.distance;
    for (int c = 0; c < 3; ++c) points.depth(r) -= w[c] * Kokkos::max(depth[c], Real(0));
    points.mobility(r) = 1;
    set_vector<B>(faces.weight, faces.site(obstacle, t), w);
    if (follows) set_vector<B>(faces.kept, faces.site(obstacle, t), w);
    set_vector<B>(points.normal, r, place.outward(out_of(gap.normal, cross(x[1] - x[0], x[0] - x[2]))));
    if constexpr (!Shape::convex)
      if (points.concavity.extent(0) > 0)
        set_block<B>(points.concavity, r,
                     place.is_turning() ? SymMat3<Real>{}
                                        : concavity<B>(shape, place, deepest_place, gap.normal, points.edge / 4));
    const Vec3<Real> at = points.place(surface, state.u, obstacle, points.points + t);
    set_vector<B>(points.velocity, r, faces.value(surface, state.v, obstacle, t) - place.velocity(at));
  }

  /// Two fifths of the way from the last place to the deepest, or as far as the obstacle goes in the step, if that is more.
  KOKKOS_INLINE_FUNCTION Vec3<Real> followed(const Vec3<Real>& last, const Vec3<Real>& deepest, Real size,
                                             const Vec3<Real>& speed) const {
    constexpr Real least = Real(0.4);
    const Vec3<Real> change = deepest - last;
    const Real way = size * Kokkos::sqrt(dot(change, change)), of_obstacle = ahead * Kokkos::sqrt(dot(speed, speed));
    return last + (of_obstacle > least * way ? Kokkos::min(Real(1), of_obstacle / way) : least) * change;
  }

  static KOKKOS_INLINE_FUNCTION Real longest(const Vec3<Real>* x) {
    Real square = 0;
    for (int c = 0; c < 3; ++c) {
      const Vec3<Real> d = x[(c + 1) % 3] - x[c];
      square = Kokkos::max(square, dot(d, d));
    }
    return Kokkos::sqrt(square);
  }

  /// What is no less than any depth on the triangle: in a convex solid the least that follows from the distances' tangents in its
  /// corners and its middle.
  KOKKOS_INLINE_FUNCTION Real most(const Vec3<Real>* x) const {
    Real bound = -nowhere;
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

  /// The obstacle's normal. Where that is along the triangle, which a thin tool pierces, the triangle's own: `inward` the body.
  static KOKKOS_INLINE_FUNCTION Vec3<Real> out_of(const Vec3<Real>& normal, const Vec3<Real>& inward) {
    const Real along = dot(normal, inward), square = dot(inward, inward);
    if (!(square > 0) || 4 * along * along > square) return normal;
    return (1 / Kokkos::sqrt(square)) * inward;
  }
};

/// Energy of the penalties at the sites of one triangle [J].
template <class B>
struct FaceEnergy {
  TouchingPoints<B> points;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int t) const {
    const int site = points.points + t;
    double sum = 0;
    for (int o = 0; o < points.obstacles; ++o) {
      const auto depth = points.depth(points.record(o, site));
      if (depth > 0) sum += 0.5 * static_cast<double>(points.law_of(o, site).stiffness * depth * depth);
    }
    return {{sum}};
  }
};

}  // namespace plica
