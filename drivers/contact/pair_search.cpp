// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/contact/order_by_halves.hpp>
#include <plica/drivers/contact/pair_search.hpp>
#include <plica/kernels/contact/find_crossings.hpp>

namespace plica {

namespace {

/// Returns the middles of all triangles at rest. Bodies are next to each other in them, so that a
/// part of the tree is of one body.
template <class B>
std::vector<Point> middles(const ContactRecords<B>& records, const EmbeddedSurface<B>& surface) {
  const auto corner = on_host(records.mesh.corner), body = on_host(records.body);
  const auto rest = on_host(surface.rest);
  std::vector<Point> result(static_cast<std::size_t>(records.mesh.triangles), Point::Zero());
  Point size = Point::Zero();
  for (int i = 0; i < 3 * records.mesh.triangles; ++i) {
    const Point at(static_cast<double>(rest(corner(i), 0)), static_cast<double>(rest(corner(i), 1)),
                   static_cast<double>(rest(corner(i), 2)));
    result[static_cast<std::size_t>(i / 3)] += at / 3;
    size = size.cwiseMax(at.cwiseAbs());
  }
  for (int t = 0; records.bodies > 1 && t < records.mesh.triangles; ++t)
    result[static_cast<std::size_t>(t)][0] += 4 * size.maxCoeff() * body(corner(3 * t));
  return result;
}

}  // namespace

template <class B>
PairSearch<B>::PairSearch(const PairLimits<Real>& limits, const ContactRecords<B>& records,
                          const EmbeddedSurface<B>& surface) {
  const auto n = static_cast<std::size_t>(records.points),
             triangles = static_cast<std::size_t>(records.mesh.triangles);
  constexpr auto wide = static_cast<std::size_t>(PairTree<B>::wide);
  const std::size_t last = (triangles + wide - 1) / wide;  // blocks of triangles
  std::size_t inner = 0;
  for (std::size_t level = 1; level < last; level *= wide) inner += level;
  own_.limits = limits;
  own_.inner = static_cast<int>(inner), own_.blocks = static_cast<int>(inner + last);
  own_.order = to_device<Indices<B>>("pairs.order", order_by_halves(middles<B>(records, surface)));
  own_.x = records.places;
  own_.built = to_device<Vectors<B>>(
      "pairs.built", std::vector<std::array<Real, 3>>(
                         n, {Real(1e15), Real(1e15), Real(1e15)}));  // far from anything
  own_.mean = zeros<Doubles<B>>("plica::pairs.mean", 6);
  own_.moved = zeros<Doubles<B>>("plica::pairs.moved", 2);
  own_.ridge = zeros<Indices<B>>("plica::pairs.ridge", records.mesh.edge.extent(0) / 4);
  own_.reach = zeros<Scalars<B>>("plica::pairs.reach", 1);
  own_.margin = zeros<Scalars<B>>("plica::pairs.margin", 1);
  own_.stale = zeros<Doubles<B>>("plica::pairs.stale", 1);
  own_.bounds = zeros<Scalars<B>>("plica::pairs.bounds", (inner + last) * 6 * wide);
  own_.close = zeros<Indices<B>>("plica::pairs.close", n);
  own_.listed =
      zeros<Indices<B>>("plica::pairs.listed", n * static_cast<std::size_t>(PairTree<B>::longest));
  own_.crossings = zeros<Indices<B>>("plica::pairs.crossings", n);
  own_.crossing = zeros<Indices<B>>("plica::pairs.crossing",
                                    2 * n * static_cast<std::size_t>(PairTree<B>::most_crossings));
  tree_ = own_;
  each_array(tree_, [](auto& field) { field = lent(field); });
}

template <class B>
void PairSearch<B>::find(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& state,
                         const ContactRecords<B>& records, bool fresh,
                         const BlockSums<B>& blocks) const {
  const FindPairs<B> find{surface, state, tree_, records};
  const MotionOfPoint<B> motion{surface, state.v, tree_};
  reduce<B, 6>(exec, "plica::pairs_mean", records.points, motion, blocks, tree_.mean,
               MeanOfPoints<B>{tree_.mean, 1.0 / records.points});
  reduce<B, 2, MotionAgainstMean<B>, Sums<2, 2>>(exec, "plica::pairs_moved", records.points,
                                                 {motion}, blocks, tree_.moved,
                                                 JudgeLists<B>{tree_, records.span});
  bound(exec, records);
  where_touching<B>(exec, tree_.stale, "plica::pairs_close", records.points, ListClose<B>{find});
  where_touching<B>(exec, tree_.stale, "plica::pairs_ridges",
                    static_cast<int>(tree_.ridge.extent(0)), MarkRidges<B>{{find}});
  where_touching<B>(exec, tree_.stale, "plica::pairs_crossings", records.points,
                    ListCrossings<B>{{find}});
  update_vertices<B>(exec, "plica::pairs_nearest", records.points,
                     NearestTriangles<B>{find, fresh});
  update_vertices<B>(exec, "plica::pairs_crossing", records.points,
                     DeepestCrossings<B>{{find}, fresh});
}

/// Sets the boxes of the tree from its leaves up, where `tree_.stale` is above 0.
template <class B>
void PairSearch<B>::bound(const Exec& exec, const ContactRecords<B>& records) const {
  where_touching<B>(exec, tree_.stale, "plica::pairs_keep", records.points, KeepPlaces<B>{tree_});
  for (int end = tree_.blocks, first = tree_.inner; end > 0;
       end = first, first = (first - 1) / PairTree<B>::wide)
    where_touching<B>(exec, tree_.stale, "plica::pairs_bound", end - first,
                      BoundBlocks<B>{records.mesh, tree_, first});
}

#define PLICA_INSTANTIATE(Real, Exec) template class PairSearch<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
