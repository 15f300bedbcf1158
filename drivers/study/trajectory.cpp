// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/drivers/study/trajectory.hpp>

namespace plica {

namespace {

constexpr long points = 4;      // of the polynomial
constexpr double exact = 1e-9;  // of a step

double lagrange_weight(double x, long first, long count, long i) {
  double weight = 1;
  for (long k = first; k < first + count; ++k)
    if (k != i) weight *= (x - static_cast<double>(k)) / static_cast<double>(i - k);
  return weight;
}

void accumulate(std::vector<Point>& sum, double weight, const std::vector<Point>& field) {
  if (sum.empty()) sum.assign(field.size(), Point::Zero());
  for (std::size_t a = 0; a < field.size(); ++a) sum[a] += weight * field[a];
}

std::vector<Point> at_points(const std::vector<Point>& field, const Embedding& embedding) {
  std::vector<Point> result(embedding.vertices.size(), Point::Zero());
  for (std::size_t a = 0; a < result.size(); ++a)
    for (std::size_t k = 0; k < 4; ++k)
      result[a] += embedding.weights[a][k] * field[static_cast<std::size_t>(embedding.vertices[a][k])];
  return result;
}

}  // namespace

std::vector<double> sampling_times(double duration, int samples) {
  std::vector<double> times;
  for (int i = 1; i <= samples; ++i) times.push_back(duration * i / samples);
  return times;
}

TrajectorySampler::TrajectorySampler(const std::vector<double>& times, double step, long steps) {
  for (std::size_t j = 0; j < times.size(); ++j) {
    const double x = times[j] / step;
    if (std::abs(x - std::round(x)) < exact) {
      terms_.push_back({std::lround(x), j, 1.0});
      continue;
    }
    const long count = std::min(points, steps + 1);
    const long first = std::clamp(static_cast<long>(std::floor(x)) - 1, 0L, steps + 1 - count);
    for (long i = first; i < first + count; ++i) terms_.push_back({i, j, lagrange_weight(x, first, count, i)});
  }
  std::ranges::stable_sort(terms_, {}, &Term::step);
  trajectory_.times = times;
  trajectory_.u.resize(times.size());
  trajectory_.v.resize(times.size());
}

void TrajectorySampler::add(long step, const std::vector<Point>& u, const std::vector<Point>& v) {
  for (; wants(step); ++next_) {
    accumulate(trajectory_.u[terms_[next_].sample], terms_[next_].weight, u);
    accumulate(trajectory_.v[terms_[next_].sample], terms_[next_].weight, v);
  }
}

Trajectory interpolated(const Trajectory& trajectory, const Embedding& embedding) {
  Trajectory result;
  result.times = trajectory.times;
  for (const auto& u : trajectory.u) result.u.push_back(at_points(u, embedding));
  for (const auto& v : trajectory.v) result.v.push_back(at_points(v, embedding));
  return result;
}

}  // namespace plica
