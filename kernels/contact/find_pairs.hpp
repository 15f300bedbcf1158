// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/gap.hpp>
#include <plica/kernels/contact/on_triangle.hpp>
#include <plica/kernels/contact/pair_tree.hpp>

// Narrow phase of pairs: each point's nearest triangle, and on which side of it the point is.
namespace plica {

/// Geometry of the surface, at the positions in a tree's `x`.
template <class B>
struct FindPairs {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  State<B> state;
  PairTree<B> tree;
  ContactRecords<B> records;

  KOKKOS_INLINE_FUNCTION int corner(int t, int c) const { return records.mesh.corner(3 * t + c); }
  KOKKOS_INLINE_FUNCTION Vec3<Real> x(int p) const { return vector_at<B>(tree.x, p); }
  KOKKOS_INLINE_FUNCTION Vec3<Real> nearest(const Vec3<Real>& at, int t) const {
    return nearest_on_triangle(at, x(corner(t, 0)), x(corner(t, 1)), x(corner(t, 2)));
  }
  /// Returns the vector from a place on a triangle to `at`.
  KOKKOS_INLINE_FUNCTION Vec3<Real> off(Vec3<Real> at, int t, const Vec3<Real>& weight) const {
    for (int c = 0; c < 3; ++c) at -= weight[c] * x(corner(t, c));
    return at;
  }
  /// Calls look(triangle) for all triangles that p may touch and that may be near. The order is
  /// any.
  template <class Look>
  KOKKOS_INLINE_FUNCTION void each_near(int p, const Look& look) const {
    if (tree.close(p) <= tree.longest) {
      for (int i = 0; i < tree.close(p); ++i) look(tree.listed(p * tree.longest + i));
      return;
    }
    around(p, [&](int t) {
      if (may_touch(p, t)) look(t);
    });
  }
  /// Calls look(triangle) for all triangles that may be near, whether p may touch them or not.
  template <class Look>
  KOKKOS_INLINE_FUNCTION void around(int p, const Look& look) const {
    Box3<Real> box(vector_at<B>(tree.built, p));
    box.enlarge(tree.near());
    tree.around(box, look);
  }
  KOKKOS_INLINE_FUNCTION Vec3<Real> v(int p) const {
    return value_at<B>(surface.embedding, state.v, p);
  }
  KOKKOS_INLINE_FUNCTION Vec3<Real> rest(int p) const { return vector_at<B>(surface.rest, p); }
  KOKKOS_INLINE_FUNCTION bool one_body(int p, int t) const {
    return records.body_of(p) == records.body_of(corner(t, 0));
  }
  KOKKOS_INLINE_FUNCTION bool allowed(int p, int t) const {
    return one_body(p, t) ? tree.limits.self : tree.limits.between;
  }
  /// Returns true where a point may touch a triangle. On one body, at rest, they must be far apart,
  /// or face each other across a gap: not neighbours, nor the sides of something thin.
  KOKKOS_INLINE_FUNCTION bool may_touch(int p, int t) const {
    if (!allowed(p, t)) return false;
    if (!one_body(p, t)) return true;
    const Vec3<Real> at = rest(p), a = rest(corner(t, 0)), b = rest(corner(t, 1)),
                     c = rest(corner(t, 2));
    const Vec3<Real> w = nearest_on_triangle(at, a, b, c),
                     d = at - (w[0] * a + w[1] * b + w[2] * c);
    const Vec3<Real> n = cross(b - a, c - a);
    const Real square = dot(d, d), out = dot(d, n);
    return square > tree.limits.apart * tree.limits.apart ||
           (out > 0 && 4 * out * out > square * dot(n, n));
  }
  /// Returns the normal of a triangle, not normalised.
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
    const Vec3<Real> at = x(q), d = unit(x(corner(t, (c + 1) % 3)) - at),
                     e = unit(x(corner(t, (c + 2) % 3)) - at);
    return Kokkos::acos(Kokkos::max(Real(-1), Kokkos::min(Real(1), dot(d, e))));
  }
  KOKKOS_INLINE_FUNCTION bool has(int t, int q) const {
    return corner(t, 0) == q || corner(t, 1) == q || corner(t, 2) == q;
  }
  /// Returns the corner that has all the weight, or -1.
  KOKKOS_INLINE_FUNCTION int lone_corner(int t, const Vec3<Real>& w) const {
    int last = -1, count = 0;
    for (int c = 0; c < 3; ++c)
      if (w[c] > 0) last = corner(t, c), ++count;
    return count == 1 ? last : -1;
  }
  /// Calls look(triangle) for all triangles that have the place of triangle t with these weights.
  /// They are t itself, or those around an edge or a vertex.
  template <class Look>
  KOKKOS_INLINE_FUNCTION void each_at(int t, const Vec3<Real>& w, const Look& look) const {
    int on[3], n = 0;
    for (int c = 0; c < 3; ++c)
      if (w[c] > 0) on[n++] = corner(t, c);
    if (n == 0) return;  // weights that are not finite
    if (n == 3) return look(t);
    for (int s = records.mesh.first(on[0]); s < records.mesh.first(on[0] + 1); ++s)
      if (const int other = records.mesh.triangle(s); n == 1 || has(other, on[1])) look(other);
  }
  /// Returns the normal out of the face, edge or vertex of the triangle that has these weights. It
  /// is angle-weighted, see SignedDistance.
  KOKKOS_INLINE_FUNCTION Vec3<Real> outward(int t, const Vec3<Real>& w) const {
    const int vertex = lone_corner(t, w);
    Vec3<Real> sum;
    each_at(t, w, [&](int other) {
      sum += (vertex < 0 ? Real(1) : angle_at(other, vertex)) * unit(face(other));
    });
    return unit(sum);
  }
  /// Returns how fast a triangle turns about its normal, times the normal [rad/s]. This rate is the
  /// circulation of its corners' velocities over twice its area.
  KOKKOS_INLINE_FUNCTION Vec3<Real> spin(int t) const {
    Real circulation = 0;
    for (int c = 0; c < 3; ++c) {
      const int a = corner(t, c), b = corner(t, (c + 1) % 3);
      circulation += Real(0.5) * dot(v(a) + v(b), x(b) - x(a));
    }
    const Vec3<Real> n = face(t);
    const Real square = dot(n, n);
    return square > 0 ? (circulation / square) * n : Vec3<Real>{};
  }
  /// Returns true where d, from the place of triangle t with these weights, leads into the body.
  /// Where all faces around the place agree, no normal is needed.
  KOKKOS_INLINE_FUNCTION bool leads_in(const Vec3<Real>& d, int t, const Vec3<Real>& w) const {
    bool in = false, out = false;
    each_at(t, w, [&](int other) { (dot(d, face(other)) < 0 ? in : out) = true; });
    return in && out ? dot(d, outward(t, w)) < 0 : in;
  }
};

