// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>
#include <plica/drivers/study/verify/radial.hpp>

namespace plica {

namespace {

/// Returns the radial stretch at which the radial stress is s. It is found by bisection, since the
/// stress rises with its own stretch.
double radial_stretch(const RadialWall& wall, double hoop, double s) {
  double low = 0.1, high = 10;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    const Radial stress = wall.stress({middle, hoop, wall.ball ? hoop : wall.along});
    (stress[0] > s ? high : low) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

RadialState inflated(const RadialWall& wall, double growth) {
  constexpr int steps = 500;
  // y: radius, radial stress, axial force of what lies outside
  const auto slope = [&](double R, const Radial& y) -> Radial {
    const double hoop = y[0] / R, radial = radial_stretch(wall, hoop, y[1]);
    const Radial stress = wall.stress({radial, hoop, wall.ball ? hoop : wall.along});
    return {radial, -(wall.ball ? 2 : 1) * (y[1] - stress[1]) * radial / y[0],
            -2 * std::numbers::pi * y[0] * radial * stress[2]};
  };
  const double h = (wall.inner - wall.outer) / steps;
  Radial y(growth * wall.outer, 0, 0);
  for (int i = 0; i < steps; ++i) {
    const double R = wall.outer + i * h;
    const Radial a = slope(R, y), b = slope(R + h / 2, y + h / 2 * a),
                 c = slope(R + h / 2, y + h / 2 * b), d = slope(R + h, y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return {-y[1], y[0], y[2]};
}

}  // namespace plica
