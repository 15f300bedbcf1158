// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/core/reports.hpp>
#include <plica/kernels/materials/parameters.hpp>
#include <vector>

namespace plica {

/// Returns 2/w of every element alone, with its share of the mass, at rest [s].
/// Contact is not included.
std::vector<double> element_steps(const TetMesh& mesh, const std::vector<Lame<double>>& lame,
                                  const std::vector<double>& density);

/// Returns the smallest of the element_steps() [s].
/// The mesh's w_max never exceeds that of the element (Irons 1971): the result is on the safe side.
double element_bound(const TetMesh& mesh, const std::vector<Lame<double>>& lame,
                     const std::vector<double>& density);

/// Returns the elements with the smallest steps, at most `count`, the smallest step first.
/// Of equal steps the element with the lower number comes first.
std::vector<StiffElement> stiffest_elements(const TetMesh& mesh, const std::vector<double>& steps,
                                            std::size_t count);

}  // namespace plica
