// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/find_pairs.hpp>
#include <plica/kernels/contact/gap_of_edges.hpp>

// Contact of edges with edges: two ridges cross, and no point of one is near the other's surface.
//
//   edges that begin    --(1)--> list of      --(2)--> where two meet:  --(3)--> the point's pair
//   in each point                each point,           depth, less the           of edges: it will
//                                kept as long as       depth of their            be the deepest
//                                the lists stay        ends
namespace plica {

/// Geometry of edges, at the positions in a tree's `x`.
template <class B>
struct FindEdges {
  using Real = typename B::Real;
  FindPairs<B> find;

  KOKKOS_INLINE_FUNCTION int end(int e, int i) const { return find.records.mesh.edge(4 * e + i); }
  KOKKOS_INLINE_FUNCTION Vec3<Real> x(int e, int i) const { return find.x(end(e, i)); }
  KOKKOS_INLINE_FUNCTION SurfaceEdge<Real> at(int e) const {
    return {x(e, 0), x(e, 1), x(e, 2), x(e, 3)};
  }
  /// Returns true where an edge may cross another.
  KOKKOS_INLINE_FUNCTION bool may_cross(int e) const {
    const Attachments<B>& attached = find.records.attached;
    if (end(e, 2) < 0 || end(e, 3) < 0 || attached.ties(end(e, 0)) || attached.ties(end(e, 1)))
      return false;
    const SurfaceEdge<Real> edge = at(e);
    return is_finite(edge.begin) && is_finite(edge.end) && is_finite(edge.left) &&
           is_finite(edge.right) && may_be_steep(edge);
  }
  /// Calls look(own edge, other edge) for all edges that begin in p, and all with a higher number
  /// that may cross them. The order is any; some come twice. `within`: distance at which boxes of
  /// edges count as near [m].
  template <class Look>
  KOKKOS_INLINE_FUNCTION void search(int p, Real within, const Look& look) const {
    const SurfaceMesh<B>& mesh = find.records.mesh;
    for (int e = mesh.first_edge(p); e < mesh.first_edge(p + 1); ++e)
      if (find.tree.ridge(e) > 0) search_around(e, within, look);
  }
  template <class Look>
  KOKKOS_INLINE_FUNCTION void search_around(int e, Real within, const Look& look) const {
    const int begin = end(e, 0), other = end(e, 1);
    Box3<Real> box(vector_at<B>(find.tree.built, begin));
    box.add(vector_at<B>(find.tree.built, other));
    box.enlarge(within);
    find.tree.around(box, [&](int t) {
      if (find.has(t, begin) || find.has(t, other) || !find.allowed(begin, t)) return;
      for (int c = 0; c < 3; ++c)
        if (const int f = find.records.mesh.side(3 * t + c);
            f > e && find.tree.ridge(f) > 0 && are_near(e, f, t))
          look(e, f);
    });
  }
  /// Returns true where edges e and f are near each other and may touch; `t` is a triangle of f.
  KOKKOS_INLINE_FUNCTION bool are_near(int e, int f, int t) const {
    const Real far = find.tree.edges_near(find.records.span);
    Box3<Real> its(x(f, 0)), own(x(e, 0));
    its.add(x(f, 1)), own.add(x(e, 1)), own.enlarge(far);
    if (!own.meets(its)) return false;
    return squared_distance_of_segments(x(e, 0), x(e, 1), x(f, 0), x(f, 1)) < far * far &&
           find.may_touch(end(e, 0), t) && find.may_touch(end(e, 1), t);
  }
  /// Calls look(own edge, other edge) for the listed pairs of p; without a complete list, by
  /// search().
  template <class Look>
  KOKKOS_INLINE_FUNCTION void each_near(int p, const Look& look) const {
    const PairTree<B>& tree = find.tree;
    const int count = tree.crossings(p), first = 2 * p * tree.most_crossings;
    if (count > tree.most_crossings) return search(p, tree.near(), look);
    for (int i = first; i < first + 2 * count; i += 2) look(tree.crossing(i), tree.crossing(i + 1));
  }
};

/// Marks the edges that may cross others while lists stay.
template <class B>
struct MarkRidges {
  FindEdges<B> edges;
  KOKKOS_INLINE_FUNCTION void operator()(int e) const {
    edges.find.tree.ridge(e) = edges.may_cross(e) ? 1 : 0;
  }
};

/// Lists the edges that may come near those of each point while lists stay.
template <class B>
struct ListCrossings {
  FindEdges<B> edges;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    constexpr int most = PairTree<B>::most_crossings;
    const PairTree<B>& tree = edges.find.tree;
    const int first = 2 * p * most;
    int count = 0;
    edges.search(p, tree.edges_near(edges.find.records.span), [&](int e, int f) {
      for (int i = 0; i < count && i < most; ++i)
        if (tree.crossing(first + 2 * i) == e && tree.crossing(first + 2 * i + 1) == f) return;
      if (count < most)
        tree.crossing(first + 2 * count) = e, tree.crossing(first + 2 * count + 1) = f;
      ++count;
    });
    tree.crossings(p) = count;
  }
};

