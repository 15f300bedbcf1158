// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/contact_records.hpp>
#include <plica/kernels/reduce.hpp>

// Broad phase of pairs: a tree of boxes around the surface's triangles. Its leaves are triangles in
// an order that stays, so that places that are close at the start are close in the tree, and boxes
// follow the surface. A block has the boxes of its eight children, which a CPU compares together.
//
//   block 0          |. . . . . . . .|
//                     /       |
//   blocks 1 to 8    |. . .| |. . .| ...      children of block b: 8 b + 1, 8 b + 2, ...
//                     |
//   blocks with      |. . .| ...              triangles order(0), order(1), ...
//   triangles
//
// With the tree each point gets a list of the triangles that may come near; where there are more
// than the list holds, the point asks the tree itself. Boxes and lists stay while nothing has moved
// by more than half of `margin`. Where something is so fast that they would not outlast a step,
// they are made in every step, as far as things move in it. Both are taken against the mean of all
// points, so that a body that flies needs no new lists. The device decides this, and leaves out the
// work.
namespace plica {

/// Returns whether all components are finite.
template <class Real>
KOKKOS_INLINE_FUNCTION bool is_finite(const Vec3<Real>& x) {
  return Kokkos::isfinite(x[0]) && Kokkos::isfinite(x[1]) && Kokkos::isfinite(x[2]);
}

/// Box along the axes.
template <class Real>
struct Box3 {
  Vec3<Real> low, high;
  explicit KOKKOS_INLINE_FUNCTION Box3(const Vec3<Real>& x) : low(x), high(x) {}
  /// Returns a box that meets nothing.
  static KOKKOS_INLINE_FUNCTION Box3 none() {
    constexpr Real far = Kokkos::Experimental::finite_max_v<Real>;
    Box3 box({far, far, far});
    box.high = {-far, -far, -far};
    return box;
  }
  KOKKOS_INLINE_FUNCTION void add(const Vec3<Real>& x) {
    for (int k = 0; k < 3; ++k)
      low[k] = Kokkos::min(low[k], x[k]), high[k] = Kokkos::max(high[k], x[k]);
  }
  KOKKOS_INLINE_FUNCTION void enlarge(Real by) {
    for (int k = 0; k < 3; ++k) low[k] -= by, high[k] += by;
  }
  /// Returns whether the box ends. In a state that is not sound it may be without end.
  KOKKOS_INLINE_FUNCTION bool ends() const { return is_finite(low) && is_finite(high); }
  KOKKOS_INLINE_FUNCTION bool meets(const Box3& other) const {
    bool meet = true;
    for (int k = 0; k < 3; ++k) meet = meet && low[k] <= other.high[k] && other.low[k] <= high[k];
    return meet;
  }
};

template <class B>
struct PairTree {
  using Real = typename B::Real;
  static constexpr int wide = 8;  ///< children of a block
  PairLimits<Real> limits;
  int inner = 0;     ///< number of blocks whose children are blocks; those of triangles follow
  int blocks = 0;    ///< number of all blocks
  Indices<B> order;  ///< [triangles] triangles along the tree, see order_by_halves()
  Vectors<B> x;      ///< [points][3] present positions [m]
  Vectors<B> built;  ///< [points][3] positions that the boxes and lists are of [m]
  Doubles<B> mean;   ///< [6] mean of all points: way from built to x [m], velocity [m/s]
  /// [2] against the mean: largest squared way [m^2], and largest squared speed [m^2/s^2]
  Doubles<B> moved;
  Scalars<B> reach;   ///< [1] reach that the lists were made for [m]
  Scalars<B> margin;  ///< [1] limits.margin, or 0 where the lists are for one step [m]
  Doubles<B> stale;   ///< [1] above 0: boxes and lists are being made
  /// [blocks * 6 * wide] boxes of each block's children: their lows along x, along y, along z, then
  /// their highs [m]
  Scalars<B> bounds;
  Indices<B> ridge;                   ///< [edges] 1: it might cross another when lists were made
  static constexpr int longest = 32;  ///< maximum length of a list of triangles
  /// [points] number of triangles that may come within reach before lists are made anew
  Indices<B> close;
  Indices<B> listed;  ///< [points * longest] these triangles
  static constexpr int most_crossings = 16;
  /// [points] number of edges that may cross one that begins in the point, before lists are made
  /// anew
  Indices<B> crossings;
  Indices<B> crossing;  ///< [points * most_crossings * 2] pairs: the own edge, the other

