// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/core/patches.hpp>
#include <vector>

namespace plica {

/// The patches of a mesh with the constants of its material, as many in every region, and stiffness-proportional damping [s] per
/// region (one entry where the mesh names none; empty: no damping).
template <class B>
Patches<B> build_patches(const TetMesh& mesh, const std::vector<std::vector<double>>& constants,
                         const std::vector<double>& damping = {});

}  // namespace plica
