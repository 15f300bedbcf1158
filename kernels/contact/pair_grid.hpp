// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/contact_records.hpp>
#include <plica/kernels/reduce.hpp>

// The broad phase of pairs: triangles in the cells of a uniform grid, by their centroids. A cell is as wide as what is to be found
// around a point, so that 27 of them hold all of it, and cells share a table by a hash. With the grid each point gets a list of the
// triangles that may come near; where there are more than it holds, it asks the grid itself. Both stay while nothing has moved by more
// than half of `margin` and nothing is so fast that it meets in one step what is further away; the device decides that, and leaves
// out the work.
namespace plica {

template <class B>
struct PairGrid {
  using Real = typename B::Real;
  PairLimits<Real> limits;
  int buckets = 0;    ///< a power of two
  Vectors<B> x;       ///< [points][3] now [m]
  Vectors<B> built;   ///< [points][3] when the grid was made [m]
  Doubles<B> moved;   ///< [2] largest squared distance between these [m^2], and largest squared speed [m^2/s^2]
  Scalars<B> reach;   ///< [1] what it was made for [m]
  Doubles<B> stale;   ///< [1] above 0: the grid is being made
  Doubles<B> radius;  ///< [1] largest squared distance of a corner from its centroid, then [m^2]
  Scalars<B> width;   ///< [1] of a cell [m]
  Indices<B> first;   ///< [buckets] into item
  Indices<B> filled;  ///< [buckets] items of each
  Indices<B> item;    ///< [triangles] of one cell after the other
  Vectors<B> centre;  ///< [items][3] their centroids when the grid was made [m]
  static constexpr int longest = 32;  ///< list of triangles
  Indices<B> close;   ///< [points] how many triangles may come within reach before the grid is made anew
  Indices<B> listed;  ///< [points * longest] these
  Indices<B> about;   ///< [points] how many triangles it may touch when the grid is made, in the cells around it
  static constexpr int most_crossings = 16;
  Indices<B> crossings;  ///< [points] how many edges may come to cross one that begins in the point, likewise
  Indices<B> crossing;   ///< [points * most_crossings * 2] these: the own edge, the other

