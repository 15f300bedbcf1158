// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <vector>

namespace plica {

/// Momentum of a body.
struct Momenta {
  Point linear = Point::Zero();   ///< sum of m v [N s]
  Point angular = Point::Zero();  ///< sum of x cross m v, about the origin [N m s]
};

/// Returns the momentum of masses [kg] at places [m] with velocities [m/s].
Momenta momenta_of(const std::vector<double>& mass, const std::vector<Point>& x,
                   const std::vector<Point>& v);

/// Changes the velocities of some vertices by one rigid motion, so that the body has a given
/// momentum, linear and angular, to rounding. Of the changes that do so it is the one of least
/// kinetic energy. Vertices on one line do not take up what would turn them about it.
/// @param chosen  vertices that change, each with mass; none: nothing changes
void restore_momenta(const Momenta& given, const std::vector<double>& mass,
                     const std::vector<Point>& x, const std::vector<int>& chosen,
                     std::vector<Point>& v);

}  // namespace plica
