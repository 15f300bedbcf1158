// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/contact_records.hpp>
#include <plica/kernels/reduce.hpp>

// Broad phase of pairs: a uniform grid, of which each cell lists the triangles that may come near a
// point in it. These are the triangles whose boxes, enlarged by that nearness, reach into the cell.
// A cell is as wide as such a box is on average, and cells share a table by a hash. With the grid
// each point gets a list of the triangles that may come near; where there are more than the list
// holds, the point asks the grid itself. Grid and lists stay while nothing has moved by more than
// half of `margin`, and while nothing is so fast that in one step it meets triangles further away.
// Both are taken against the mean of all points, so that a body that flies needs no new grid. The
// device decides this, and leaves out the work.
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
  KOKKOS_INLINE_FUNCTION void add(const Vec3<Real>& x) {
    for (int k = 0; k < 3; ++k)
      low[k] = Kokkos::min(low[k], x[k]), high[k] = Kokkos::max(high[k], x[k]);
  }
  KOKKOS_INLINE_FUNCTION void enlarge(Real by) {
    for (int k = 0; k < 3; ++k) low[k] -= by, high[k] += by;
  }
  KOKKOS_INLINE_FUNCTION Real longest_side() const {
    return Kokkos::max(high[0] - low[0], Kokkos::max(high[1] - low[1], high[2] - low[2]));
  }
  /// Returns whether the box ends. In a state that is not sound it may reach into any number of
  /// cells.
  KOKKOS_INLINE_FUNCTION bool ends() const { return is_finite(low) && is_finite(high); }
  KOKKOS_INLINE_FUNCTION bool meets(const Box3& other) const {
    bool meet = true;
    for (int k = 0; k < 3; ++k) meet = meet && low[k] <= other.high[k] && other.low[k] <= high[k];
    return meet;
  }
};

/// Cell of a grid.
struct GridCell {
  int i, j, k;
  KOKKOS_INLINE_FUNCTION bool operator==(const GridCell& c) const {
    return i == c.i && j == c.j && k == c.k;
  }
  KOKKOS_INLINE_FUNCTION GridCell or_after(const GridCell& c) const {
    return {Kokkos::max(i, c.i), Kokkos::max(j, c.j), Kokkos::max(k, c.k)};
  }
};

template <class B>
struct PairGrid {
  using Real = typename B::Real;
  PairLimits<Real> limits;
  int buckets = 0;   ///< a power of two
  Vectors<B> x;      ///< [points][3] present positions [m]
  Vectors<B> built;  ///< [points][3] positions when the grid was made [m]
  Doubles<B> mean;   ///< [6] mean of all points: way from built to x [m], velocity [m/s]
  /// [2] against the mean: largest squared way [m^2], and largest squared speed [m^2/s^2]
  Doubles<B> moved;
  Scalars<B> reach;  ///< [1] reach that the grid was made for [m]
  Doubles<B> stale;  ///< [1] above 0: the grid is being made
  /// [2] sum of the longest sides of the triangles' boxes, and the longest of them [m]
  Doubles<B> extent;
  Scalars<B> width;   ///< [1] width of a cell [m]
  Indices<B> first;   ///< [buckets] into item
  Indices<B> filled;  ///< [buckets] items of each
  Indices<B> item;    ///< [triangles * most_cells] triangles, of one cell after the other
  /// Maximum of cells that a triangle reaches into, on average; see SetWidth
  static constexpr int most_cells = 48;
  Indices<B> ridge;                   ///< [edges] 1: it might cross another when the grid was made
  static constexpr int longest = 32;  ///< maximum length of a list of triangles
  /// [points] number of triangles that may come within reach before the grid is made anew
  Indices<B> close;
  Indices<B> listed;  ///< [points * longest] these triangles
  static constexpr int most_crossings = 16;
  /// [points] number of edges that may cross one that begins in the point, before a new grid is
  /// made
  Indices<B> crossings;
  Indices<B> crossing;  ///< [points * most_crossings * 2] pairs: the own edge, the other

  /// Returns how far two points can move against each other in a step of h seconds [m]. It is
  /// bounded, for states that are not sound.
  KOKKOS_INLINE_FUNCTION Real closing(Real h) const {
    constexpr Real reaches = 32;  // 16 edges
    return Kokkos::min(2 * h * static_cast<Real>(Kokkos::sqrt(moved(1))), reaches * limits.reach);
  }
  /// Returns how far apart edges are looked for [m]. Edges that are not fast move less in a step.
  KOKKOS_INLINE_FUNCTION Real edge_reach() const {
    return reach(0) > limits.reach ? reach(0) : Real(0.5) * reach(0);
  }
  KOKKOS_INLINE_FUNCTION int cell(Real coordinate) const {
    constexpr Real most = Real(1 << 30);
    return static_cast<int>(
        Kokkos::floor(Kokkos::max(-most, Kokkos::min(most, coordinate / width(0)))));
  }
  KOKKOS_INLINE_FUNCTION int bucket(int i, int j, int k) const {
    const unsigned mixed = static_cast<unsigned>(i) * 73856093u ^
                           static_cast<unsigned>(j) * 19349663u ^
                           static_cast<unsigned>(k) * 83492791u;
    return static_cast<int>(mixed & static_cast<unsigned>(buckets - 1));
  }
  /// Returns how much larger than its triangle a box is, on all sides [m].
  KOKKOS_INLINE_FUNCTION Real near() const { return reach(0) + limits.margin; }
  KOKKOS_INLINE_FUNCTION GridCell cell_of(const Vec3<Real>& at) const {
    return {cell(at[0]), cell(at[1]), cell(at[2])};
  }
  /// Calls use(cell, its bucket) for all cells that a box reaches into; for none where it has no
  /// end.
  template <class Use>
  KOKKOS_INLINE_FUNCTION void each_cell(const Box3<Real>& box, const Use& use) const {
    if (!box.ends()) return;
    const GridCell low = cell_of(box.low), high = cell_of(box.high);
    for (int i = low.i; i <= high.i; ++i)
      for (int j = low.j; j <= high.j; ++j)
        for (int k = low.k; k <= high.k; ++k) use(GridCell{i, j, k}, bucket(i, j, k));
  }
  /// Calls look(triangle) for all triangles that may come near what was in this box when the grid
  /// was made. Each comes in the first cell that both reach into; where cells share a bucket, some
  /// come twice.
  template <class Look>
  KOKKOS_INLINE_FUNCTION void around(const Box3<Real>& box, const Indices<B>& corner,
                                     const Look& look) const {
    const GridCell low = cell_of(box.low);
    each_cell(box, [&](const GridCell& at, int b) {
      for (int s = first(b); s < first(b) + filled(b); ++s) {
        const int t = item(s);
        const Box3<Real> its = box_of(corner, t);
        if (its.meets(box) && at == cell_of(its.low).or_after(low)) look(t);
      }
    });
  }
  /// Returns the enlarged box of a triangle when the grid was made.
  KOKKOS_INLINE_FUNCTION Box3<Real> box_of(const Indices<B>& corner, int t) const {
    Box3<Real> box(vector_at<B>(built, corner(3 * t)));
    for (int c = 1; c < 3; ++c) box.add(vector_at<B>(built, corner(3 * t + c)));
    box.enlarge(near());
    return box;
  }
};

