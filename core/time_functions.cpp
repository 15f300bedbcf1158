// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>
#include <plica/core/time_functions.hpp>

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

namespace {

using std::numbers::pi;

struct FactorAt {
  double time;
  double operator()(const ConstantCourse&) const { return 1; }
  double operator()(const RampCourse& c) const {
    return time < c.duration ? 0.5 * (1 - std::cos(pi * time / c.duration)) : 1;
  }
  double operator()(const SineCourse& c) const {
    return std::sin(2 * pi * c.frequency * time + c.phase);
  }
  double operator()(const PolygonCourse& c) const {
    const auto after =
        std::upper_bound(c.knots.begin(), c.knots.end(), time,
                         [](double t, const PolygonCourse::Knot& knot) { return t < knot.time; });
    if (after == c.knots.begin()) return after->factor;
    const auto before = after - 1;
    if (after == c.knots.end()) return before->factor;
    return before->factor +
           (after->factor - before->factor) * (time - before->time) / (after->time - before->time);
  }
};

}  // namespace

double load_factor(const LoadCourse& course, double time) {
  return std::visit(FactorAt{time}, course);
}

}  // namespace plica
