// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/core/patches.hpp>
#include <vector>

namespace plica {

/// Returns tetrahedra in groups of neighbours, with at most `elements` elements and `vertices`
/// vertices. Each group is of one region, and in mesh order. Groups are made by recursive bisection
/// across the longest extent of the centroids.
std::vector<std::vector<int>> element_clusters(const TetMesh& mesh, int elements, int vertices);

/// Returns the patches of a mesh.
/// @param constants  constants of the material per region, the same number in every region
/// @param damping    stiffness-proportional damping per region [s]; one entry where the mesh names
///                   no region; empty: no damping
template <class B>
Patches<B> build_patches(const TetMesh& mesh, const std::vector<std::vector<double>>& constants,
                         const std::vector<double>& damping = {});

}  // namespace plica
