// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>
#include <plica/drivers/solver/set_up/make_path.hpp>

namespace plica {

namespace {

Vec3<double> vec(const Point& p) { return {p[0], p[1], p[2]}; }

}  // namespace

Path make_path(const Motion& motion, std::vector<PathKnot>& knots) {
  Path path;
  if (const auto* steady = std::get_if<SteadyMotion>(&motion)) {
    path.velocity = vec(steady->velocity);
  } else if (const auto* sine = std::get_if<SineMotion>(&motion)) {
    path.amplitude = vec(sine->amplitude);
    path.rate = 2 * std::numbers::pi * sine->frequency, path.phase = sine->phase;
  } else {
    const auto& polygon = std::get<PathMotion>(motion).knots;
    path.first_knot = static_cast<int>(knots.size()), path.knots = static_cast<int>(polygon.size());
    for (const auto& knot : polygon) knots.push_back({knot.time, vec(knot.displacement)});
  }
  return path;
}

bool moves(const Motion& motion) {
  if (const auto* steady = std::get_if<SteadyMotion>(&motion)) return steady->velocity.norm() > 0;
  if (const auto* sine = std::get_if<SineMotion>(&motion)) return sine->amplitude.norm() > 0;
  const auto& knots = std::get<PathMotion>(motion).knots;
  for (const auto& knot : knots)
    if (knot.displacement != knots.front().displacement) return true;
  return false;
}

}  // namespace plica