/// Computes how a point has moved since the grid was made, and its velocity.
template <class B>
struct MotionOfPoint {
  EmbeddedSurface<B> surface;
  Vectors<B> v;
  PairGrid<B> grid;
  KOKKOS_INLINE_FUNCTION Sums<6> operator()(int p) const {
    const auto way = vector_at<B>(grid.x, p) - vector_at<B>(grid.built, p),
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
      const double d = motion[k] - of.grid.mean(k);
      square[k / 3] += d * d;
    }
    return square;
  }
};

template <class B>
struct JudgeGrid {
  using Real = typename B::Real;
  PairGrid<B> grid;
  Real h;  ///< step [s]
  KOKKOS_INLINE_FUNCTION void operator()() const {
    const double half = 0.5 * static_cast<double>(grid.limits.margin);
    const Real least = grid.limits.reach, needed = Kokkos::max(least, grid.closing(h));
    const bool fits = needed <= grid.reach(0) && grid.reach(0) <= Kokkos::max(least, 4 * needed);
    if (!fits) grid.reach(0) = needed > least ? Real(1.5) * needed : least;
    // maxima leave out NaN, sums do not
    const bool sound = Kokkos::isfinite(grid.mean(0) + grid.mean(1) + grid.mean(2));
    grid.stale(0) = fits && sound && grid.moved(0) <= half * half ? 0 : 1;
  }
};

template <class B>
struct MeasureTriangles {
  Indices<B> corner;
  PairGrid<B> grid;
  KOKKOS_INLINE_FUNCTION Sums<2, 1> operator()(int t) const {
    if (!(grid.stale(0) > 0)) return {};
    const auto box = grid.box_of(corner, t);
    if (!box.ends()) return {};
    const auto side = static_cast<double>(box.longest_side());
    return {{side, side}};
  }
};

/// Sets the width of cells: the mean of the boxes' longest sides l, but no less than a third of the
/// longest. Then triangles reach into 48 cells each on average, or less. A triangle of l in cells
/// of w reaches into (l/w + 2)^3 cells at most. n triangles with l <= 3 w and a mean of w reach
/// into the most cells where n/3 are as long as they can be.
template <class B>
struct SetWidth {
  PairGrid<B> grid;
  int triangles;
  KOKKOS_INLINE_FUNCTION void operator()() const {
    if (grid.stale(0) > 0)
      grid.width(0) = static_cast<typename B::Real>(
          Kokkos::max(grid.extent(0) / triangles, grid.extent(1) / 3));
  }
};

template <class B>
struct ClearInts {
  Indices<B> of;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const { of(i) = 0; }
};

template <class B>
struct KeepPlaces {
  PairGrid<B> grid;
  KOKKOS_INLINE_FUNCTION void operator()(int p) const {
    set_vector<B>(grid.built, p, vector_at<B>(grid.x, p));
  }
};

template <class B>
struct CountCells {
  Indices<B> corner;
  PairGrid<B> grid;
  KOKKOS_INLINE_FUNCTION void operator()(int t) const {
    grid.each_cell(grid.box_of(corner, t),
                   [&](const GridCell&, int b) { Kokkos::atomic_inc(&grid.filled(b)); });
  }
};

/// Computes first(i) = the sum of count(j) for j < i, i up to n. It is left out where `on` is 0.
template <class B>
struct SumBefore {
  Indices<B> count, first;
  int n;
  Doubles<B> on;
  KOKKOS_INLINE_FUNCTION void operator()(int i, int& sum, bool final) const {
    if (!(on(0) > 0)) return;
    const int own = i < n ? count(i) : 0;
    if (final) first(i) = sum;
    sum += own;
  }
};

/// Puts triangles into their cells, whose counts start from 0 again. The order is any: a search
/// takes the nearest triangle.
template <class B>
struct FillCells {
  Indices<B> corner;
  PairGrid<B> grid;
  KOKKOS_INLINE_FUNCTION void operator()(int t) const {
    grid.each_cell(grid.box_of(corner, t), [&](const GridCell&, int b) {
      grid.item(grid.first(b) + Kokkos::atomic_fetch_add(&grid.filled(b), 1)) = t;
    });
  }
};

}  // namespace plica
