// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/gap.hpp>
#include <plica/kernels/contact/on_triangle.hpp>
#include <plica/kernels/contact/pair_grid.hpp>

// The narrow phase of pairs: each point's nearest triangle, and on which side of it the point is.
namespace plica {

/// Geometry of the surface as it is in a grid's `x`.
template <class B>
struct FindPairs {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  State<B> state;
  PairGrid<B> grid;
  TouchingPoints<B> points;

  KOKKOS_INLINE_FUNCTION int corner(int t, int c) const { return points.pairs.corner(3 * t + c); }
  KOKKOS_INLINE_FUNCTION Vec3<Real> x(int p) const { return vector_at<B>(grid.x, p); }
  KOKKOS_INLINE_FUNCTION Vec3<Real> nearest(const Vec3<Real>& at, int t) const {
    return nearest_on_triangle(at, x(corner(t, 0)), x(corner(t, 1)), x(corner(t, 2)));
  }
  /// From a place on a triangle.
  KOKKOS_INLINE_FUNCTION Vec3<Real> off(Vec3<Real> at, int t, const Vec3<Real>& weight) const {
    for (int c = 0; c < 3; ++c) at -= weight[c] * x(corner(t, c));
    return at;
  }
  /// look(triangle) for all that p may touch and that may be near, in any order; some come twice.
  template <class Look>
  KOKKOS_INLINE_FUNCTION void each_near(int p, const Look& look) const {
    if (grid.close(p) <= grid.longest) {
      for (int i = 0; i < grid.close(p); ++i) look(grid.listed(p * grid.longest + i));
      return;
    }
    grid.around(vector_at<B>(grid.built, p), [&](int t) {
      if (may_touch(p, t)) look(t);
    });
  }
  KOKKOS_INLINE_FUNCTION Vec3<Real> v(int p) const { return value_at<B>(surface.embedding, state.v, p); }
  KOKKOS_INLINE_FUNCTION Vec3<Real> rest(int p) const { return vector_at<B>(surface.rest, p); }
  KOKKOS_INLINE_FUNCTION bool one_body(int p, int t) const {
    const PointLaws<B>& of = points.law;
    return of.bodies == 1 || of.body(p) == of.body(corner(t, 0));
  }
  KOKKOS_INLINE_FUNCTION bool allowed(int p, int t) const {
    return one_body(p, t) ? grid.limits.self : grid.limits.between;
  }
  /// On one body, at rest, they must be far apart, or face each other across a gap: not neighbours, nor the sides of something thin.
  KOKKOS_INLINE_FUNCTION bool may_touch(int p, int t) const {
    if (!allowed(p, t)) return false;
    if (!one_body(p, t)) return true;
    const Vec3<Real> at = rest(p), a = rest(corner(t, 0)), b = rest(corner(t, 1)), c = rest(corner(t, 2));
    const Vec3<Real> w = nearest_on_triangle(at, a, b, c), d = at - (w[0] * a + w[1] * b + w[2] * c);
    const Vec3<Real> n = cross(b - a, c - a);
    const Real square = dot(d, d), out = dot(d, n);
    return square > grid.limits.apart * grid.limits.apart || (out > 0 && 4 * out * out > square * dot(n, n));
  }
  /// Not normalised.
  KOKKOS_INLINE_FUNCTION Vec3<Real> face(int t) const {
    const Vec3<Real> a = x(corner(t, 0));
    return cross(x(corner(t, 1)) - a, x(corner(t, 2)) - a);
  }
  static KOKKOS_INLINE_FUNCTION Vec3<Real> unit(const Vec3<Real>& d) {
    const Real length = Kokkos::sqrt(dot(d, d));
    return length > 0 ? (1 / length) * d : Vec3<Real>{};
  }
  KOKKOS_INLINE_FUNCTION Real angle_at(int t, int q) const {
    int c = 0;
    while (c < 2 && corner(t, c) != q) ++c;
    const Vec3<Real> at = x(q), d = unit(x(corner(t, (c + 1) % 3)) - at), e = unit(x(corner(t, (c + 2) % 3)) - at);
    return Kokkos::acos(Kokkos::max(Real(-1), Kokkos::min(Real(1), dot(d, e))));
  }
  /// Out of the surface around one of its points, not normalised.
  KOKKOS_INLINE_FUNCTION Vec3<Real> outward_at(int p) const {
    Vec3<Real> sum;
    for (int s = points.pairs.first(p); s < points.pairs.first(p + 1); ++s) sum += face(points.pairs.triangle(s));
    return sum;
  }
  KOKKOS_INLINE_FUNCTION bool has(int t, int q) const {
    return corner(t, 0) == q || corner(t, 1) == q || corner(t, 2) == q;
  }
  /// The corner that has all the weight, or -1.
  KOKKOS_INLINE_FUNCTION int lone_corner(int t, const Vec3<Real>& w) const {
    int last = -1, count = 0;
    for (int c = 0; c < 3; ++c)
      if (w[c] > 0) last = corner(t, c), ++count;
    return count == 1 ? last : -1;
  }
  /// look(triangle) for all that have the place of the triangle t with these weights: t itself, or those around an edge or a vertex.
  template <class Look>
  KOKKOS_INLINE_FUNCTION void each_at(int t, const Vec3<Real>& w, const Look& look) const {
    int on[3], n = 0;
    for (int c = 0; c < 3; ++c)
      if (w[c] > 0) on[n++] = corner(t, c);
    if (n == 3) return look(t);
    for (int s = points.pairs.first(on[0]); s < points.pairs.first(on[0] + 1); ++s)
      if (const int other = points.pairs.triangle(s); n == 1 || has(other, on[1])) look(other);
  }
  /// Out of the face, edge or vertex of the triangle that has these weights: angle-weighted, see SignedDistance.
  KOKKOS_INLINE_FUNCTION Vec3<Real> outward(int t, const Vec3<Real>& w) const {
    const int vertex = lone_corner(t, w);
    Vec3<Real> sum;
    each_at(t, w, [&](int other) { sum += (vertex < 0 ? Real(1) : angle_at(other, vertex)) * unit(face(other)); });
    return unit(sum);
  }
  /// Whether d, from that place, leads into the body. Where all faces around it agree, no normal is needed.
  KOKKOS_INLINE_FUNCTION bool leads_in(const Vec3<Real>& d, int t, const Vec3<Real>& w) const {
    bool in = false, out = false;
    each_at(t, w, [&](int other) { (dot(d, face(other)) < 0 ? in : out) = true; });
    return in && out ? dot(d, outward(t, w)) < 0 : in;
  }
};

/// Lists what may come near each point while the grid stays.
template <class B>
struct ListClose {
  using Real = typename B::Real;
  FindPairs<B> find;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    const PairGrid<B>& grid = find.grid;
    const Vec3<Real> at = find.x(p);
    const Real far = grid.reach(0) + grid.limits.margin;
    int count = 0, about = 0;
    grid.around(at, [&](int t) {
      if (!find.allowed(p, t)) return;
      ++about;
      const Vec3<Real> d = find.off(at, t, find.nearest(at, t));
      if (dot(d, d) > far * far || !find.may_touch(p, t)) return;
      if (count < grid.longest) grid.listed(p * grid.longest + count) = t;
      ++count;
    });
    grid.close(p) = count, grid.about(p) = about;
  }
};

