// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/solver/materials.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/kernels/materials/list.hpp>

namespace plica {

const std::vector<MaterialInfo>& material_list() {
  static const std::vector<MaterialInfo> list = [] {
    std::vector<MaterialInfo> all;
    Materials::for_each([&](auto material) {
      using M = decltype(material);
      all.push_back(
          {M::name, M::summary, M::rotation_invariant, M::survives_inversion, M::recovers, M::allows_inversion});
    });
    return all;
  }();
  return list;
}

const MaterialInfo* find_material(std::string_view name) {
  const auto found = std::ranges::find(material_list(), name, &MaterialInfo::name);
  return found == material_list().end() ? nullptr : &*found;
}

std::vector<Choice> materials() {
  std::vector<Choice> list;
  for (const MaterialInfo& one : material_list()) list.push_back({std::string(one.name), std::string(one.summary)});
  return list;
}

bool allows_inversion(const MaterialOptions& material) {
  const MaterialInfo* info = find_material(material.model);
  return material.allow_inversion.value_or(info != nullptr && info->allows_inversion);
}

bool recovers(std::string_view material) {
  const MaterialInfo* info = find_material(material);
  return info != nullptr && info->recovers;
}

}  // namespace plica
