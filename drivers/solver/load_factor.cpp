// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>
#include <plica/drivers/solver/load_factor.hpp>

namespace plica {

namespace {

using std::numbers::pi;

struct FactorAt {
  double time;
  double operator()(const ConstantCourse&) const { return 1; }
  double operator()(const RampCourse& c) const {
    return time < c.duration ? 0.5 * (1 - std::cos(pi * time / c.duration)) : 1;
  }
  double operator()(const SineCourse& c) const { return std::sin(2 * pi * c.frequency * time + c.phase); }
  double operator()(const PolygonCourse& c) const {
    const auto after = std::upper_bound(c.knots.begin(), c.knots.end(), time,
                                        [](double t, const PolygonCourse::Knot& knot) { return t < knot.time; });
    if (after == c.knots.begin()) return after->factor;
    const auto before = after - 1;
    if (after == c.knots.end()) return before->factor;
    return before->factor + (after->factor - before->factor) * (time - before->time) / (after->time - before->time);
  }
};

}  // namespace

double load_factor(const LoadCourse& course, double time) { return std::visit(FactorAt{time}, course); }

}  // namespace plica