/// Each point's record of its nearest triangle, the one with the lowest number where several are. What is fast looks as
/// far as it may get, and is near what its path leads through.
template <class B>
struct NearestTriangles {
  using Real = typename B::Real;
  /// A triangle, the point's distance to it and the weights of its corners there.
  struct Nearest {
    int triangle = -1;
    Real square;
    Vec3<Real> weight;
    bool inside = false;  ///< of the surface there; of what partner() returns
  };
  FindPairs<B> find;

  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    const TouchingPoints<B>& points = find.points;
    const int r = points.record(points.obstacles, p);
    points.depth(r) = -points.nowhere(), points.mobility(r) = 0;
    const int last = points.pairs.partner(p);
    points.pairs.partner(p) = points.pairs.other(3 * p) = -1;
    if (points.attached.holds(p)) stretch(p, r);
    if (points.attached.ties(p) || find.grid.close(p) == 0) return;
    if (const Nearest found = partner(p, last); found.triangle >= 0) record(p, r, found);
  }

  KOKKOS_INLINE_FUNCTION Vec3<Real> corner(int t, int c) const { return find.x(find.corner(t, c)); }
  KOKKOS_INLINE_FUNCTION Vec3<Real> away_from(int p, const Nearest& n) const {
    return find.off(find.x(p), n.triangle, n.weight);
  }
  /// Velocity of a point against a place on a triangle.
  KOKKOS_INLINE_FUNCTION Vec3<Real> speed(int p, int t, const Vec3<Real>& weight) const {
    Vec3<Real> v = find.v(p);
    for (int c = 0; c < 3; ++c) v -= weight[c] * find.v(find.corner(t, c));
    return v;
  }
  KOKKOS_INLINE_FUNCTION Nearest near(int p, int t) const {
    Nearest n{t, 0, find.nearest(find.x(p), t)};
    const Vec3<Real> d = away_from(p, n);
    n.square = dot(d, d);
    return n;
  }
  KOKKOS_INLINE_FUNCTION Nearest sided(int p, Nearest n) const {
    n.inside = find.leads_in(away_from(p, n), n.triangle, n.weight);
    return n;
  }
  /// Whether all of a triangle is further away than that, by the box around it.
  KOKKOS_INLINE_FUNCTION bool is_beyond(const Vec3<Real>& at, int t, Real square) const {
    const Vec3<Real> a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    Real sum = 0;
    for (int k = 0; k < 3; ++k) {
      const Real low = Kokkos::min(a[k], Kokkos::min(b[k], c[k])), high = Kokkos::max(a[k], Kokkos::max(b[k], c[k]));
      const Real d = Kokkos::max(Real(0), Kokkos::max(low - at[k], at[k] - high));
      sum += d * d;
    }
    return sum > square;
  }
  KOKKOS_INLINE_FUNCTION void take_nearer(int p, int t, Nearest& nearest) const {
    const Nearest n = near(p, t);
    if (n.square < nearest.square || (n.square == nearest.square && t < nearest.triangle)) nearest = n;
  }

  /// `last`: the one of the last step, or -1
  KOKKOS_INLINE_FUNCTION Nearest partner(int p, int last) const {
    const PairGrid<B>& grid = find.grid;
    const Real ordinary = grid.limits.reach, far = grid.closing(find.points.span);
    const bool fast = far > Real(0.5) * ordinary;
    Nearest nearest;
    nearest.square = fast ? Kokkos::max(far * far, ordinary * ordinary) : ordinary * ordinary;
    if (last >= 0) take_nearer(p, last, nearest);
    const Vec3<Real> at = find.x(p);
    find.each_near(p, [&](int t) {
      if (!is_beyond(at, t, nearest.square)) take_nearer(p, t, nearest);
    });
    if (nearest.triangle < 0) return nearest;
    nearest = sided(p, nearest);
    return fast ? on_path(p, nearest) : facing(p, nearest);
  }

  /// What a fast point is near: if it will be held before its path leads through anything, what it is nearest to, else what it leads
  /// through first.
  KOKKOS_INLINE_FUNCTION Nearest on_path(int p, const Nearest& nearest) const {
    constexpr Real third = Real(1) / 3, little = Real(0.05);
    const Real h = find.points.span, ordinary = find.grid.limits.reach;
    const Vec3<Real> at = find.x(p), d = away_from(p, nearest);
    if (nearest.inside) return facing(p, nearest);
    Real when = 2;
    int first = -1;
    find.each_near(p, [&](int t) {
      const Vec3<Real> path = h * speed(p, t, {third, third, third});
      const Real time = time_of_crossing(at, path, corner(t, 0), corner(t, 1), corner(t, 2));
      if (!(time < when || (time == when && t < first)) || time > 1) return;
      when = time, first = t;
    });
    if (first < 0) return nearest.square < ordinary * ordinary ? nearest : Nearest{};
    const Real closing = when * h * dot(d, speed(p, nearest.triangle, nearest.weight));
    return nearest.square + closing <= little * nearest.square ? nearest : sided(p, near(p, first));
  }

  /// A point that is inside came through a triangle that its own surface faces: so it does not leave a thin body on the far side.
  KOKKOS_INLINE_FUNCTION Nearest facing(int p, const Nearest& nearest) const {
    const int own = nearest.triangle;
    if (find.one_body(p, own) || !nearest.inside) return nearest;
    const Vec3<Real> out = find.outward_at(p);
    if (!(dot(out, find.face(own)) > 0)) return nearest;
    Nearest other;
    other.square = find.grid.limits.reach * find.grid.limits.reach;
    find.each_near(p, [&](int t) {
      if (!find.one_body(p, t) && dot(out, find.face(t)) < 0) take_nearer(p, t, other);
    });
    if (other.triangle < 0 || !(dot(away_from(p, other), find.face(other.triangle)) < 0)) return nearest;
    return sided(p, other);
  }

  KOKKOS_INLINE_FUNCTION void join(int p, int t, const Vec3<Real>& w) const {
    const PairedPoints<B>& pairs = find.points.pairs;
    pairs.partner(p) = t;
    set_vector<B>(pairs.weight, p, Real(-1) * w);
    for (int c = 0; c < 3; ++c) pairs.other(3 * p + c) = find.corner(t, c);
  }

  /// The record of a point that is attached to a triangle.
  KOKKOS_INLINE_FUNCTION void stretch(int p, int r) const {
    const TouchingPoints<B>& points = find.points;
    const int t = points.attached.triangle(p);
    const Vec3<Real> w = vector_at<B>(points.attached.weight, p);
    points.mobility(r) = 1;
    set_vector<B>(points.normal, r, find.off(find.x(p), t, w));
    set_vector<B>(points.velocity, r, speed(p, t, w));
    join(p, t, w);
  }

  KOKKOS_INLINE_FUNCTION void record(int p, int r, const Nearest& found) const {
    constexpr Real tiny = sizeof(Real) == 4 ? Real(1e-4) : Real(1e-8);  // of the reach: no direction is known there
    const TouchingPoints<B>& points = find.points;
    const int t = found.triangle;
    const bool inside = found.inside;
    const Vec3<Real>&w = found.weight, d = away_from(p, found);
    const Real distance = Kokkos::sqrt(found.square), limit = find.grid.limits.reach;
    const bool on_face = w[0] > 0 && w[1] > 0 && w[2] > 0;
    // The far side of a thin part of its own body is no partner
    if (inside && find.one_body(p, t) && distance > Real(0.25) * find.grid.limits.apart) return;
    points.depth(r) = inside ? distance : -distance, points.mobility(r) = 1;
    const bool by_surface = on_face || distance < tiny * limit;
    set_vector<B>(points.normal, r, by_surface ? find.outward(t, w) : ((inside ? -1 : 1) / distance) * d);
    set_vector<B>(points.velocity, r, speed(p, t, w));
    join(p, t, w);
  }
};

