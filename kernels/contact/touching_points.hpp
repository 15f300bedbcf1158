// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>
#include <plica/core/transfer.hpp>
#include <plica/kernels/contact/penalty.hpp>
#include <plica/kernels/vectors.hpp>

// What contact keeps of a level, without its kernels: what has contact includes this and does not wait for those to compile.
namespace plica {

/// The laws of all rows of records, of one body after the other.
template <class B>
struct PointLaws {
  using Law = PenaltyLaw<typename B::Real>;
  Kokkos::View<Law*, typename B::Memory> law;  ///< [rows * bodies]
  Indices<B> body;                             ///< of each point; empty: there is one
  int bodies = 1;
  KOKKOS_INLINE_FUNCTION const Law& operator()(int row, int p) const {
    return law(row * bodies + (bodies > 1 ? body(p) : 0));
  }
};

/// Surface points that are attached to another body: each by a spring and a damper to one place on one of its triangles.
template <class B>
struct AttachedPoints {
  using Real = typename B::Real;
  static constexpr int none = -1, beside = -2;
  /// [points] which one holds it; beside: another point is held at a triangle of it, so that it touches nothing either; none; empty: no
  /// attachments at all
  Indices<B> attachment;
  Indices<B> triangle;                                      ///< [points]
  Vectors<B> weight;                                        ///< [points][3] of its corners
  Kokkos::View<PenaltyLaw<Real>*, typename B::Memory> law;  ///< [attachments] stiffness and damping, in all directions

  KOKKOS_INLINE_FUNCTION bool ties(int p) const { return attachment.extent(0) > 0 && attachment(p) != none; }
  KOKKOS_INLINE_FUNCTION bool holds(int p) const { return attachment.extent(0) > 0 && attachment(p) >= 0; }
};

/// Surface points that obstacles hold: each by a spring and a damper to where it was, relative to the obstacle, when that closed. A
/// record for every obstacle and point, numbered as those of contact.
template <class B>
struct HeldPoints {
  using Real = typename B::Real;
  static constexpr int numbers = 4;  ///< of a record: that place [m], and 1 where the point is held

  int records = 0;    ///< 0: no obstacle can hold anything, no arrays
  Doubles<B> memory;  ///< of the obstacles; these numbers begin with its number `first`
  int first = 0;
  Indices<B> left_out;  ///< [records] 1: of a point that its obstacle never holds; empty: none
  PointLaws<B> law;     ///< stiffness and damping, in all directions

  KOKKOS_INLINE_FUNCTION int at(int r) const { return first + numbers * r; }
  KOKKOS_INLINE_FUNCTION bool holds(int r) const { return r < records && memory(at(r) + 3) > 0; }
  KOKKOS_INLINE_FUNCTION bool may_hold(int r) const { return left_out.extent(0) == 0 || left_out(r) == 0; }
  KOKKOS_INLINE_FUNCTION void hold(int r, const Vec3<Real>& x, const Vec3<double>& moved) const {
    for (int k = 0; k < 3; ++k) memory(at(r) + k) = static_cast<double>(x[k]) - moved[k];
    memory(at(r) + 3) = 1;
  }
  KOKKOS_INLINE_FUNCTION void release(int r) const { memory(at(r) + 3) = 0; }
  /// How far a point at x is from where an obstacle that has moved so holds it [m].
  KOKKOS_INLINE_FUNCTION Vec3<Real> stretch(int r, const Vec3<Real>& x, const Vec3<double>& moved) const {
    Vec3<Real> s;
    for (int k = 0; k < 3; ++k) s[k] = static_cast<Real>(static_cast<double>(x[k]) - moved[k] - memory(at(r) + k));
    return s;
  }
};

/// What a field has at a point, or with `bounding` the sum of its parts' absolute values.
template <class B>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> value_at_point(const EmbeddedSurface<B>& surface, const Vectors<B>& x,
                                                             int p, bool bounding) {
  return bounding ? sum_of_parts_at<B>(surface.embedding, x, p) : value_at<B>(surface.embedding, x, p);
}

/// Where obstacles touch a surface between its points: on every triangle one site for each obstacle, where the triangle is deepest.
template <class B>
struct FaceSites {
  using Real = typename B::Real;
  int triangles = 0;           ///< 0: obstacles touch points alone, no arrays
  Real reach = 0;              ///< a triangle further than that outside an obstacle is not looked at [m]
  Indices<B> corner;           ///< [triangles * 3] points, counter-clockwise seen from outside
  Indices<B> first, triangle;  ///< [points + 1] into the triangles around each point
  Vectors<B> weight;           ///< [obstacles * triangles][3] of the corners, at the site
  Vectors<B> kept;  ///< those of the last implicit step, 0 without a site; empty: sites are where they are deepest

