// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/contact_records.hpp>
#include <plica/kernels/reduce.hpp>

// The broad phase of pairs: a uniform grid, of which each cell lists the triangles that may come
// near a point in it: those whose boxes, made larger by how near that is, reach into it. A cell is
// as wide as such a box is on average, and cells share a table by a hash. With the grid each point
// gets a list of the triangles that may come near; where there are more than it holds, it asks the
// grid itself. Both stay while nothing has moved by more than half of `margin` and nothing is so
// fast that it meets in one step what is further away, each against the mean of all points: what
// flies needs no new grid. The device decides that, and leaves out the work.
namespace plica {

/// A box along the axes.
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
  KOKKOS_INLINE_FUNCTION bool meets(const Box3& other) const {
    bool meet = true;
    for (int k = 0; k < 3; ++k) meet = meet && low[k] <= other.high[k] && other.low[k] <= high[k];
    return meet;
  }
};

/// Of a grid.
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
  Vectors<B> x;      ///< [points][3] now [m]
  Vectors<B> built;  ///< [points][3] when the grid was made [m]
  Doubles<B> mean;   ///< [6] of all points: way between these [m], velocity [m/s]
  /// [2] against it: largest squared way [m^2], and largest squared speed [m^2/s^2]
  Doubles<B> moved;
  Scalars<B> reach;  ///< [1] what it was made for [m]
  Doubles<B> stale;  ///< [1] above 0: the grid is being made
  /// [2] of the triangles' boxes, then: the longest sides' sum and the longest of them [m]
  Doubles<B> extent;
  Scalars<B> width;   ///< [1] of a cell [m]
  Indices<B> first;   ///< [buckets] into item
  Indices<B> filled;  ///< [buckets] items of each
  Indices<B> item;    ///< [triangles * most_cells] triangles, of one cell after the other
  static constexpr int most_cells = 48;  ///< that a triangle reaches into, on average; see SetWidth
  Indices<B> ridge;                      ///< [edges] 1: it may cross another, then
  static constexpr int longest = 32;     ///< list of triangles
  /// [points] how many triangles may come within reach before the grid is made anew
  Indices<B> close;
  Indices<B> listed;  ///< [points * longest] these
  static constexpr int most_crossings = 16;
  /// [points] how many edges may come to cross one that begins in the point, likewise
  Indices<B> crossings;
  Indices<B> crossing;  ///< [points * most_crossings * 2] these: the own edge, the other

  /// use(field) for all of its own.
  template <class Self, class Use>
  static void each_own(Self& g, const Use& use) {
    use(g.built), use(g.mean), use(g.moved), use(g.reach), use(g.stale), use(g.extent),
        use(g.width), use(g.first);
    use(g.filled), use(g.item), use(g.ridge), use(g.close), use(g.listed), use(g.crossings);
    use(g.crossing);
  }
  /// How far two points can move against each other in a step of h [s]; bounded where a state is no
  /// longer sound.
  KOKKOS_INLINE_FUNCTION Real closing(Real h) const {
    constexpr Real reaches = 32;  // 16 edges
    return Kokkos::min(2 * h * static_cast<Real>(Kokkos::sqrt(moved(1))), reaches * limits.reach);
  }
  /// How far apart edges are looked for: what is not fast moves less in a step [m].
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
  /// How much larger than its triangle a box is, on all sides [m].
  KOKKOS_INLINE_FUNCTION Real near() const { return reach(0) + limits.margin; }
  KOKKOS_INLINE_FUNCTION GridCell cell_of(const Vec3<Real>& at) const {
    return {cell(at[0]), cell(at[1]), cell(at[2])};
  }
  /// use(cell, its bucket) for all cells that a box reaches into.
  template <class Use>
  KOKKOS_INLINE_FUNCTION void each_cell(const Box3<Real>& box, const Use& use) const {
    const GridCell low = cell_of(box.low), high = cell_of(box.high);
    for (int i = low.i; i <= high.i; ++i)
      for (int j = low.j; j <= high.j; ++j)
        for (int k = low.k; k <= high.k; ++k) use(GridCell{i, j, k}, bucket(i, j, k));
  }
  /// look(triangle) for all that may come near what was in this box when the grid was made: each in
  /// the first cell that both reach into; where cells share a bucket, some come twice.
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
  /// Of a triangle, when the grid was made; enlarged.
  KOKKOS_INLINE_FUNCTION Box3<Real> box_of(const Indices<B>& corner, int t) const {
    Box3<Real> box(vector_at<B>(built, corner(3 * t)));
    for (int c = 1; c < 3; ++c) box.add(vector_at<B>(built, corner(3 * t + c)));
    box.enlarge(near());
    return box;
  }
};

/// How a point has moved since the grid was made, and its velocity.
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
/// Sums become means.
template <class B>
struct MeanOfPoints {
  Doubles<B> mean;
  double over;
  KOKKOS_INLINE_FUNCTION void operator()() const {
    for (int k = 0; k < 6; ++k) mean(k) *= over;
  }
};

/// The squares of both, against the mean.
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
    grid.stale(0) = fits && grid.moved(0) <= half * half ? 0 : 1;
  }
};

template <class B>
struct MeasureTriangles {
  Indices<B> corner;
  PairGrid<B> grid;
  KOKKOS_INLINE_FUNCTION Sums<2, 1> operator()(int t) const {
    if (!(grid.stale(0) > 0)) return {};
    const auto side = static_cast<double>(grid.box_of(corner, t).longest_side());
    return {{side, side}};
  }
};

/// The mean of the sides l, but no less than a third of the longest: then triangles reach into 48
/// cells each, or less. One of l in cells of w reaches into (l/w + 2)^3 at most, and n of them with
/// l <= 3 w and a mean of w into most where n/3 are as long as they can be.
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

/// first(i) = the sum of count(j) for j < i, i up to one more than there are where `last`; left out
/// where `on` is 0.
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

/// Puts triangles into their cells, whose counts start from 0 again. In any order: who looks takes
/// the nearest.
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