/// Of how many pairs each point is one of the others.
template <class B>
struct CountParts {
  PairedPoints<B> pairs;
  Indices<B> count;
  KOKKOS_INLINE_FUNCTION void operator()(int pair) const {
    if (pair >= pairs.rows() * pairs.points) return;
    for (int c = 0; c < 3; ++c)
      if (const int q = pairs.weighted_other(pair, c); q >= 0) Kokkos::atomic_inc(&count(q));
  }
};

/// Lists its parts of them, in any order; `count` falls to 0.
template <class B>
struct ListParts {
  PairedPoints<B> pairs;
  Indices<B> count;
  KOKKOS_INLINE_FUNCTION void operator()(int pair) const {
    if (pair >= pairs.rows() * pairs.points) return;
    for (int c = 0; c < 3; ++c)
      if (const int q = pairs.weighted_other(pair, c); q >= 0)
        pairs.part(pairs.from(q) + Kokkos::atomic_fetch_sub(&count(q), 1) - 1) = 3 * pair + c;
  }
};

/// Sorts each point's list, which is short.
template <class B>
struct SortParts {
  PairedPoints<B> pairs;
  KOKKOS_INLINE_FUNCTION void operator()(int q) const {
    const int begin = pairs.from(q), end = pairs.from(q + 1);
    for (int i = begin + 1; i < end; ++i) {
      const int part = pairs.part(i);
      int j = i;
      for (; j > begin && pairs.part(j - 1) > part; --j) pairs.part(j) = pairs.part(j - 1);
      pairs.part(j) = part;
    }
  }
};

/// Potential energy of the pairs' penalties and of attachments' springs, as a field of the pairs [J].
template <class B>
struct PairEnergy {
  TouchingPoints<B> points;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int pair) const {
    const int row = points.obstacles + pair / points.points, p = pair % points.points, r = points.record(row, p);
    if (points.is_held(row, p)) {
      const auto s = vector_at<B>(points.normal, r);
      return {{0.5 * static_cast<double>(points.spring_of(row, p).stiffness * dot(s, s))}};
    }
    const auto depth = points.depth(r);
    if (!(depth > 0)) return {};
    return {{0.5 * static_cast<double>(points.law_of(row, p).stiffness * depth * depth)}};
  }
};

}  // namespace plica
