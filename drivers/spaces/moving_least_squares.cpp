// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/spaces/moving_least_squares.hpp>
#include <plica/drivers/spaces/row_matrix.hpp>
#include <span>

namespace plica {

namespace {

constexpr double radius_growth = 1.8;        // maximum factor on the radius
constexpr double radius_growth_step = 1.16;  // factor on the radius in one step
constexpr double most_fit_weight = 2;        // maximum sum of |weights| of a good fit
constexpr double least_fit_spread = 1e-3;
constexpr double least_fit_weight = 1e-4;
constexpr std::size_t fewest_fitted = 6;

struct Near {
  int point;        // index in the list of points
  double distance;  // [m]
};

/// Distance of a vertex to the ball that all points of a fit are in: a lower bound for EdgeWalk.
struct BeyondBall {
  const EdgeGraph& graph;
  int centre;
  double radius;  // [m]
  double operator()(int v) const {
    return std::max(0.0,
                    (graph.place[index_of(v)] - graph.place[index_of(centre)]).norm() - radius);
  }
};

class Fitter {
 public:
  Fitter(const EdgeGraph& graph, const std::vector<int>& points, double radius)
      : graph_(graph),
        points_(points),
        radius_(radius),
        number_(graph.place.size(), -1),
        walk_(graph) {
    for (std::size_t j = 0; j < points.size(); ++j)
      number_[index_of(points[j])] = static_cast<int>(j);
  }

  /// A row within the first radius of a point.
  struct Reached {
    int row;
    double distance;  // [m]
  };

  /// Finds the rows within the first radius of point j.
  /// @param place  per vertex its index among the rows, or -1
  void reached(int j, const std::vector<int>& place, std::vector<Reached>& rows) {
    const int point = points_[index_of(j)];
    walk_.from(point, EdgeGraph::detour * radius_, BeyondBall{graph_, point, radius_},
               [&](int v, double along) {
                 if (place[index_of(v)] < 0) return;
                 if (const double d = graph_.distance(v, point, along); d < radius_)
                   rows.push_back({place[index_of(v)], d});
               });
  }

  /// Computes the row of vertex `a` as (point, weight). It uses the points `near` within the first
  /// radius, or more points within a larger radius if the fit is not good.
  void fit(int a, std::span<const Near> near, std::vector<std::pair<int, double>>& row) {
    row.clear();
    if (good(a, near, radius_, row)) return;
    const double widest = radius_growth * radius_;
    std::vector<Near> more;
    walk_.from(a, EdgeGraph::detour * widest, BeyondBall{graph_, a, widest},
               [&](int v, double along) {
                 if (number_[index_of(v)] >= 0)
                   more.push_back({number_[index_of(v)], graph_.distance(a, v, along)});
               });
    std::sort(more.begin(), more.end(),
              [](const Near& x, const Near& y) { return x.point < y.point; });
    for (double radius = radius_growth_step * radius_; radius <= widest;
         radius *= radius_growth_step)
      if (good(a, more, radius, row)) return;
    // Leave out the flattest directions until the fit is good
    gather(a, more, widest);
    for (int dropped = 0; fit_.size() > 0 && dropped <= 3; ++dropped)
      if (fit_.weights(dropped, weight_) <= most_fit_weight || dropped == 3) return take(row);
  }

 private:
  const EdgeGraph& graph_;
  const std::vector<int>& points_;
  double radius_;
  std::vector<int> number_;  // per vertex its index among the points, or -1
  EdgeWalk walk_;
  LinearFit fit_;
  std::vector<int> fitted_;  // points of the fit
  std::vector<double> weight_;

  void gather(int a, std::span<const Near> near, double radius) {
    fit_.clear(), fitted_.clear();
    for (const Near& one : near)
      if (const double w = fit_weight(one.distance / radius); w > 0) {
        fit_.add(
            (graph_.place[index_of(points_[index_of(one.point)])] - graph_.place[index_of(a)]) /
                radius,
            w);
        fitted_.push_back(one.point);
      }
    if (fit_.size() > 0) fit_.prepare();
  }

  bool good(int a, std::span<const Near> near, double radius,
            std::vector<std::pair<int, double>>& row) {
    gather(a, near, radius);
    if (fit_.size() < fewest_fitted || fit_.flattest() < least_fit_spread ||
        fit_.weights(0, weight_) > most_fit_weight)
      return false;
    take(row);
    return true;
  }

  void take(std::vector<std::pair<int, double>>& row) const {
    double sum = 0;
    for (std::size_t k = 0; k < fitted_.size(); ++k)
      if (std::abs(weight_[k]) > least_fit_weight)
        row.emplace_back(fitted_[k], weight_[k]), sum += weight_[k];
    for (auto& entry : row) entry.second /= sum;
  }
};

/// Points of each row within the first radius, ascending.
struct Neighbourhoods {
  std::vector<std::size_t> first;  // per row its first index in `near`
  std::vector<Near> near;

  std::span<const Near> of(std::size_t row) const {
    return {near.data() + first[row], near.data() + first[row + 1]};
  }
};

/// Finds the points of each row by walks from the points, which are fewer than the rows.
Neighbourhoods neighbourhoods(const EdgeGraph& graph, const std::vector<int>& rows,
                              const std::vector<int>& points, double radius) {
  std::vector<int> place(graph.place.size(), -1);
  for (std::size_t i = 0; i < rows.size(); ++i) place[index_of(rows[i])] = static_cast<int>(i);
  std::vector<std::vector<Fitter::Reached>> reached(points.size());
  for_row_ranges(points.size(), [&](std::size_t first, std::size_t last) {
    Fitter fitter(graph, points, radius);
    for (std::size_t j = first; j < last; ++j)
      fitter.reached(static_cast<int>(j), place, reached[j]);
  });
  Neighbourhoods all{std::vector<std::size_t>(rows.size() + 1, 0), {}};
  for (const auto& of_point : reached)
    for (const Fitter::Reached& one : of_point) ++all.first[index_of(one.row) + 1];
  std::partial_sum(all.first.begin(), all.first.end(), all.first.begin());
  all.near.resize(all.first.back());
  std::vector<std::size_t> next = all.first;
  for (std::size_t j = 0; j < points.size(); ++j)
    for (const auto& [row, distance] : reached[j])
      all.near[next[index_of(row)]++] = {static_cast<int>(j), distance};
  return all;
}

}  // namespace

RowMatrix moving_least_squares(const EdgeGraph& graph, const std::vector<int>& rows,
                               const std::vector<int>& points, double spacing, double reach) {
  const Neighbourhoods near = neighbourhoods(graph, rows, points, reach * spacing);
  std::vector<std::vector<std::pair<int, double>>> fitted(rows.size());
  for_row_ranges(rows.size(), [&](std::size_t first, std::size_t last) {
    Fitter fitter(graph, points, reach * spacing);
    for (std::size_t i = first; i < last; ++i) fitter.fit(rows[i], near.of(i), fitted[i]);
  });
  return matrix_of_rows(fitted, static_cast<Eigen::Index>(points.size()));
}

}  // namespace plica
