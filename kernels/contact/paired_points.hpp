// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/surface.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

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
      value += part_of(pair, c, bounding) * value_at<B>(surface.embedding, x, other(3 * pair + c));
    return own_weight(pair) * value_at<B>(surface.embedding, x, pair < points ? pair : pair - points) + value;
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

}  // namespace plica
