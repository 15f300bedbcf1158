// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/spaces/coarse_spaces.hpp>
#include <plica/drivers/spaces/moving_least_squares.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>

namespace plica {

namespace {

constexpr double too_stiff = 3.5;  // lambda_a over the median
constexpr int elimination_rounds = 12;
constexpr double most_removed = 0.35, most_followed_weight = 2, least_followed = 1e-9;
constexpr std::size_t fewest_neighbours = 3;

using Row = std::vector<std::pair<int, double>>;

/// Elimination of vertices one after the other. The remaining vertices are a smaller body with its
/// own K and masses.
class Elimination {
 public:
  Elimination(const TetMesh& mesh, const std::vector<char>& constrained, std::vector<double>&& mass,
              BlockRows&& K)
      : mesh_(mesh),
        constrained_(constrained),
        mass_(std::move(mass)),
        K_(std::move(K)),
        gone_(mass_.size(), 0),
        lambda_(mass_.size(), 0.0),
        locked_(mass_.size(), -1) {}

  std::optional<SliverSpace> run() {
    SliverSpace result;
    for (int a = 0; a < static_cast<int>(mass_.size()); ++a) measure(a);
    std::vector<std::pair<double, int>> stiff = stiffnesses();
    if (stiff.empty()) return {};
    const auto middle = stiff.begin() + static_cast<std::ptrdiff_t>(stiff.size() / 2);
    std::nth_element(stiff.begin(), middle, stiff.end());
    const double median = middle->first, limit = too_stiff * median;
    result.before = std::max_element(stiff.begin(), stiff.end())->first / median;
    if (!(result.before > too_stiff)) return {};
    const auto most = static_cast<std::size_t>(most_removed * static_cast<double>(mass_.size()));
    for (int round = 0; round < elimination_rounds && order_.size() < most; ++round) {
      std::erase_if(stiff, [&](const auto& one) { return !(one.first > limit); });
      std::sort(stiff.begin(), stiff.end(), std::greater<>());
      const std::size_t before = order_.size();
      for (const auto& [lambda, a] : stiff) eliminate(a, round);
      for (int a = 0; a < static_cast<int>(mass_.size()); ++a)
        if (locked_[index_of(a)] == round) measure(a);
      stiff = stiffnesses();
      if (order_.size() == before) break;
    }
    result.after = stiff.empty() ? 0 : std::max_element(stiff.begin(), stiff.end())->first / median;
    write(result);
    return result;
  }

 private:
  const TetMesh& mesh_;
  const std::vector<char>& constrained_;
  std::vector<double> mass_;
  BlockRows K_;
  std::vector<char> gone_;
  std::vector<double> lambda_;  // lambda_a
  std::vector<int> locked_;     // per vertex the last round in which a neighbour was eliminated
  std::vector<int> order_;      // eliminated vertices, in order
  std::vector<Row> follows_;    // for each of `order_` the neighbours that it follows, with weights
  LinearFit fit_;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver_;
  std::vector<double> weight_;

  void measure(int a) {
    if (gone_[index_of(a)] || constrained_[index_of(a)]) return;
    solver_.computeDirect(block(a, a), Eigen::EigenvaluesOnly);
    lambda_[index_of(a)] = solver_.eigenvalues()[2] / std::max(mass_[index_of(a)], 1e-300);
  }

  std::vector<std::pair<double, int>> stiffnesses() const {
    std::vector<std::pair<double, int>> all;
    for (int a = 0; a < static_cast<int>(mass_.size()); ++a)
      if (!gone_[index_of(a)] && !constrained_[index_of(a)])
        all.emplace_back(lambda_[index_of(a)], a);
    return all;
  }

  Eigen::Matrix3d& block(int a, int b) {
    auto& row = K_[index_of(a)];
    auto place = std::lower_bound(row.begin(), row.end(), b,
                                  [](const auto& e, int column) { return e.first < column; });
    if (place == row.end() || place->first != b)
      place = row.insert(place, {b, Eigen::Matrix3d::Zero()});
    return place->second;
  }

  void eliminate(int a, int round) {
    const auto row = K_[index_of(a)];  // with the diagonal block
    if (locked_[index_of(a)] == round || row.size() - 1 < fewest_neighbours) return;
    double radius = 0;
    const auto offset = [&](int b) {
      return Point(mesh_.vertices[index_of(b)] - mesh_.vertices[index_of(a)]);
    };
    for (const auto& [b, K] : row) radius = std::max(radius, 1.1 * offset(b).norm());
    fit_.clear();
    for (const auto& [b, K] : row)
      if (b != a) fit_.add(offset(b) / radius, fit_weight(offset(b).norm() / radius) + 1e-3);
    fit_.prepare();
    for (int dropped = 0; dropped <= 3; ++dropped)
      if (fit_.weights(dropped, weight_) < most_followed_weight) break;
    Row& followed = follows_.emplace_back();
    for (const auto& [b, K] : row)
      if (b != a) followed.emplace_back(b, weight_[followed.size()]);
    order_.push_back(a), gone_[index_of(a)] = 1;
    take_out(a, row, followed, round);
  }

