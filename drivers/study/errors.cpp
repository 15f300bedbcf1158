// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/study/errors.hpp>

namespace plica {

namespace {

constexpr double rounding = 1e-12;  // of the body's size

struct Squares {
  std::vector<double> difference;  // per vertex, summed over time
  double reference = 0;            // of all vertices

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
      "study: nothing moves in the reference, so there is no error to measure; give the body gravity, a load or a "
      "velocity");
}

StudyErrors errors_of(const Trajectory& trajectory, const Trajectory& reference) {
  const Squares u(trajectory.u, reference.u), v(trajectory.v, reference.v);
  return {u.relative(), v.relative(), u.worst()};
}

std::optional<double> error_at(const Trajectory& trajectory, const Trajectory& reference, std::size_t vertex) {
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