  /// How far two points can move against each other in a step of h [s]; bounded where a state is no longer sound.
  KOKKOS_INLINE_FUNCTION Real closing(Real h) const {
    constexpr Real reaches = 32;  // 16 edges
    return Kokkos::min(2 * h * static_cast<Real>(Kokkos::sqrt(moved(1))), reaches * limits.reach);
  }
  /// How far apart edges are looked for: what is not fast moves less in a step [m].
  KOKKOS_INLINE_FUNCTION Real edge_reach() const { return reach(0) > limits.reach ? reach(0) : Real(0.5) * reach(0); }
  KOKKOS_INLINE_FUNCTION int cell(Real coordinate) const {
    constexpr Real most = Real(1 << 30);
    return static_cast<int>(Kokkos::floor(Kokkos::max(-most, Kokkos::min(most, coordinate / width(0)))));
  }
  KOKKOS_INLINE_FUNCTION int bucket(int i, int j, int k) const {
    const unsigned mixed = static_cast<unsigned>(i) * 73856093u ^ static_cast<unsigned>(j) * 19349663u ^
                           static_cast<unsigned>(k) * 83492791u;
    return static_cast<int>(mixed & static_cast<unsigned>(buckets - 1));
  }
  KOKKOS_INLINE_FUNCTION int bucket_of(const Vec3<Real>& at) const {
    return bucket(cell(at[0]), cell(at[1]), cell(at[2]));
  }
  /// look(triangle) for all that may come near a point that was `at` this place when the grid was made; some come twice.
  template <class Look>
  KOKKOS_INLINE_FUNCTION void around(const Vec3<Real>& at, const Look& look) const {
    const int c[3] = {cell(at[0]), cell(at[1]), cell(at[2])};
    const Real far = width(0) * width(0);
    for (int n = 0; n < 27; ++n) {
      const int b = bucket(c[0] + n % 3 - 1, c[1] + n / 3 % 3 - 1, c[2] + n / 9 - 1), begin = first(b);
      for (int s = begin; s < begin + filled(b); ++s) {
        const Vec3<Real> d = vector_at<B>(centre, s) - at;
        if (dot(d, d) < far) look(item(s));
      }
    }
  }
};

/// x of a state; its squared distance from where the grid was made, and the squared speed.
template <class B>
struct PlacePoints {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  State<B> state;
  PairGrid<B> grid;
  KOKKOS_INLINE_FUNCTION Sums<2, 2> operator()(int p) const {
    const Vec3<Real> x = value_at<B>(surface.embedding, state.u, p, vector_at<B>(surface.rest, p));
    const Vec3<Real> d = x - vector_at<B>(grid.built, p), v = value_at<B>(surface.embedding, state.v, p);
    set_vector<B>(grid.x, p, x);
    return {{static_cast<double>(dot(d, d)), static_cast<double>(dot(v, v))}};
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

/// What a triangle is to a grid that is made.
template <class B>
struct TriangleOfGrid {
  using Real = typename B::Real;
  Indices<B> corner;
  PairGrid<B> grid;
  KOKKOS_INLINE_FUNCTION Vec3<Real> x(int t, int c) const { return vector_at<B>(grid.x, corner(3 * t + c)); }
  KOKKOS_INLINE_FUNCTION Vec3<Real> centroid(int t) const { return Real(1) / 3 * (x(t, 0) + x(t, 1) + x(t, 2)); }
};

template <class B>
struct MeasureTriangles {
  using Real = typename B::Real;
  TriangleOfGrid<B> of;
  KOKKOS_INLINE_FUNCTION Sums<1, 1> operator()(int t) const {
    Sums<1, 1> largest;
    if (!(of.grid.stale(0) > 0)) return largest;
    for (int c = 0; c < 3; ++c) {
      const Vec3<Real> d = of.x(t, c) - of.centroid(t);
      largest += {{static_cast<double>(dot(d, d))}};
    }
    return largest;
  }
};

/// Around a point it has all triangles within reach, and around the ends of an edge all whose edges are within theirs of it.
template <class B>
struct SetWidth {
  using Real = typename B::Real;
  PairGrid<B> grid;
  KOKKOS_INLINE_FUNCTION void operator()() const {
    if (!(grid.stale(0) > 0)) return;
    const Real radius = static_cast<Real>(Kokkos::sqrt(grid.radius(0)));  // no less than half of any edge
    grid.width(0) = radius + Kokkos::max(grid.reach(0), radius + grid.edge_reach()) + grid.limits.margin;
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
  KOKKOS_INLINE_FUNCTION void operator()(int p) const { set_vector<B>(grid.built, p, vector_at<B>(grid.x, p)); }
};

template <class B>
struct CountCells {
  TriangleOfGrid<B> of;
  KOKKOS_INLINE_FUNCTION void operator()(int t) const {
    Kokkos::atomic_inc(&of.grid.filled(of.grid.bucket_of(of.centroid(t))));
  }
};

/// first(i) = the sum of count(j) for j < i, i up to one more than there are where `last`; left out where `on` is 0.
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

/// Puts triangles into their cells, whose counts start from 0 again. In any order: who looks takes the nearest.
template <class B>
struct FillCells {
  using Real = typename B::Real;
  TriangleOfGrid<B> of;
  KOKKOS_INLINE_FUNCTION void operator()(int t) const {
    const Vec3<Real> centre = of.centroid(t);
    const int b = of.grid.bucket_of(centre), s = of.grid.first(b) + Kokkos::atomic_fetch_add(&of.grid.filled(b), 1);
    of.grid.item(s) = t;
    set_vector<B>(of.grid.centre, s, centre);
  }
};

}  // namespace plica
