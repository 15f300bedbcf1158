// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/small.hpp>

namespace plica {

/// Edge of a surface: from begin to end, with the third corners of the triangles on its left and
/// its right.
template <class Real>
struct SurfaceEdge {
  Vec3<Real> begin, end, left, right;
};

/// Gap of one edge against another. The edge is `depth` inside along `normal`, which points out of
/// the other's surface.
template <class Real>
struct EdgeGap {
  bool meet = false;  ///< false: the rest is not set
  Real depth;         ///< negative: the edges are apart [m]
  Vec3<Real> normal;
  Real own, other;  ///< place on each edge, from 0 at its begin to 1 at its end
  /// Part of the depth that counts: from 0 for flat ridges, where points find all, to 1 for steep
  /// ones
  Real share;
};

/// Returns how steeply the surface falls on both sides of an edge from a direction across it. It is
/// the sine of the angle: above 0 the edge is a ridge, which is what another edge meets first.
template <class Real>
KOKKOS_INLINE_FUNCTION Real steepness(const SurfaceEdge<Real>& e, const Vec3<Real>& up) {
  const Vec3<Real> left = e.left - e.begin, right = e.right - e.begin;
  return Kokkos::min(-dot(up, left) / Kokkos::sqrt(dot(left, left)),
                     -dot(up, right) / Kokkos::sqrt(dot(right, right)));
}

/// Least steepness of two edges that meet.
template <class Real>
constexpr Real least_steepness = Real(0.1);

/// Returns true where an edge has half of least_steepness or more from any direction: it may become
/// steeper.
template <class Real>
KOKKOS_INLINE_FUNCTION bool may_be_steep(const SurfaceEdge<Real>& e) {
  constexpr Real half = Real(0.5) * least_steepness<Real>,
                 most = 1 - 2 * half * half;  // cosine of the angle between faces
  const Vec3<Real> along = e.end - e.begin, right = e.right - e.begin;
  const Vec3<Real> a = cross(along, e.left - e.begin), b = cross(right, along);
  return dot(a, right) < 0 && dot(a, b) < most * Kokkos::sqrt(dot(a, a) * dot(b, b));
}

/// Computes the gap of two edges. Edges meet between their ends, ridge to ridge and neither flat,
/// along the normal of both. The surfaces there are separated along it, as along the axes of edges
/// in the separating axis test (D. Gregorius, The Separating Axis Test, GDC 2013).
///
///     from above:    e           across f:      ^ normal = +-(e x f)
///                    |                    ------|------ e
///              ------+------ f                  f      depth < 0: how far e is above f
///                    |                        /   \    the surface on both sides of f
///
/// `path`: way of e against f in the step. Edges that come through each other in the step are taken
/// at the place where they do so.
template <class Real>
KOKKOS_INLINE_FUNCTION EdgeGap<Real> gap_of_edges(const SurfaceEdge<Real>& e,
                                                  const SurfaceEdge<Real>& f,
                                                  const Vec3<Real>& path) {
  constexpr Real parallel = Real(1e-3),  // the squared sine of the angle between them
      least = least_steepness<Real>, full = 3 * least;
  const Vec3<Real> u = e.end - e.begin, v = f.end - f.begin, across = cross(u, v);
  const Real uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), square = dot(across, across);
  EdgeGap<Real> gap;
  if (!(square > parallel * uu * vv)) return gap;
  gap.normal = (dot(across, f.left - f.begin) < 0 ? 1 : -1) / Kokkos::sqrt(square) * across;
  const Real steep = Kokkos::min(steepness(f, gap.normal), steepness(e, Real(-1) * gap.normal));
  if (!(steep > least)) return gap;
  gap.share = Kokkos::min(Real(1), (steep - least) / (full - least));
  Vec3<Real> apart = e.begin - f.begin;
  gap.depth = -dot(gap.normal, apart);
  const Real way = dot(gap.normal, path);
  if (gap.depth < 0 && gap.depth > way) apart += (gap.depth / way) * path;
  const Real du = dot(apart, u), dv = dot(apart, v);
  gap.own = (uv * dv - vv * du) / square, gap.other = (uu * dv - uv * du) / square;
  gap.meet = gap.own > 0 && gap.own < 1 && gap.other > 0 && gap.other < 1;
  return gap;
}

/// Returns the squared distance of two segments. After C. Ericson, Real-Time Collision Detection
/// (2005), section 5.1.9.
template <class Real>
KOKKOS_INLINE_FUNCTION Real squared_distance_of_segments(const Vec3<Real>& a, const Vec3<Real>& b,
                                                         const Vec3<Real>& c, const Vec3<Real>& d) {
  const auto part = [](Real over, Real under) {
    return under > 0 ? Kokkos::max(Real(0), Kokkos::min(Real(1), over / under)) : Real(0);
  };
  const Vec3<Real> u = b - a, v = d - c, w = a - c;
  const Real uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  Real s = part(uv * vw - vv * uw, uu * vv - uv * uv);
  const Real t = part(vw + s * uv, vv);
  s = part(t * uv - uw, uu);
  const Vec3<Real> way = w + s * u - t * v;
  return dot(way, way);
}

}  // namespace plica
