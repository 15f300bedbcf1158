// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/core/patches.hpp>
#include <vector>

namespace plica {

/// Tetrahedra in groups of neighbours: each of one region, with at most `elements` of them and
/// `vertices` vertices. Within a group in mesh order. By recursive bisection across the longest
/// extent of the centroids.
std::vector<std::vector<int>> element_clusters(const TetMesh& mesh, int elements, int vertices);

/// The patches of a mesh with the constants of its material, as many in every region, and
/// stiffness-proportional damping [s] per region (one entry where the mesh names none; empty: no
/// damping).
template <class B>
Patches<B> build_patches(const TetMesh& mesh, const std::vector<std::vector<double>>& constants,
                         const std::vector<double>& damping = {});

}  // namespace plica