/// Lists the triangles that may come near each point while lists stay.
template <class B>
struct ListClose {
  using Real = typename B::Real;
  FindPairs<B> find;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    const PairTree<B>& tree = find.tree;
    const Vec3<Real> at = find.x(p);
    const Real far = tree.near();
    int count = 0;
    find.around(p, [&](int t) {
      if (find.has(t, p) || !find.allowed(p, t)) return;
      const Vec3<Real> d = find.off(at, t, find.nearest(at, t));
      if (dot(d, d) > far * far || !find.may_touch(p, t)) return;
      if (count < tree.longest) tree.listed(p * tree.longest + count) = t;
      ++count;
    });
    tree.close(p) = count;
  }
};

/// Returns a depth with limited change: it grows from 0, by little more than a site's approach to
/// its partner in a step, and falls as the site leaves. A site may count as inside for other
/// reasons, such as another triangle that is nearest. Without the limit this would store energy
/// that no force has put in, or push the site out for longer than it came in.
/// @param last    depth of the record in the last step [m]
/// @param way     way of the site against its partner in a step [m]
/// @param N       unit normal out of the partner
/// @param at_end  true where `last` is of the end of the last step. It has the approach already,
/// and only the partner's curvature adds to it
template <class Real>
KOKKOS_INLINE_FUNCTION Real limited_depth(Real depth, Real last, const Vec3<Real>& way,
                                          const Vec3<Real>& N, bool at_end) {
  constexpr Real bend = Real(0.1);
  const Real nearer = at_end ? Real(0) : -dot(N, way);
  return Kokkos::min(depth,
                     Kokkos::max(last, Real(0)) + nearer + bend * Kokkos::sqrt(dot(way, way)));
}

