// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <bit>
#include <plica/drivers/solver/pair_search.hpp>
#include <plica/kernels/contact/find_crossings.hpp>

namespace plica {

template <class B>
PairSearch<B>::PairSearch(const PairLimits<Real>& limits, const ContactRecords<B>& records)
    : blocks_(records.mesh.triangles) {
  const auto n = static_cast<std::size_t>(records.points), triangles = static_cast<std::size_t>(records.mesh.triangles);
  const std::size_t buckets = std::bit_ceil(2 * triangles);
  grid_.limits = limits;
  grid_.buckets = static_cast<int>(buckets);
  grid_.x = zeros<Vectors<B>>("plica::pairs.x", n);
  grid_.built = to_device<Vectors<B>>(
      "pairs.built", std::vector<std::array<Real, 3>>(n, {Real(1e15), Real(1e15), Real(1e15)}));  // far from anything
  grid_.moved = zeros<Doubles<B>>("plica::pairs.moved", 2);
  grid_.reach = zeros<Scalars<B>>("plica::pairs.reach", 1);
  grid_.stale = zeros<Doubles<B>>("plica::pairs.stale", 1);
  grid_.radius = zeros<Doubles<B>>("plica::pairs.radius", 1);
  grid_.width = zeros<Scalars<B>>("plica::pairs.width", 1);
  grid_.first = zeros<Indices<B>>("plica::pairs.first", buckets);
  grid_.filled = zeros<Indices<B>>("plica::pairs.filled", buckets);
  grid_.item = zeros<Indices<B>>("plica::pairs.item", triangles);
  grid_.centre = zeros<Vectors<B>>("plica::pairs.centre", triangles);
  grid_.close = zeros<Indices<B>>("plica::pairs.close", n);
  grid_.listed = zeros<Indices<B>>("plica::pairs.listed", n * static_cast<std::size_t>(PairGrid<B>::longest));
  grid_.about = zeros<Indices<B>>("plica::pairs.about", n);
  grid_.crossings = zeros<Indices<B>>("plica::pairs.crossings", n);
  grid_.crossing =
      zeros<Indices<B>>("plica::pairs.crossing", 2 * n * static_cast<std::size_t>(PairGrid<B>::most_crossings));
}

template <class B>
void PairSearch<B>::find(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& state,
                         const ContactRecords<B>& records, bool fresh, const BlockSums<B>& blocks) const {
  const FindPairs<B> find{surface, state, grid_, records};
  reduce<B, 2, PlacePoints<B>, Sums<2, 2>>(exec, "plica::pairs_moved", records.points,
                                           PlacePoints<B>{surface, state, grid_}, blocks, grid_.moved,
                                           JudgeGrid<B>{grid_, records.span});
  make_grid(exec, records);
  where_touching<B>(exec, grid_.stale, "plica::pairs_close", records.points, ListClose<B>{find});
  where_touching<B>(exec, grid_.stale, "plica::pairs_crossings", records.points, ListCrossings<B>{{find}});
  update_vertices<B>(exec, "plica::pairs_nearest", records.points, NearestTriangles<B>{find, fresh});
  update_vertices<B>(exec, "plica::pairs_crossing", records.points, DeepestCrossings<B>{{find}, fresh});
}

/// Where it is stale.
template <class B>
void PairSearch<B>::make_grid(const Exec& exec, const ContactRecords<B>& records) const {
  const TriangleOfGrid<B> of{records.mesh.corner, grid_};
  const int triangles = records.mesh.triangles, buckets = grid_.buckets;
  const Doubles<B>& stale = grid_.stale;
  reduce<B, 1, MeasureTriangles<B>, Sums<1, 1>>(exec, "plica::pairs_measure", triangles, MeasureTriangles<B>{of},
                                                blocks_, grid_.radius, SetWidth<B>{grid_});
  where_touching<B>(exec, stale, "plica::pairs_keep", records.points, KeepPlaces<B>{grid_});
  where_touching<B>(exec, stale, "plica::pairs_clear", buckets, ClearInts<B>{grid_.filled});
  where_touching<B>(exec, stale, "plica::pairs_count", triangles, CountCells<B>{of});
  launch_gathered<Exec>();  // Kokkos lends a scan memory that may be elsewhere the next time
  Kokkos::parallel_scan("plica::pairs_scan", Kokkos::RangePolicy<Exec>(exec, 0, buckets),
                        SumBefore<B>{grid_.filled, grid_.first, buckets, stale});
  where_touching<B>(exec, stale, "plica::pairs_clear", buckets, ClearInts<B>{grid_.filled});
  where_touching<B>(exec, stale, "plica::pairs_fill", triangles, FillCells<B>{of});
}

template <class B>
std::size_t PairSearch<B>::bytes() const {
  return (grid_.x.span() + grid_.built.span() + grid_.centre.span()) * sizeof(Real) +
         (grid_.first.span() + grid_.filled.span() + grid_.item.span() + grid_.close.span() + grid_.listed.span() +
          grid_.about.span() + grid_.crossings.span() + grid_.crossing.span()) *
             sizeof(int);
}

#define PLICA_INSTANTIATE(Real, Exec) template class PairSearch<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
