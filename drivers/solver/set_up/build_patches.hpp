// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/core/patches.hpp>
#include <plica/kernels/materials/material.hpp>
#include <vector>

namespace plica {

/// The patches of a mesh with Lame's constants [Pa] and stiffness-proportional damping [s] per region (one entry where the mesh
/// names none; empty: no damping).
template <class B>
Patches<B> build_patches(const TetMesh& mesh, const std::vector<Lame<double>>& lame,
                         const std::vector<double>& damping = {});

}  // namespace plica
