// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/surface.hpp>
#include <plica/kernels/contact/attached_points.hpp>
#include <plica/kernels/contact/face_sites.hpp>
#include <plica/kernels/contact/held_points.hpp>
#include <plica/kernels/contact/paired_points.hpp>
#include <plica/kernels/contact/point_laws.hpp>

// What contact keeps of a level, without its kernels: what has contact includes this and does not wait for those to compile.
namespace plica {

/// How a step takes its contact: what of its own acceleration contact sees. A default one: nothing, the bare penalty law.
struct ContactStep {
  double span = 0;   ///< h [s]
  double ahead = 0;  ///< how far ahead of the state the depth is taken, with the velocity there [s]
  double entry =
      0;  ///< the same where a point is still outside, if that is more: it is stopped before it is deep inside
  double damped = 0;  ///< of mass damping c: e = (a - c v) / (1 + damped c), A likewise [s]
};

/// Where surface points are told of that are further inside an obstacle than makes sense, or nowhere: the last of them + 1.
template <class B>
struct DepthWatch {
  Indices<B> lost;           ///< [1]
  typename B::Real deepest;  ///< [m]
  KOKKOS_INLINE_FUNCTION void look(int p, typename B::Real distance) const {
    if (!(distance >= -deepest)) Kokkos::atomic_max(&lost(0), p + 1);
  }
};

/// Contact of a level's surface points, on the device: a row of records for every obstacle, and with pairs two more, of points
/// and triangles and of edges; a record for every point in each. Then come records for the surface's faces, a row for every obstacle. A site is a point, or then a face.
template <class B>
struct TouchingPoints {
  using Real = typename B::Real;
  int points = 0, obstacles = 0;
  Real reach = 0;  ///< a point further than that outside an obstacle is not looked at, but where it is fast [m]
  Real span = 0;   ///< of the step [s]
  PointLaws<B> law;
  PairedPoints<B> pairs;       ///< empty where the surface does not touch itself
  FaceSites<B> faces;          ///< empty where no obstacle is thin
  HeldPoints<B> held;          ///< empty where no obstacle can hold anything
  AttachedPoints<B> attached;  ///< empty where bodies are not attached to each other; in the first row of pairs
  Vectors<B> normal;    ///< [records][3] out of the obstacle, or of the triangle; of a held point its stretch [m]
  Vectors<B> velocity;  ///< of the point relative to it [m/s]
  Vectors<B> smooth;    ///< its acceleration without contact, likewise, where it is near [m/s^2]
  Scalars<B> depth;     ///< > 0 inside [m]
  Scalars<B> mobility;  ///< rho [1/kg]; before the first sweep, 1: it is near; 0: it does not touch
  Vectors<B> force;     ///< on the point [N]
  Blocks<B> block;      ///< [records][6] kg, on implicit levels only, see LineariseTouching
  Doubles<B> count;     ///< [1] records that touch

