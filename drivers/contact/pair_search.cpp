// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <bit>
#include <plica/drivers/contact/pair_search.hpp>
#include <plica/kernels/contact/find_crossings.hpp>

namespace plica {

template <class B>
PairSearch<B>::PairSearch(const PairLimits<Real>& limits, const ContactRecords<B>& records)
    : blocks_(records.mesh.triangles) {
  const auto n = static_cast<std::size_t>(records.points),
             triangles = static_cast<std::size_t>(records.mesh.triangles);
  const std::size_t buckets = std::bit_ceil(2 * triangles);
  own_.limits = limits;
  own_.buckets = static_cast<int>(buckets);
  own_.x = records.places;
  own_.built = to_device<Vectors<B>>(
      "pairs.built", std::vector<std::array<Real, 3>>(
                         n, {Real(1e15), Real(1e15), Real(1e15)}));  // far from anything
  own_.mean = zeros<Doubles<B>>("plica::pairs.mean", 6);
  own_.moved = zeros<Doubles<B>>("plica::pairs.moved", 2);
  own_.ridge = zeros<Indices<B>>("plica::pairs.ridge", records.mesh.edge.extent(0) / 4);
  own_.reach = zeros<Scalars<B>>("plica::pairs.reach", 1);
  own_.stale = zeros<Doubles<B>>("plica::pairs.stale", 1);
  own_.extent = zeros<Doubles<B>>("plica::pairs.extent", 2);
  own_.width = zeros<Scalars<B>>("plica::pairs.width", 1);
  own_.first = zeros<Indices<B>>("plica::pairs.first", buckets);
  own_.filled = zeros<Indices<B>>("plica::pairs.filled", buckets);
  own_.item = zeros<Indices<B>>("plica::pairs.item", PairGrid<B>::most_cells * triangles);
  own_.close = zeros<Indices<B>>("plica::pairs.close", n);
  own_.listed =
      zeros<Indices<B>>("plica::pairs.listed", n * static_cast<std::size_t>(PairGrid<B>::longest));
  own_.crossings = zeros<Indices<B>>("plica::pairs.crossings", n);
  own_.crossing = zeros<Indices<B>>("plica::pairs.crossing",
                                    2 * n * static_cast<std::size_t>(PairGrid<B>::most_crossings));
  grid_ = own_;
  each_array(grid_, [](auto& field) { field = lent(field); });
}

template <class B>
void PairSearch<B>::find(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& state,
                         const ContactRecords<B>& records, bool fresh,
                         const BlockSums<B>& blocks) const {
  const FindPairs<B> find{surface, state, grid_, records};
  const MotionOfPoint<B> motion{surface, state.v, grid_};
  reduce<B, 6>(exec, "plica::pairs_mean", records.points, motion, blocks, grid_.mean,
               MeanOfPoints<B>{grid_.mean, 1.0 / records.points});
  reduce<B, 2, MotionAgainstMean<B>, Sums<2, 2>>(exec, "plica::pairs_moved", records.points,
                                                 {motion}, blocks, grid_.moved,
                                                 JudgeGrid<B>{grid_, records.span});
  make_grid(exec, records);
  where_touching<B>(exec, grid_.stale, "plica::pairs_close", records.points, ListClose<B>{find});
  where_touching<B>(exec, grid_.stale, "plica::pairs_ridges",
                    static_cast<int>(grid_.ridge.extent(0)), MarkRidges<B>{{find}});
  where_touching<B>(exec, grid_.stale, "plica::pairs_crossings", records.points,
                    ListCrossings<B>{{find}});
  update_vertices<B>(exec, "plica::pairs_nearest", records.points,
                     NearestTriangles<B>{find, fresh});
  update_vertices<B>(exec, "plica::pairs_crossing", records.points,
                     DeepestCrossings<B>{{find}, fresh});
}

/// Makes the grid of triangles anew where `grid_.stale` is above 0.
template <class B>
void PairSearch<B>::make_grid(const Exec& exec, const ContactRecords<B>& records) const {
  const Indices<B>& corner = records.mesh.corner;
  const int triangles = records.mesh.triangles, buckets = grid_.buckets;
  const Doubles<B>& stale = grid_.stale;
  where_touching<B>(exec, stale, "plica::pairs_keep", records.points, KeepPlaces<B>{grid_});
  reduce<B, 2, MeasureTriangles<B>, Sums<2, 1>>(exec, "plica::pairs_measure", triangles,
                                                {corner, grid_}, blocks_, grid_.extent,
                                                SetWidth<B>{grid_, triangles});
  where_touching<B>(exec, stale, "plica::pairs_clear", buckets, ClearInts<B>{grid_.filled});
  where_touching<B>(exec, stale, "plica::pairs_count", triangles, CountCells<B>{corner, grid_});
  launch_gathered<Exec>();  // Kokkos may give the scan other memory in the next call
  Kokkos::parallel_scan("plica::pairs_scan", Kokkos::RangePolicy<Exec>(exec, 0, buckets),
                        SumBefore<B>{grid_.filled, grid_.first, buckets, stale});
  where_touching<B>(exec, stale, "plica::pairs_clear", buckets, ClearInts<B>{grid_.filled});
  where_touching<B>(exec, stale, "plica::pairs_fill", triangles, FillCells<B>{corner, grid_});
}

#define PLICA_INSTANTIATE(Real, Exec) template class PairSearch<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
