// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/type_list.hpp>
#include <plica/kernels/materials/corotational.hpp>
#include <plica/kernels/materials/linear.hpp>
#include <plica/kernels/materials/neo_hookean.hpp>
#include <plica/kernels/materials/st_venant_kirchhoff.hpp>
#include <plica/kernels/materials/tissue_laws.hpp>

namespace plica {

/// Materials with kernels of their own. To add one, include its file and name it here. Laws of
/// invariants and fibres are better in tissue_laws.hpp, where they need no further kernels.
using OwnMaterials = TypeList<StVenantKirchhoff, Corotational, NeoHookean, Linear>;

/// Every material there is.
using Materials = JoinedLists<OwnMaterials, IsochoricLaws>::type;

/// Material whose kernels compute a given material.
template <class Material>
using KernelsOf = std::conditional_t<IsochoricLaws::has<Material>, TissueLaws, Material>;

}  // namespace plica