  KOKKOS_INLINE_FUNCTION int site(int obstacle, int t) const { return obstacle * triangles + t; }
  /// What a field has at a site, or with `bounding` the sum of its parts' absolute values.
  KOKKOS_INLINE_FUNCTION Vec3<Real> value(const EmbeddedSurface<B>& surface, const Vectors<B>& x, int obstacle, int t,
                                          bool bounding = false) const {
    Vec3<Real> sum;
    for (int c = 0; c < 3; ++c)
      sum += weight(site(obstacle, t), c) * value_at_point<B>(surface, x, corner(3 * t + c), bounding);
    return sum;
  }
  /// The part that point q, a corner of t, has of a site.
  KOKKOS_INLINE_FUNCTION Real weight_of(int obstacle, int t, int q) const {
    for (int c = 0; c < 3; ++c)
      if (corner(3 * t + c) == q) return weight(site(obstacle, t), c);
    return 0;
  }
};

/// What the search for pairs goes by.
template <class Real>
struct PairLimits {
  Real reach = 0;        ///< a triangle further than that outside is not looked for, but by what is fast [m]
  Real margin = 0;       ///< what may be gained on that until the grid is made anew [m]
  Real apart = 0;        ///< on one body, what is nearer than that at rest is a pair across a gap only [m]
  bool between = false;  ///< bodies
  bool self = false;     ///< on one body
};

/// What of a surface is near what else of it: of another body, or far away on its own. Pair p is the point p and a triangle. Pair
/// points + p is an edge that begins in p, and another edge. W of a pair takes a field's value in p, times the pair's own weight, and
/// of up to three other points:
///
///              p                    b                pair             own      others, and their weights
///              |                    |                p, triangle      1        its corners, < 0
///         o----+----o         c-----+-----d          edges pb, cd     1 - s    b: s; c, d < 0
///          \   |   /                |
///             \o/                   p                The own weight and the others sum up to 0: forces cancel.
template <class B>
struct PairedPoints {
  using Real = typename B::Real;
  int points = 0, triangles = 0;  ///< no triangles: no pairs, no arrays
  Indices<B> corner;              ///< [triangles * 3] points, counter-clockwise seen from outside
  Indices<B> first, triangle;     ///< [points + 1] into the triangles around each point
  Indices<B> first_edge;          ///< [points + 1] into the edges whose end with the lower number is that point
  Indices<B> edge;                ///< [edges * 4] its ends, and the third corners of the triangles left and right of it
  Indices<B> side;                ///< [triangles * 3] the edge from each corner to the next
  Indices<B> partner;             ///< [points] the triangle it is near; -1: none
  Indices<B> other;               ///< [2 * points * 3] the other points of each pair; the first -1: no pair
  Vectors<B> weight;              ///< [2 * points][3] of these, where they are nearest
  Doubles<B> found;               ///< [2] points with a pair of either kind, pairs of edges
  Indices<B> from, part;  ///< [points + 1] into the parts of pairs that each point has as one of others, ascending
  Vectors<B> sum;         ///< [points][3] all forces on each point, also of faces without pairs [N]

