// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/drivers/study/limit.hpp>

namespace plica {

namespace {

constexpr double least_order = 0.8, most_order = 3;  // range of observed orders that are believed

Trajectory picked(const Trajectory& from, const std::vector<int>& vertices) {
  Trajectory result{from.times, {}, {}};
  const auto pick = [&](const std::vector<std::vector<Point>>& fields,
                        std::vector<std::vector<Point>>& to) {
    for (const auto& field : fields) {
      auto& one = to.emplace_back();
      for (const int v : vertices) one.push_back(field[static_cast<std::size_t>(v)]);
    }
  };
  pick(from.u, result.u), pick(from.v, result.v);
  return result;
}

}  // namespace

Trajectory extrapolated(const Trajectory& fine, const Trajectory& coarse, double order) {
  const double weight = 1 / (std::exp2(order) - 1);
  Trajectory limit = fine;
  const auto add = [weight](std::vector<std::vector<Point>>& to,
                            const std::vector<std::vector<Point>>& from) {
    for (std::size_t j = 0; j < to.size(); ++j)
      for (std::size_t a = 0; a < to[j].size(); ++a) to[j][a] += weight * (to[j][a] - from[j][a]);
  };
  add(limit.u, coarse.u), add(limit.v, coarse.v);
  return limit;
}

Limit richardson_limit(const Trajectory& fine, const Trajectory& coarse, const Trajectory* coarsest,
                       const std::vector<int>& common, double assumed) {
  Limit limit;
  limit.used_order = assumed;
  Trajectory fine_there, coarse_there;
  if (coarsest != nullptr) {
    fine_there = picked(fine, common), coarse_there = picked(coarse, common);
    const double before = difference(*coarsest, coarse_there, fine_there);
    const double after = difference(coarse_there, fine_there, fine_there);
    limit.order = std::log2(before / after);
    limit.used_order = std::isfinite(*limit.order) ? std::clamp(*limit.order, 1.0, 2.0) : assumed;
  }
  limit.trajectory = extrapolated(fine, coarse, limit.used_order);
  const StudyErrors correction = errors_of(fine, limit.trajectory);
  limit.correction = limit.own_error = correction.displacement,
  limit.own_error_velocity = correction.velocity;
  const bool believed =  // an order that is NaN is not
      limit.order && *limit.order >= least_order && *limit.order <= most_order;
  if (!believed) return limit;
  const StudyErrors own = errors_of(extrapolated(coarse_there, *coarsest, limit.used_order),
                                    extrapolated(fine_there, coarse_there, limit.used_order));
  const double shrinks = std::exp2(limit.used_order) - 1;
  limit.own_error = own.displacement / shrinks, limit.own_error_velocity = own.velocity / shrinks;
  return limit;
}

double Truth::error() const {
  // the difference first: std::max() returns its first argument where one is NaN
  return std::max(difference - check.own_error, family.own_error) + time_error;
}

}  // namespace plica
