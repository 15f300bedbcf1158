// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/type_list.hpp>
#include <plica/kernels/materials/corotational.hpp>
#include <plica/kernels/materials/linear.hpp>
#include <plica/kernels/materials/neo_hookean.hpp>
#include <plica/kernels/materials/st_venant_kirchhoff.hpp>
#include <plica/kernels/materials/tissue_laws.hpp>

namespace plica {

/// Materials with kernels of their own. One more: its file above, its name here. Laws of invariants
/// and fibres are better in tissue_laws.hpp, which costs no kernels.
using OwnMaterials = TypeList<StVenantKirchhoff, Corotational, NeoHookean, Linear>;

/// Every material there is.
using Materials = JoinedLists<OwnMaterials, IsochoricLaws>::type;

/// Whose kernels compute a material.
template <class Material>
using KernelsOf = std::conditional_t<IsochoricLaws::has<Material>, TissueLaws, Material>;

}  // namespace plica
