// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/kernels/materials/parameters.hpp>
#include <string_view>
#include <vector>

namespace plica {

/// What a material says of itself, without its kernels: see kernels/materials/material.hpp for
/// each.
struct MaterialInfo {
  std::string_view name;
  std::string_view summary;
  bool rotation_invariant;
  bool survives_inversion;
  bool recovers;
  bool allows_inversion;
  std::vector<MaterialParameter> parameters;
  /// What its kernels get, of the values of its parameters in their order.
  std::vector<double> (*kernel_constants)(const std::vector<double>& values);
  /// Lame's constants of its tangent at rest [Pa].
  Lame<double> (*small_strains)(const std::vector<double>& values);
  /// What its kernels get with another lambda at rest; a null pointer where the material has no
  /// stiffness for the volume alone.
  std::vector<double> (*with_lambda)(const std::vector<double>& values, double lambda);
  /// With the energy of shape times `share` and another bulk modulus [Pa]; a null pointer where it
  /// has no shape of its own.
  std::vector<double> (*with_shape)(const std::vector<double>& values, double share,
                                    double bulk) = nullptr;
  bool of_tissue = false;  ///< it has TissueSettings: behind its parameters' values
  bool has_fibres = false;
  bool has_terms = false;
};

/// Those of kernels/materials/list.hpp, in its order.
const std::vector<MaterialInfo>& material_list();

/// The one of that name, or a null pointer.
const MaterialInfo* find_material(std::string_view name);

/// Those given by Young's modulus and Poisson's ratio.
std::vector<std::string> materials_of_two_constants();

/// The values of its parameters, in their order: the region's where it has one of its own, else the
/// body's, else the standard; then the settings of laws of tissue.
std::vector<double> parameter_values(const MaterialInfo& info, const MaterialOptions& body,
                                     const RegionOptions& region);

/// Throws InputError where a value of the body or of one of its regions is out of range, belongs to
/// none of the material's parameters, is missing, or leaves the body without stiffness at rest.
void check_parameters(const MaterialInfo& info, const Body& body);

/// Young's modulus at rest [Pa]: as given, or of small strains where the material has no such
/// parameter.
double stiffness_at_rest(const MaterialOptions& material);
/// The P-wave modulus at rest, lambda + 2 mu [Pa]: much more than Young's where the volume hardly
/// changes.
double p_wave_modulus(const MaterialOptions& material);

/// Whether elements of that material may be inverted: by its options, or where they say nothing by
/// the material.
bool allows_inversion(const MaterialOptions& material);
/// Whether inverted elements of that material are pushed back; false for a name it does not know.
bool recovers(std::string_view material);

/// The material of one of tissues(), with the values of its source. InputError for another name.
MaterialOptions tissue_material(std::string_view name);

}  // namespace plica