  /// Updates K and m of the other vertices for u_a = sum of w_b u_b: K_bc += w_b K_ac + K_ba w_c +
  /// w_b K_aa w_c, m_b += w_b m_a.
  void take_out(int a, const BlockRows::value_type& row, const Row& followed, int round) {
    Eigen::Matrix3d own = block(a, a);
    BlockRows::value_type beside;
    for (const auto& entry : row)
      if (entry.first != a) beside.push_back(entry);
    for (std::size_t i = 0; i < followed.size(); ++i) {
      const auto [b, wb] = followed[i];
      for (std::size_t j = 0; j < followed.size(); ++j) {
        const auto [c, wc] = followed[j];
        block(b, c) += wb * beside[j].second + wc * beside[i].second.transpose() + (wb * wc) * own;
      }
      std::erase_if(K_[index_of(b)], [&](const auto& entry) { return entry.first == a; });
      mass_[index_of(b)] += wb * mass_[index_of(a)];
      locked_[index_of(b)] = round;
    }
    K_[index_of(a)].clear();
  }

  /// Writes the matrix `up` and the kept vertices. A vertex may follow vertices that were
  /// eliminated later: it then follows the kept vertices that these follow.
  void write(SliverSpace& result) const {
    std::vector<int> number(mass_.size(), -1);
    for (int a = 0; a < static_cast<int>(mass_.size()); ++a)
      if (!gone_[index_of(a)])
        number[index_of(a)] = static_cast<int>(result.kept.size()), result.kept.push_back(a);
    std::vector<std::vector<std::pair<int, double>>> rows(mass_.size());
    for (const int a : result.kept) rows[index_of(a)] = {{number[index_of(a)], 1.0}};
    for (std::size_t i = order_.size(); i-- > 0;) {
      std::map<int, double> sum;
      for (const auto& [b, w] : follows_[i])
        for (const auto& [column, value] : rows[index_of(b)]) sum[column] += w * value;
      for (const auto& [column, value] : sum)
        if (std::abs(value) > least_followed) rows[index_of(order_[i])].emplace_back(column, value);
    }
    result.up = matrix_of_rows(rows, static_cast<Eigen::Index>(result.kept.size()));
  }
};

}  // namespace

std::optional<SliverSpace> sliver_space(const TetMesh& mesh, const std::vector<char>& constrained,
                                        std::vector<double> mass, BlockRows K) {
  return Elimination(mesh, constrained, std::move(mass), std::move(K)).run();
}

namespace {

constexpr int fewest_free = 120;
constexpr double most_ratio = 5;

/// Returns the columns of P for free points, and removes the other points from `points`.
RowMatrix without_constrained(const RowMatrix& P, const std::vector<char>& constrained,
                              std::vector<int>& points) {
  std::vector<int> number, free;
  for (const int point : points) {
    number.push_back(constrained[index_of(point)] ? -1 : static_cast<int>(free.size()));
    if (!constrained[index_of(point)]) free.push_back(point);
  }
  points = std::move(free);
  return renumbered(P, static_cast<Eigen::Index>(points.size()),
                    [&](Eigen::Index, int column, double) { return number[index_of(column)]; });
}

/// Returns the sliver space, without columns for vertices whose motion is given. Returns nothing
/// where the mesh has no slivers.
std::optional<CoarseSpace> slivers_of(const TetMesh& mesh, const std::vector<char>& constrained,
                                      const std::vector<double>& mass, const BlockRows& K) {
  auto slivers = sliver_space(mesh, constrained, mass, K);
  if (!slivers) return {};
  CoarseSpace space{{}, std::move(slivers->kept), 0, true};
  space.up = without_constrained(slivers->up, constrained, space.points);
  return space;
}

void drop_constrained_rows(RowMatrix& P, const std::vector<char>& constrained) {
  P = some_entries(
      P, [&](Eigen::Index a, int, double) { return !constrained[static_cast<std::size_t>(a)]; });
}

RowMatrix rows_of(const RowMatrix& P, const std::vector<int>& rows) {
  RowMatrix some(static_cast<Eigen::Index>(rows.size()), P.cols());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    some.startVec(static_cast<Eigen::Index>(i));
    for (RowMatrix::InnerIterator entry(P, rows[i]); entry; ++entry)
      some.insertBack(static_cast<Eigen::Index>(i), entry.col()) = entry.value();
  }
  some.finalize();
  return some;
}

/// Returns the first points of `order`, `count` of them free, sorted by their numbers. Neighbours
/// thus stay close in memory, as in the mesh.
std::vector<int> first_free(const std::vector<int>& order, int count,
                            const std::vector<char>& constrained) {
  std::vector<int> points;
  for (auto point = order.begin(); count > 0 && point != order.end(); ++point)
    points.push_back(*point), count -= !constrained[index_of(*point)];
  std::ranges::sort(points);
  return points;
}

/// Returns the index of each number in `others`; both are ascending.
std::vector<int> places_of(const std::vector<int>& numbers, const std::vector<int>& others) {
  std::vector<int> places;
  auto other = others.begin();
  for (const int number : numbers) {
    other = std::find(other, others.end(), number);
    places.push_back(static_cast<int>(other - others.begin()));
  }
  return places;
}

}  // namespace

