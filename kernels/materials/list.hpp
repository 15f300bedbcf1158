// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/type_list.hpp>
#include <plica/kernels/materials/corotational.hpp>
#include <plica/kernels/materials/linear.hpp>
#include <plica/kernels/materials/neo_hookean.hpp>
#include <plica/kernels/materials/st_venant_kirchhoff.hpp>

namespace plica {

/// Every material there is. One more: its file above, its name here.
using Materials = TypeList<StVenantKirchhoff, Corotational, NeoHookean, Linear>;

}  // namespace plica
