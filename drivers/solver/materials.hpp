// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string_view>
#include <vector>

namespace plica {

/// What a material says of itself, without its kernels: see kernels/materials/material.hpp for each.
struct MaterialInfo {
  std::string_view name;
  std::string_view summary;
  bool rotation_invariant;
  bool survives_inversion;
  bool recovers;
  bool allows_inversion;
};

/// Those of kernels/materials/list.hpp, in its order.
const std::vector<MaterialInfo>& material_list();

/// The one of that name, or a null pointer.
const MaterialInfo* find_material(std::string_view name);

}  // namespace plica
