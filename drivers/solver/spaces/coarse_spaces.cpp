// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <plica/drivers/solver/spaces/coarse_spaces.hpp>
#include <plica/drivers/solver/spaces/index_of.hpp>
#include <plica/drivers/solver/spaces/moving_least_squares.hpp>
#include <plica/drivers/solver/spaces/sliver_space.hpp>

namespace plica {

namespace {

constexpr int fewest_free = 120;
constexpr double most_ratio = 5;

/// The columns of free points, and these points.
RowMatrix without_constrained(const RowMatrix& P, const std::vector<char>& constrained, std::vector<int>& points) {
  std::vector<int> number, free;
  for (const int point : points) {
    number.push_back(constrained[index_of(point)] ? -1 : static_cast<int>(free.size()));
    if (!constrained[index_of(point)]) free.push_back(point);
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index a = 0; a < P.rows(); ++a)
    for (RowMatrix::InnerIterator entry(P, a); entry; ++entry)
      if (const int column = number[static_cast<std::size_t>(entry.col())]; column >= 0)
        entries.emplace_back(static_cast<int>(a), column, entry.value());
  RowMatrix kept(P.rows(), static_cast<Eigen::Index>(free.size()));
  kept.setFromTriplets(entries.begin(), entries.end());
  points = std::move(free);
  return kept;
}

/// None where there are no slivers. Vertices whose motion is given have no column.
std::optional<CoarseSpace> slivers_of(const TetMesh& mesh, const std::vector<char>& constrained,
                                      const std::vector<double>& mass, const BlockRows& K) {
  auto slivers = sliver_space(mesh, constrained, mass, K);
  if (!slivers) return {};
  CoarseSpace space{{}, std::move(slivers->kept), 0, true};
  space.up = without_constrained(slivers->up, constrained, space.points);
  return space;
}

void drop_constrained_rows(RowMatrix& P, const std::vector<char>& constrained) {
  P.prune([&](Eigen::Index a, Eigen::Index, double) { return !constrained[static_cast<std::size_t>(a)]; });
}

RowMatrix rows_of(const RowMatrix& P, const std::vector<int>& rows) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (RowMatrix::InnerIterator entry(P, rows[i]); entry; ++entry)
      entries.emplace_back(static_cast<int>(i), static_cast<int>(entry.col()), entry.value());
  RowMatrix some(static_cast<Eigen::Index>(rows.size()), P.cols());
  some.setFromTriplets(entries.begin(), entries.end());
  return some;
}

}  // namespace

std::vector<int> space_sizes(int free_vertices, SizeRule rule) {
  if (free_vertices < fewest_free) return {};
  const double first = rule.first * free_vertices, last = rule.last;
  if (first < 1.5 * last) return {std::min(rule.last, free_vertices / 4)};
  const int steps = std::max(1, static_cast<int>(std::ceil(std::log(first / last) / std::log(most_ratio))));
  std::vector<int> sizes;
  for (int i = 0; i <= steps; ++i)
    sizes.push_back(static_cast<int>(std::lround(first * std::pow(last / first, static_cast<double>(i) / steps))));
  return sizes;
}

std::vector<int> space_sizes(const Body& body, const std::vector<char>& constrained, SizeRule rule) {
  if (body.coarsen && !body.coarsen->empty()) return *body.coarsen;
  return space_sizes(static_cast<int>(std::ranges::count(constrained, 0)), rule);
}

std::vector<CoarseSpace> coarse_spaces(const TetMesh& mesh, const std::vector<char>& constrained,
                                       const std::vector<double>& mass, const BlockRows& K,
                                       const SpaceOptions& options) {
  const Kokkos::Profiling::ScopedRegion region("plica: coarse spaces");
  std::vector<CoarseSpace> spaces;
  if (options.sizes.empty()) return spaces;
  const EdgeGraph graph = edge_graph(mesh);
  const std::vector<int> order = farthest_points(graph, options.sizes.front(), constrained);
  std::vector<int> rows(mesh.vertices.size());
  std::iota(rows.begin(), rows.end(), 0);
  if (options.slivers)
    if (auto slivers = slivers_of(mesh, constrained, mass, K)) {
      rows = slivers->points;
      spaces.push_back(std::move(*slivers));
    }
  for (const int size : options.sizes) {
    std::vector<int> points;
    int free = 0;
    for (auto point = order.begin(); free < size && point != order.end(); ++point)
      points.push_back(*point), free += !constrained[index_of(*point)];
    std::ranges::sort(points);  // neighbours beside each other, as in the mesh
    const double spacing = mean_spacing(graph, points);
    const RowMatrix P = moving_least_squares(mesh, graph, rows, points, spacing, options.reach);
    spaces.push_back({without_constrained(P, constrained, points), points, spacing});
    rows = points;
  }
  drop_constrained_rows(spaces.front().up, constrained);  // they have no part in any
  return spaces;
}

LevelsBelow levels_below(const std::vector<RestLevel>& levels, const std::vector<double>& mass, const BlockRows& K,
                         const SpaceOptions& options, bool smooth) {
  LevelsBelow below;
  const RestLevel& finest = levels.front();
  if (levels.size() == 1) {
    below.made = coarse_spaces(finest.mesh, finest.constrained, mass, K, options);
    for (const CoarseSpace& space : below.made) below.transfers.push_back(space.up);
    return below;
  }
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const RestLevel &fine = levels[i - 1], &coarse = levels[i];
    const auto transfer = [&](const Embedding& up) {
      return transfer_matrix(fine.mesh, fine.constrained, coarse.mesh, coarse.constrained, up, smooth);
    };
    below.transfers.push_back(
        transfer(coarse.up ? *coarse.up : embed(fine.mesh.vertices, coarse.mesh, Outside::extrapolate)));
  }
  if (!options.slivers) return below;
  if (auto slivers = slivers_of(finest.mesh, finest.constrained, mass, K)) {
    drop_constrained_rows(slivers->up, finest.constrained);
    below.transfers.front() = rows_of(below.transfers.front(), slivers->points);
    below.transfers.insert(below.transfers.begin(), slivers->up);
    below.made.push_back(std::move(*slivers));
  }
  return below;
}

}  // namespace plica