  KOKKOS_INLINE_FUNCTION int rows() const { return obstacles + (pairs.triangles > 0 ? 2 : 0); }
  KOKKOS_INLINE_FUNCTION int sites() const { return points + faces.triangles; }
  /// The first rows, beyond which a site has nothing.
  KOKKOS_INLINE_FUNCTION int rows_of(int site) const { return site < points ? obstacles + pairs.rows() : obstacles; }
  KOKKOS_INLINE_FUNCTION int record(int row, int site) const {
    return site < points ? row * points + site : rows() * points + faces.site(row, site - points);
  }
  KOKKOS_INLINE_FUNCTION const PenaltyLaw<Real>& law_of(int row, int site) const {
    return law(Kokkos::min(row, obstacles), site < points ? site : faces.corner(3 * (site - points)));
  }
  /// Whether it is held by a spring, instead of pushed.
  KOKKOS_INLINE_FUNCTION bool is_held(int row, int site) const {
    return row < obstacles ? held.holds(record(row, site)) : row == obstacles && attached.holds(site);
  }
  KOKKOS_INLINE_FUNCTION const PenaltyLaw<Real>& spring_of(int row, int site) const {
    return row < obstacles ? held.law(row, site) : attached.law(attached.attachment(site));
  }
  /// What a field has at a site.
  KOKKOS_INLINE_FUNCTION Vec3<Real> value(const EmbeddedSurface<B>& surface, const Vectors<B>& x, int row,
                                          int site) const {
    return site < points ? value_at<B>(surface.embedding, x, site) : faces.value(surface, x, row, site - points);
  }
  KOKKOS_INLINE_FUNCTION Vec3<Real> place(const EmbeddedSurface<B>& surface, const Vectors<B>& u, int row,
                                          int site) const {
    Vec3<Real> x = value(surface, u, row, site);
    if (site < points) return x + vector_at<B>(surface.rest, site);
    const int t = site - points;
    for (int c = 0; c < 3; ++c)
      x += faces.weight(faces.site(row, t), c) * vector_at<B>(surface.rest, faces.corner(3 * t + c));
    return x;
  }
  KOKKOS_INLINE_FUNCTION int pair(int row, int site) const { return (row - obstacles) * points + site; }
  /// The same against what the site touches, see PairedPoints.
  KOKKOS_INLINE_FUNCTION Vec3<Real> difference(const EmbeddedSurface<B>& surface, const Vectors<B>& x, int row,
                                               int site, bool bounding = false) const {
    return row < obstacles ? value(surface, x, row, site) : pairs.difference(surface, x, pair(row, site), bounding);
  }
  /// What vertex a has of that difference.
  KOKKOS_INLINE_FUNCTION Real share(const EmbeddedSurface<B>& surface, int row, int site, int a) const {
    const auto of = [&](int p) {
      Real sum = 0;
      for (int c = 0; c < 4; ++c)
        if (surface.embedding.source(p, c) == a) sum += surface.embedding.weight(p, c);
      return sum;
    };
    const bool paired = row >= obstacles;
    Real sum = site >= points ? Real(0) : paired ? pairs.own_weight(pair(row, site)) * of(site) : of(site);
    for (int c = 0; c < 3; ++c) {
      if (site >= points)
        sum += faces.weight(faces.site(row, site - points), c) * of(faces.corner(3 * (site - points) + c));
      else if (const int i = pair(row, site); paired)
        sum += pairs.weight(i, c) * of(pairs.other(3 * i + c));
    }
    return sum;
  }
  /// It couples the vertices of one tetrahedron alone.
  KOKKOS_INLINE_FUNCTION bool is_of_one(int row, int site) const { return site < points && row < obstacles; }
  static KOKKOS_INLINE_FUNCTION Real nowhere() { return Real(1e30); }  ///< how far away is what is near nothing [m]
  KOKKOS_INLINE_FUNCTION bool near(int r) const { return mobility(r) > 0; }
  /// It is in the linear system.
  KOKKOS_INLINE_FUNCTION bool is_stiff(int r) const { return block(r, 0) + block(r, 1) + block(r, 2) > 0; }
  KOKKOS_INLINE_FUNCTION Vec3<Real> force_on_point(int p) const {
    return pairs.sum.extent(0) > 0 ? vector_at<B>(pairs.sum, p) : force_of_obstacles(p);
  }
  /// On point p, its part of what the faces around it touch included.
  KOKKOS_INLINE_FUNCTION Vec3<Real> force_of_obstacles(int p) const {
    Vec3<Real> sum;
    for (int o = 0; o < obstacles; ++o) sum += vector_at<B>(force, record(o, p));
    if (faces.triangles == 0) return sum;
    for (int s = faces.first(p); s < faces.first(p + 1); ++s)
      for (int o = 0; o < obstacles; ++o) {
        const int t = faces.triangle(s);
        sum += faces.weight_of(o, t, p) * vector_at<B>(force, record(o, points + t));
      }
    return sum;
  }
  /// On the i-th touched vertex of the surface, its points in order.
  KOKKOS_INLINE_FUNCTION Vec3<Real> force_on(const EmbeddedSurface<B>& surface, int i) const {
    Vec3<Real> sum;
    for (int s = surface.first(i); s < surface.first(i + 1); ++s)
      sum += surface.weight(s) * force_on_point(surface.point(s));
    return sum;
  }
};

}  // namespace plica
