// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/kernels/materials/material.hpp>
#include <vector>

namespace plica {

/// 2/w of the stiffest single element with its share of the mass at rest [s]: w_max never exceeds that element's (Irons 1971), so
/// that it is on the sure side; without contact.
double element_bound(const TetMesh& mesh, const std::vector<Lame<double>>& lame, const std::vector<double>& density);

}  // namespace plica
