// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/mesh.hpp>

namespace plica {

/// Returns the volume that two tetrahedra have in common, exact to rounding [m^3].
/// @param a  corners of a tetrahedron with positive volume [m]
/// @param b  corners of another one [m]
double common_volume(const std::array<Point, 4>& a, const std::array<Point, 4>& b);

}  // namespace plica