  /// Of pairs: the second has something where edges were found.
  KOKKOS_INLINE_FUNCTION int rows() const { return triangles == 0 ? 0 : found(1) > 0 ? 2 : 1; }
  KOKKOS_INLINE_FUNCTION Real own_weight(int pair) const { return pair < points ? Real(1) : 1 - weight(pair, 0); }
  /// W of a field, or with `bounding` the sum of its parts' absolute values.
  KOKKOS_INLINE_FUNCTION Vec3<Real> difference(const EmbeddedSurface<B>& surface, const Vectors<B>& x, int pair,
                                               bool bounding) const {
    Vec3<Real> value;
    for (int c = 0; c < 3; ++c)
      value += part_of(pair, c, bounding) * value_at_point<B>(surface, x, other(3 * pair + c), bounding);
    return own_weight(pair) * value_at_point<B>(surface, x, pair < points ? pair : pair - points, bounding) + value;
  }
  KOKKOS_INLINE_FUNCTION Real part_of(int pair, int c, bool bounding) const {
    return bounding ? Kokkos::abs(weight(pair, c)) : weight(pair, c);
  }
  /// The c-th of its others, where that has a weight; else -1.
  KOKKOS_INLINE_FUNCTION int weighted_other(int pair, int c) const {
    return other(3 * pair) >= 0 && weight(pair, c) != 0 ? other(3 * pair + c) : -1;
  }
  /// use(pair, weight) for all pairs that have point q as one of their others, always in the same order.
  template <class Use>
  KOKKOS_INLINE_FUNCTION void each_pair_at(int q, const Use& use, bool bounding = false) const {
    for (int i = from(q); i < from(q + 1); ++i) use(part(i) / 3, part_of(part(i) / 3, part(i) % 3, bounding));
  }
};

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
  Real edge = 0;   ///< mean, of the surface [m]
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
  Blocks<B>
      concavity;  ///< [records][6] G [1/m], on implicit levels with obstacles that are not convex only; see concavity()
  Doubles<B> count;  ///< [1] records that touch

  KOKKOS_INLINE_FUNCTION int rows() const { return obstacles + (pairs.triangles > 0 ? 2 : 0); }
  KOKKOS_INLINE_FUNCTION int sites() const { return points + faces.triangles; }
  /// The first rows, beyond which a site has nothing.
  KOKKOS_INLINE_FUNCTION int rows_of(int site) const { return site < points ? obstacles + pairs.rows() : obstacles; }
  KOKKOS_INLINE_FUNCTION int record(int row, int site) const {
    return site < points ? row * points + site : rows() * points + faces.site(row, site - points);
  }
  KOKKOS_INLINE_FUNCTION bool is_on_face(int r) const { return r >= rows() * points; }
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
  KOKKOS_INLINE_FUNCTION Vec3<Real> value(const EmbeddedSurface<B>& surface, const Vectors<B>& x, int row, int site,
                                          bool bounding = false) const {
    return site < points ? value_at_point<B>(surface, x, site, bounding)
                         : faces.value(surface, x, row, site - points, bounding);
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
    return row < obstacles ? value(surface, x, row, site, bounding)
                           : pairs.difference(surface, x, pair(row, site), bounding);
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
  /// How its normal turns where it moves so.
  KOKKOS_INLINE_FUNCTION Vec3<Real> turn(int r, const Vec3<Real>& way) const {
    return concavity.extent(0) == 0 ? Vec3<Real>{} : Real(-1) * (block_at<B>(concavity, r) * way);
  }
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
  /// On the i-th touched vertex of the surface, its points in order; `bounding`: by absolute weights.
  KOKKOS_INLINE_FUNCTION Vec3<Real> force_on(const EmbeddedSurface<B>& surface, int i, bool bounding = false) const {
    Vec3<Real> sum;
    for (int s = surface.first(i); s < surface.first(i + 1); ++s) {
      const Real weight = surface.weight(s);
      sum += (bounding ? Kokkos::abs(weight) : weight) * force_on_point(surface.point(s));
    }
    return sum;
  }
};

}  // namespace plica
