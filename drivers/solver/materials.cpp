// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/materials.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/kernels/materials/list.hpp>

namespace plica {

namespace {

template <class M>
MaterialInfo describe_material() {
  MaterialInfo info{M::name,
                    M::summary,
                    M::rotation_invariant,
                    M::survives_inversion,
                    M::recovers,
                    M::allows_inversion,
                    {M::parameters.begin(), M::parameters.end()},
                    nullptr,
                    nullptr,
                    nullptr};
  info.kernel_constants = [](const std::vector<double>& values) { return as_list(M::kernel_constants(values.data())); };
  info.small_strains = [](const std::vector<double>& values) {
    return M::small_strains(M::kernel_constants(values.data()));
  };
  if constexpr (requires(typename M::template Constants<double> c) { M::with_lambda(c, 0.0); })
    info.with_lambda = [](const std::vector<double>& values, double lambda) {
      return as_list(M::with_lambda(M::kernel_constants(values.data()), lambda));
    };
  return info;
}

/// What is given for a parameter, if anything.
std::optional<double> given(const std::string& name, const MaterialOptions& body, const RegionOptions& region) {
  if (name == parameter::young_modulus.name) return region.young_modulus.value_or(body.young_modulus);
  if (name == parameter::poisson_ratio.name) return region.poisson_ratio.value_or(body.poisson_ratio);
  for (const auto* values : {&region.parameters, &body.parameters})
    if (const auto found = values->find(name); found != values->end()) return found->second;
  return {};
}

void check_names(const MaterialInfo& info, const std::string& path, const std::map<std::string, double>& values) {
  std::vector<std::string> known;
  for (const MaterialParameter& p : info.parameters) known.emplace_back(p.name);
  for (const auto& [name, value] : values) {
    if (std::ranges::find(known, name) == known.end())
      throw InputError(path + name + ": " + unknown_name("parameter of " + std::string(info.name), name, known));
    if (name == parameter::young_modulus.name || name == parameter::poisson_ratio.name)
      throw InputError(path + name + " is given twice: as an option, and among the other parameters");
  }
}

}  // namespace

std::vector<double> parameter_values(const MaterialInfo& info, const MaterialOptions& body,
                                     const RegionOptions& region) {
  std::vector<double> values;
  for (const MaterialParameter& p : info.parameters) values.push_back(given(p.name, body, region).value_or(p.standard));
  return values;
}

void check_parameters(const MaterialInfo& info, const Body& body) {
  check_names(info, "body.material.", body.material.parameters);
  for (const auto& [name, region] : body.regions) check_names(info, "body.regions." + name + ".", region.parameters);
  const auto check = [&](const std::string& path, const RegionOptions& region) {
    for (const MaterialParameter& p : info.parameters)
      if (const auto value = given(p.name, body.material, region)) p.kind.check(path + p.name, *value);
  };
  check("body.material.", {});
  for (const auto& [name, region] : body.regions) check("body.regions." + name + ".", region);
}

double stiffness_at_rest(const MaterialOptions& material) {
  const MaterialInfo& info = *find_material(material.model);
  for (const MaterialParameter& p : info.parameters)
    if (p.name == std::string_view(parameter::young_modulus.name)) return material.young_modulus;
  const Lame<double> c = info.small_strains(parameter_values(info, material, {}));
  return c.mu * (3 * c.lambda + 2 * c.mu) / (c.lambda + c.mu);
}

const std::vector<MaterialInfo>& material_list() {
  static const std::vector<MaterialInfo> list = [] {
    std::vector<MaterialInfo> all;
    Materials::for_each([&](auto material) { all.push_back(describe_material<decltype(material)>()); });
    return all;
  }();
  return list;
}

const MaterialInfo* find_material(std::string_view name) {
  const auto found = std::ranges::find(material_list(), name, &MaterialInfo::name);
  return found == material_list().end() ? nullptr : &*found;
}

std::vector<MaterialParameter> material_parameters() {
  std::vector<MaterialParameter> all;
  const auto has = [&](std::string_view name) {
    return name == parameter::young_modulus.name || name == parameter::poisson_ratio.name ||
           std::ranges::any_of(all, [&](const MaterialParameter& p) { return p.name == name; });
  };
  for (const MaterialInfo& one : material_list())
    for (const MaterialParameter& p : one.parameters)
      if (!has(p.name)) all.push_back(p);
  return all;
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