  /// Returns how far two points can move against each other in a step of h seconds [m]. It is
  /// bounded, for states that are not sound.
  KOKKOS_INLINE_FUNCTION Real closing(Real h) const {
    constexpr Real reaches = 32;  // 16 edges
    return Kokkos::min(2 * h * static_cast<Real>(Kokkos::sqrt(moved(1))), reaches * limits.reach);
  }
  /// Returns how near to a point the triangles are that it lists [m].
  KOKKOS_INLINE_FUNCTION Real near() const { return reach(0) + margin(0); }
  /// Returns how near to each other edges are that are listed, for a step of h seconds [m]. Where
  /// lists last, edges move less than half of the reach in a step.
  KOKKOS_INLINE_FUNCTION Real edges_near(Real h) const {
    return margin(0) > 0 ? Real(0.5) * reach(0) + margin(0) : closing(h);
  }
  KOKKOS_INLINE_FUNCTION Real* bounds_of(int block) const {
    return bounds.data() + static_cast<std::ptrdiff_t>(block) * 6 * wide;
  }
  /// Calls look(triangle) once for all triangles whose boxes meet this one; for none where it has
  /// no end.
  template <class Look>
  KOKKOS_INLINE_FUNCTION void around(const Box3<Real>& box, const Look& look) const {
    constexpr int most = 80;  // blocks that may wait: seven of each level, of which there are 11
    int waiting[most], count = 0;
    if (box.ends()) waiting[count++] = 0;
    while (count > 0) {
      const int b = waiting[--count];
      const Real* const at = bounds_of(b);
      unsigned meet = 0;
      for (int c = 0; c < wide; ++c) {
        const bool meets = (at[c] <= box.high[0]) & (at[wide + c] <= box.high[1]) &
                           (at[2 * wide + c] <= box.high[2]) & (box.low[0] <= at[3 * wide + c]) &
                           (box.low[1] <= at[4 * wide + c]) & (box.low[2] <= at[5 * wide + c]);
        meet |= static_cast<unsigned>(meets) << c;
      }
      for (; meet != 0; meet &= meet - 1) {
        const int c = Kokkos::Experimental::countr_zero_builtin(meet);
        if (b < inner)
          waiting[count++] = wide * b + 1 + c;
        else
          look(order(wide * (b - inner) + c));
      }
    }
  }
};

/// Computes how a point has moved since the lists were made, and its velocity.
template <class B>
struct MotionOfPoint {
  EmbeddedSurface<B> surface;
  Vectors<B> v;
  PairTree<B> tree;
  KOKKOS_INLINE_FUNCTION Sums<6> operator()(int p) const {
    const auto way = vector_at<B>(tree.x, p) - vector_at<B>(tree.built, p),
               own = value_at<B>(surface.embedding, v, p);
    Sums<6> motion;
    for (int k = 0; k < 3; ++k)
      motion[k] = static_cast<double>(way[k]), motion[3 + k] = static_cast<double>(own[k]);
    return motion;
  }
};
/// Turns sums into means.
template <class B>
struct MeanOfPoints {
  Doubles<B> mean;
  double over;
  KOKKOS_INLINE_FUNCTION void operator()() const {
    for (int k = 0; k < 6; ++k) mean(k) *= over;
  }
};

/// Computes the squares of a point's way and velocity against the mean.
template <class B>
struct MotionAgainstMean {
  MotionOfPoint<B> of;
  KOKKOS_INLINE_FUNCTION Sums<2, 2> operator()(int p) const {
    const Sums<6> motion = of(p);
    Sums<2, 2> square;
    for (int k = 0; k < 6; ++k) {
      const double d = motion[k] - of.tree.mean(k);
      square[k / 3] += d * d;
    }
    return square;
  }
};

/// Decides whether lists stay. Where they would not outlast the next step, they are made for this
/// step alone, without a margin, and hold less.
template <class B>
struct JudgeLists {
  using Real = typename B::Real;
  PairTree<B> tree;
  Real h;  ///< step [s]
  KOKKOS_INLINE_FUNCTION void operator()() const {
    const double half = 0.5 * static_cast<double>(tree.limits.margin);
    const bool last = static_cast<double>(tree.closing(h)) <= 2 * half, lasted = tree.margin(0) > 0;
    // maxima leave out NaN, sums do not
    const bool sound = Kokkos::isfinite(tree.mean(0) + tree.mean(1) + tree.mean(2));
    tree.reach(0) = last ? tree.limits.reach : Kokkos::max(tree.limits.reach, tree.closing(h));
    tree.margin(0) = last ? tree.limits.margin : Real(0);
    tree.stale(0) = last && lasted && sound && tree.moved(0) <= half * half ? 0 : 1;
  }
};

template <class B>
struct KeepPlaces {
  PairTree<B> tree;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    set_vector<B>(tree.built, p, vector_at<B>(tree.x, p));
  }
};

/// Computes the boxes of a block's children. Triangles with places that are not finite, and
/// children that are not there, have boxes that meet nothing.
template <class B>
struct BoundBlocks {
  using Real = typename B::Real;
  SurfaceMesh<B> mesh;
  PairTree<B> tree;
  int first;  ///< first of the blocks

  KOKKOS_INLINE_FUNCTION Box3<Real> around_triangle(int t) const {
    const auto x = [&](int c) { return vector_at<B>(tree.built, mesh.corner(3 * t + c)); };
    Box3<Real> box(x(0));
    box.add(x(1)), box.add(x(2));
    return is_finite(x(0)) && is_finite(x(1)) && is_finite(x(2)) ? box : Box3<Real>::none();
  }
  KOKKOS_INLINE_FUNCTION Box3<Real> around_block(int b) const {
    constexpr int wide = PairTree<B>::wide;
    Box3<Real> box = Box3<Real>::none();
    const Real* const at = tree.bounds_of(b);
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < wide; ++c) {
        box.low[k] = Kokkos::min(box.low[k], at[k * wide + c]);
        box.high[k] = Kokkos::max(box.high[k], at[(3 + k) * wide + c]);
      }
    return box;
  }
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    constexpr int wide = PairTree<B>::wide;
    const int b = first + i;
    Real* const at = tree.bounds_of(b);
    for (int c = 0; c < wide; ++c) {
      const int child = b < tree.inner ? wide * b + 1 + c : wide * (b - tree.inner) + c;
      Box3<Real> box = Box3<Real>::none();
      if (b < tree.inner && child < tree.blocks) box = around_block(child);
      if (b >= tree.inner && child < mesh.triangles) box = around_triangle(tree.order(child));
      for (int k = 0; k < 3; ++k)
        at[k * wide + c] = box.low[k], at[(3 + k) * wide + c] = box.high[k];
    }
  }
};

}  // namespace plica
