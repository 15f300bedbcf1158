// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/core/patches.hpp>
#include <plica/kernels/materials/material.hpp>
#include <vector>

namespace plica {

/// The patches of a mesh with Lame's constants per region [Pa] (one entry where the mesh names none).
template <class B>
Patches<B> build_patches(const TetMesh& mesh, const std::vector<Lame<double>>& lame);

}  // namespace plica
