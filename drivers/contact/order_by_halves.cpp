// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <bit>
#include <numeric>
#include <plica/drivers/contact/order_by_halves.hpp>
#include <span>

namespace plica {

namespace {

void halve_run(const std::vector<Point>& points, std::span<int> run) {
  if (run.size() < 2) return;
  const auto at = [&](int i) { return points[static_cast<std::size_t>(i)]; };
  Point low = at(run.front()), high = low;
  for (const int i : run) low = low.cwiseMin(at(i)), high = high.cwiseMax(at(i));
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t half = std::bit_ceil(run.size()) / 2;
  std::nth_element(run.begin(), run.begin() + static_cast<std::ptrdiff_t>(half), run.end(),
                   [&](int a, int b) {
                     const double x = at(a)[axis], y = at(b)[axis];
                     return x < y || (x == y && a < b);
                   });
  halve_run(points, run.first(half));
  halve_run(points, run.subspan(half));
}

}  // namespace

std::vector<int> order_by_halves(const std::vector<Point>& points) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  halve_run(points, order);
  return order;
}

}  // namespace plica
