// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/core/patches.hpp>
#include <vector>

namespace plica {

/// Returns tetrahedra in runs along the mesh's Hilbert curve, see tets_along_curve(). A run is of
/// one region and in mesh order, and has at most `elements` elements and `vertices` vertices.
///
/// The curve is cut into stretches of 4096 tetrahedra, and each region's part of a stretch into
/// runs. So a run depends on its own stretch alone.
std::vector<std::vector<int>> element_runs(const TetMesh& mesh, int elements, int vertices);

/// Returns the patches of a mesh.
/// @param constants  constants of the material per region, the same number in every region
/// @param damping    stiffness-proportional damping per region [s]; one entry where the mesh names
///                   no region; empty: no damping
/// @param runs       tetrahedra of each patch; null: element_runs(), all of them
template <class B>
Patches<B> build_patches(const TetMesh& mesh, const std::vector<std::vector<double>>& constants,
                         const std::vector<double>& damping = {},
                         const std::vector<std::vector<int>>* runs = nullptr);

}  // namespace plica
