// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/study/trajectory.hpp>

namespace plica {

namespace {

constexpr long fit_points = 4;      // points of the polynomial
constexpr double same_time = 1e-9;  // difference of equal times, over a step

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

}  // namespace

std::vector<Point> interpolated(const std::vector<Point>& field, const Embedding& embedding) {
  std::vector<Point> result(embedding.vertices.size(), Point::Zero());
  for (std::size_t a = 0; a < result.size(); ++a)
    for (std::size_t k = 0; k < 4; ++k)
      result[a] +=
          embedding.weights[a][k] * field[static_cast<std::size_t>(embedding.vertices[a][k])];
  return result;
}

std::vector<double> sampling_times(double duration, int samples) {
  std::vector<double> times;
  for (int i = 1; i <= samples; ++i) times.push_back(duration * i / samples);
  return times;
}

TrajectorySampler::TrajectorySampler(const std::vector<double>& times, double step, long steps) {
  for (std::size_t j = 0; j < times.size(); ++j) {
    const double x = times[j] / step;
    if (std::abs(x - std::round(x)) < same_time) {
      terms_.push_back({std::lround(x), j, 1.0});
      continue;
    }
    const long count = std::min(fit_points, steps + 1);
    const long first = std::clamp(static_cast<long>(std::floor(x)) - 1, 0L, steps + 1 - count);
    for (long i = first; i < first + count; ++i)
      terms_.push_back({i, j, lagrange_weight(x, first, count, i)});
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
  for (const auto& u : trajectory.u) result.u.push_back(interpolated(u, embedding));
  for (const auto& v : trajectory.v) result.v.push_back(interpolated(v, embedding));
  return result;
}

namespace {

constexpr double rounding = 1e-12;  // motion that is rounding, over the body's size

struct Squares {
  std::vector<double> difference;  // per vertex, summed over time
  double reference = 0;            // sum over all vertices and times

  Squares(const std::vector<std::vector<Point>>& field, const std::vector<std::vector<Point>>& from)
      : difference(from.front().size(), 0.0) {
    for (std::size_t j = 0; j < from.size(); ++j)
      for (std::size_t a = 0; a < difference.size(); ++a) {
        difference[a] += (field[j][a] - from[j][a]).squaredNorm();
        reference += from[j][a].squaredNorm();
      }
  }
  double relative() const {
    double sum = 0;
    for (const double d : difference) sum += d;
    return std::sqrt(sum / reference);
  }
  double worst() const {
    const double mean = reference / static_cast<double>(difference.size());
    return std::sqrt(*std::ranges::max_element(difference) / mean);
  }
};

}  // namespace

void expect_motion(const Trajectory& trajectory, const TetMesh& mesh) {
  const Box box = bounding_box(mesh.vertices);
  const double least = rounding * (box.max - box.min).norm();
  for (const auto& field : trajectory.u)
    for (const Point& u : field)
      if (u.norm() > least) return;
  throw InputError(
      "study: nothing moves in the reference, so there is no error to measure; give the body "
      "gravity, a load or a "
      "velocity");
}

StudyErrors errors_of(const Trajectory& trajectory, const Trajectory& reference) {
  const Squares u(trajectory.u, reference.u), v(trajectory.v, reference.v);
  return {u.relative(), v.relative(), u.worst()};
}

double difference(const Trajectory& a, const Trajectory& b, const Trajectory& size) {
  double apart = 0, whole = 0;
  for (std::size_t j = 0; j < size.u.size(); ++j)
    for (std::size_t v = 0; v < size.u[j].size(); ++v) {
      apart += (a.u[j][v] - b.u[j][v]).squaredNorm();
      whole += size.u[j][v].squaredNorm();
    }
  return std::sqrt(apart / whole);
}

std::optional<double> error_at(const Trajectory& trajectory, const Trajectory& reference,
                               std::size_t vertex) {
  double difference = 0, size = 0;
  for (std::size_t j = 0; j < reference.u.size(); ++j) {
    difference += (trajectory.u[j][vertex] - reference.u[j][vertex]).squaredNorm();
    size += reference.u[j][vertex].squaredNorm();
  }
  if (size == 0) return {};
  return std::sqrt(difference / size);
}

double delay_of(const Trajectory& trajectory, const Trajectory& reference) {
  double product = 0, size = 0;
  for (std::size_t j = 0; j < reference.u.size(); ++j)
    for (std::size_t a = 0; a < reference.u[j].size(); ++a) {
      const Point& v = reference.v[j][a];
      product += v.dot(reference.u[j][a] - trajectory.u[j][a]);
      size += v.squaredNorm();
    }
  return product / size;
}

}  // namespace plica