/// Finds the nearest triangle for each point's slot, the one with the lowest number where several
/// are nearest. A fast point looks as far as it may get, and its partner is a triangle that its
/// path leads through.
template <class B>
struct NearestTriangles {
  using Real = typename B::Real;
  /// Triangle, the point's distance to it, squared, and the weights of its corners there.
  struct Nearest {
    int triangle = -1;
    Real square;
    Vec3<Real> weight;
    bool inside = false;  ///< the point is inside the surface there; set in what partner() returns
  };
  FindPairs<B> find;
  bool fresh;  ///< true: nothing is known of the last step

  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    const ContactRecords<B>& records = find.records;
    const int r = records.of_point(records.obstacles, p), last = records.partner(p);
    records.partner(p) = -1;
    if (records.attached.holds(p)) {
      if (!records.is_torn(r)) return stretch(p, r);
      records.attached.tear(p);
    }
    if (!records.attached.ties(p) && find.tree.close(p) > 0)
      if (const Nearest found = partner(p, r, last); found.triangle >= 0 && record(p, r, found))
        return;
    records.depth(r) = -records.nowhere();
    records.leave(r);
  }

  KOKKOS_INLINE_FUNCTION Vec3<Real> corner(int t, int c) const { return find.x(find.corner(t, c)); }
  KOKKOS_INLINE_FUNCTION Vec3<Real> away_from(int p, const Nearest& n) const {
    return find.off(find.x(p), n.triangle, n.weight);
  }
  /// Returns the velocity of a point against a place on a triangle.
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
  /// Returns true where all of a triangle is further away than the root of `square`, by the box
  /// around it.
  KOKKOS_INLINE_FUNCTION bool is_beyond(const Vec3<Real>& at, int t, Real square) const {
    const Vec3<Real> a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    Real sum = 0;
    for (int k = 0; k < 3; ++k) {
      const Real low = Kokkos::min(a[k], Kokkos::min(b[k], c[k])),
                 high = Kokkos::max(a[k], Kokkos::max(b[k], c[k]));
      const Real d = Kokkos::max(Real(0), Kokkos::max(low - at[k], at[k] - high));
      sum += d * d;
    }
    return sum > square;
  }
  KOKKOS_INLINE_FUNCTION void take_nearer(int p, int t, Nearest& nearest) const {
    const Nearest n = near(p, t);
    if (n.square < nearest.square || (n.square == nearest.square && t < nearest.triangle))
      nearest = n;
  }

  /// Returns the triangle that a point may touch. `last`: the triangle of the last step, or -1.
  KOKKOS_INLINE_FUNCTION Nearest partner(int p, int r, int last) const {
    const PairTree<B>& tree = find.tree;
    const Real ordinary = tree.limits.reach, far = tree.closing(find.records.span);
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
    return fast ? on_path(p, r, nearest) : as_before(p, r, nearest);
  }

  /// Returns the triangle that a fast point may touch. It is the nearest one, if that will hold the
  /// point before its path leads through anything; else the one that the path leads through first.
  KOKKOS_INLINE_FUNCTION Nearest on_path(int p, int r, const Nearest& nearest) const {
    constexpr Real third = Real(1) / 3, little = Real(0.05);
    const Real h = find.records.span, ordinary = find.tree.limits.reach;
    const Vec3<Real> at = find.x(p), d = away_from(p, nearest);
    if (nearest.inside) return as_before(p, r, nearest);
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

  /// Returns the face by which a point that is inside leaves. It is the nearest face that does not
  /// point the other way than the one it came by: so it does not leave a thin body on the far side.
  KOKKOS_INLINE_FUNCTION Nearest as_before(int p, int r, const Nearest& nearest) const {
    constexpr Real other_way = Real(-0.2);
    if (!nearest.inside || find.records.near(r) == 0) return nearest;
    const Vec3<Real> N = vector_at<B>(find.records.normal, r);
    const auto turns = [&](const Nearest& n) {
      return dot(find.outward(n.triangle, n.weight), N) <= other_way;
    };
    if (!turns(nearest)) return nearest;
    Nearest other;
    other.square = find.tree.limits.reach * find.tree.limits.reach;
    find.each_near(p, [&](int t) {
      if (dot(FindPairs<B>::unit(find.face(t)), N) > other_way) take_nearer(p, t, other);
    });
    return other.triangle < 0 ? nearest : sided(p, other);
  }

  KOKKOS_INLINE_FUNCTION void join(int p, int r, int t, const Vec3<Real>& w) const {
    find.records.partner(p) = t;
    find.records.set_stencil(r, p, find.corner(t, 0), find.corner(t, 1), find.corner(t, 2), 1,
                             -w[0], -w[1], -w[2]);
  }

  /// Sets the slot of a point that is attached to a triangle.
  KOKKOS_INLINE_FUNCTION void stretch(int p, int r) const {
    const ContactRecords<B>& records = find.records;
    const int t = records.attached.triangle(p);
    const Vec3<Real> w = vector_at<B>(records.attached.weight, p);
    join(p, r, t, w);
    records.tie(r, records.attached.first_law + records.attached.attachment(p),
                find.off(find.x(p), t, w), {});
  }

  KOKKOS_INLINE_FUNCTION bool record(int p, int r, const Nearest& found) const {
    // part of the reach; no direction is known at a smaller distance
    constexpr Real tiny = sizeof(Real) == 4 ? Real(1e-4) : Real(1e-8);
    const ContactRecords<B>& records = find.records;
    const int t = found.triangle;
    const bool inside = found.inside;
    const Vec3<Real>&w = found.weight, d = away_from(p, found);
    const Real distance = Kokkos::sqrt(found.square), limit = find.tree.limits.reach;
    const bool on_face = w[0] > 0 && w[1] > 0 && w[2] > 0;
    // The far side of a thin part of its own body is no partner.
    if (inside && find.one_body(p, t) && distance > Real(0.25) * find.tree.limits.apart)
      return false;
    const bool by_surface = on_face || distance < tiny * limit;
    const Vec3<Real> N = by_surface ? find.outward(t, w) : ((inside ? -1 : 1) / distance) * d;
    Real depth = inside ? distance : -distance;
    if (!fresh)
      depth = limited_depth(depth, records.near(r) > 0 ? records.depth(r) : Real(0),
                            records.span * speed(p, t, w), N, records.is_implicit());
    join(p, r, t, w);
    records.use(r, records.pair_law(p, find.corner(t, 0)), N, depth, {},
                records.span * find.spin(t));
    return true;
  }
};

}  // namespace plica