/// Finds the pair of edges for each point's slot of two edges: the pair that will be the deepest
/// after the step. Its depth is the part beyond the depths of the ends, so that nothing is pushed
/// twice. It runs after NearestTriangles.
template <class B>
struct DeepestCrossings {
  using Real = typename B::Real;
  struct Crossing {
    int own = -1, other = -1;
    Real depth, later;  ///< now, and after the step
    Vec3<Real> velocity;
    EdgeGap<Real> gap;
    /// Returns true where this crossing is deeper, or equal with lower numbers. So the order of the
    /// search does not matter.
    KOKKOS_INLINE_FUNCTION bool is_before(const Crossing& c) const {
      if (c.own < 0 || later != c.later) return c.own < 0 || later > c.later;
      return own < c.own || (own == c.own && other < c.other);
    }
  };
  FindEdges<B> edges;
  bool fresh;  ///< true: nothing is known of the last step

  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    const ContactRecords<B>& records = edges.find.records;
    const PairTree<B>& tree = edges.find.tree;
    const int r = records.of_point(records.obstacles + 1, p);
    if (tree.crossings(p) == 0) return records.leave(r);
    Crossing deepest;
    edges.each_near(p, [&](int e, int f) {
      const EdgeGap<Real> gap = gap_of(e, f);
      if (!gap.meet || gap.depth > tree.limits.reach) return;
      const Vec3<Real> velocity = speed(e, f, gap);
      const Real now = depth(e, f, gap), later = now - records.span * dot(gap.normal, velocity);
      if (gap.depth < -Real(0.5) * tree.limits.reach && later < 0) return;
      const Crossing found{e, f, now, later, velocity, gap};
      if (found.is_before(deepest)) deepest = found;
    });
    if (deepest.own < 0) return records.leave(r);
    Real its = deepest.depth;
    if (!fresh)
      its =
          limited_depth(its, records.near(r) > 0 ? records.depth(r) : Real(0),
                        records.span * deepest.velocity, deepest.gap.normal, records.is_implicit());
    const Real own = deepest.gap.own, other = deepest.gap.other;
    const int a = edges.end(deepest.own, 0), c = edges.end(deepest.other, 0);
    records.set_stencil(r, a, edges.end(deepest.own, 1), c, edges.end(deepest.other, 1), 1 - own,
                        own, other - 1, -other);
    records.use(r, records.pair_law(a, c), deepest.gap.normal, its, {}, {});
  }

  static KOKKOS_INLINE_FUNCTION Vec3<Real> between(const Vec3<Real>& a, const Vec3<Real>& b,
                                                   Real part) {
    return (1 - part) * a + part * b;
  }
  KOKKOS_INLINE_FUNCTION Vec3<Real> v(int e, Real part) const {
    return between(edges.find.v(edges.end(e, 0)), edges.find.v(edges.end(e, 1)), part);
  }
  KOKKOS_INLINE_FUNCTION Vec3<Real> speed(int e, int f, const EdgeGap<Real>& gap) const {
    return v(e, gap.own) - v(f, gap.other);
  }
  KOKKOS_INLINE_FUNCTION EdgeGap<Real> gap_of(int e, int f) const {
    const Real half = Real(0.5);
    return gap_of_edges(edges.at(e), edges.at(f),
                        edges.find.records.span * (v(e, half) - v(f, half)));
  }
  /// Returns the depth of a crossing, less the depth of the ends of either edge by themselves.
  KOKKOS_INLINE_FUNCTION Real depth(int e, int f, const EdgeGap<Real>& gap) const {
    const ContactRecords<B>& records = edges.find.records;
    const auto felt = [&](int edge, Real part) {
      Real sum = 0;
      for (int i = 0; i < 2; ++i) {
        const Real own = records.depth(records.of_point(records.obstacles, edges.end(edge, i)));
        sum += (i == 0 ? 1 - part : part) * Kokkos::max(Real(0), own);
      }
      return sum;
    };
    if (!(gap.depth > 0)) return gap.depth;
    return gap.share * (gap.depth - Kokkos::max(felt(e, gap.own), felt(f, gap.other)));
  }
};

}  // namespace plica