std::vector<int> space_sizes(int free_vertices, SizeRule rule) {
  if (free_vertices < fewest_free) return {};
  const double first = rule.first * free_vertices,
               last = std::clamp(std::round(rule.last * free_vertices), 1.0 * rule.fewest,
                                 1.0 * rule.most);
  if (first < 1.5 * last)
    return {std::min(static_cast<int>(last), static_cast<int>(free_vertices / rule.sparsest))};
  const int steps =
      std::max(1, static_cast<int>(std::ceil(std::log(first / last) / std::log(most_ratio))));
  std::vector<int> sizes;
  for (int i = 0; i <= steps; ++i)
    sizes.push_back(static_cast<int>(
        std::lround(first * std::pow(last / first, static_cast<double>(i) / steps))));
  return sizes;
}

std::vector<int> space_sizes(const std::optional<std::vector<int>>& asked,
                             const std::vector<char>& constrained, SizeRule rule) {
  if (asked && !asked->empty()) return *asked;
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
  std::vector<int> all(mesh.vertices.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<int> rows = all;
  if (options.slivers && mesh.followers.vertex.empty())
    if (auto slivers = slivers_of(mesh, constrained, mass, K)) {
      rows = slivers->points;
      spaces.push_back(std::move(*slivers));
    }
  const std::size_t count = options.sizes.size();
  std::vector<std::vector<int>> points(count);
  std::vector<PointGraph> graphs(count);
  for_row_ranges(count, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      points[i] = first_free(order, options.sizes[i], constrained);
      graphs[i] = point_graph(graph, points[i]);
    }
  });
  for (std::size_t i = 0; i < count; ++i) {
    // Fit to the points above, with distances along the edges of their graph
    const EdgeGraph& edges = i == 0 ? graph : graphs[i - 1].graph;
    const std::vector<int>& above = i == 0 ? all : points[i - 1];
    const RowMatrix P =
        moving_least_squares(edges, places_of(rows, above), places_of(points[i], above),
                             graphs[i].spacing, options.reach);
    rows = points[i];
    spaces.push_back({without_constrained(P, constrained, rows), rows, graphs[i].spacing});
  }
  // given motions are not interpolated, nor are followers, which go where their masters are
  drop_constrained_rows(spaces.front().up, given_or_following(mesh, constrained));
  return spaces;
}

LevelsBelow levels_below(const std::vector<RestLevel>& levels, const std::vector<double>& mass,
                         const BlockRows& K, const SpaceOptions& options, bool smooth) {
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
      return transfer_matrix(fine.mesh, fine.constrained, coarse.mesh, coarse.constrained, up,
                             smooth);
    };
    below.transfers.push_back(transfer(
        coarse.up ? *coarse.up : embed(fine.mesh.vertices, coarse.mesh, Outside::extrapolate)));
  }
  const RestLevel& coarsest = levels.back();
  below.made =
      coarse_spaces(coarsest.mesh, coarsest.constrained, {}, {}, {options.sizes, options.reach});
  for (const CoarseSpace& space : below.made) below.transfers.push_back(space.up);
  if (!options.slivers || !finest.mesh.followers.vertex.empty()) return below;
  if (auto slivers = slivers_of(finest.mesh, finest.constrained, mass, K)) {
    drop_constrained_rows(slivers->up, finest.constrained);
    below.transfers.front() = rows_of(below.transfers.front(), slivers->points);
    below.transfers.insert(below.transfers.begin(), slivers->up);
    below.made.insert(below.made.begin(), std::move(*slivers));
  }
  return below;
}

bool has_coarse_levels(std::string_view cycle, const Body& body) {
  if (cycle != "auto" && !uses_coarse_levels(cycle)) return false;
  if (body.levels.size() > 1) return true;
  return !integrates_coarse_levels(cycle) &&
         !space_sizes(static_cast<int>(body.levels.front().vertices.size())).empty();
}

}  // namespace plica
