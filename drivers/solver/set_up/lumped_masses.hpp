// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <vector>

namespace plica {

/// Per region of a mesh its density [kg/m^3]; one entry where it names none.
std::vector<double> region_densities(const Body& body, const TetMesh& mesh);

/// Per vertex a quarter of the mass of each of its tetrahedra [kg].
std::vector<double> lumped_masses(const TetMesh& mesh, const std::vector<double>& density);

}  // namespace plica
