// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/core/reports.hpp>
#include <plica/kernels/materials/parameters.hpp>
#include <vector>

namespace plica {

/// 2/w of every element alone with its share of the mass at rest [s]; without contact.
std::vector<double> element_steps(const TetMesh& mesh, const std::vector<Lame<double>>& lame,
                                  const std::vector<double>& density);

/// The smallest of them: w_max never exceeds that element's (Irons 1971), so that it is on the sure
/// side.
double element_bound(const TetMesh& mesh, const std::vector<Lame<double>>& lame,
                     const std::vector<double>& density);

/// The at most `count` elements of the smallest steps, the worst first; of equal ones, the first.
std::vector<StiffElement> stiffest_elements(const TetMesh& mesh, const std::vector<double>& steps,
                                            std::size_t count);

}  // namespace plica
