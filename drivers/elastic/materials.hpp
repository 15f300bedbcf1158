// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/kernels/materials/parameters.hpp>
#include <string_view>
#include <vector>

namespace plica {

/// Properties of a material, without its kernels; kernels/materials/material.hpp explains each.
struct MaterialInfo {
  std::string_view name;
  std::string_view summary;
  bool rotation_invariant;
  bool survives_inversion;
  bool recovers;
  bool allows_inversion;
  std::vector<MaterialParameter> parameters;
  /// Returns the constants of the kernels from the parameters' values, in the parameters' order.
  std::vector<double> (*kernel_constants)(const std::vector<double>& values);
  /// Returns Lame's constants of the tangent at rest [Pa].
  Lame<double> (*small_strains)(const std::vector<double>& values);
  /// Returns the constants of the kernels with another lambda at rest [Pa].
  /// Null where the material has no stiffness of the volume alone.
  std::vector<double> (*with_lambda)(const std::vector<double>& values, double lambda);
  /// Returns the constants with the energy of shape times `share` and another bulk modulus [Pa].
  /// Null where the material does not split shape from volume.
  std::vector<double> (*with_shape)(const std::vector<double>& values, double share,
                                    double bulk) = nullptr;
  bool smooths_dilatation = false;  ///< true: nodal elements can smooth its pressures
  bool of_tissue = false;           ///< true: TissueSettings follow the parameters' values
  bool has_fibres = false;
  bool has_terms = false;
};

/// Returns the materials of kernels/materials/list.hpp, in the order there.
const std::vector<MaterialInfo>& material_list();

/// Returns the material of a name, or a null pointer.
const MaterialInfo* find_material(std::string_view name);

/// Returns the names of the materials that Young's modulus and Poisson's ratio define.
std::vector<std::string> materials_of_two_constants();

/// Returns the values of a material's parameters, in their order, then the settings of tissue laws.
/// A value is the region's, where it has one, else the body's, else the standard one.
std::vector<double> parameter_values(const MaterialInfo& info, const MaterialOptions& body,
                                     const RegionOptions& region);

/// Throws InputError where a value of the body or of one of its regions is out of range, belongs to
/// none of the material's parameters, is missing, or leaves the body without stiffness at rest.
void check_parameters(const MaterialInfo& info, const Body& body);

/// Returns Young's modulus at rest [Pa].
/// It is that of small strains where the material has no such parameter.
double stiffness_at_rest(const MaterialOptions& material);
/// Returns the P-wave modulus at rest, lambda + 2 mu [Pa].
/// It is much larger than Young's modulus where the material is nearly incompressible.
double p_wave_modulus(const MaterialOptions& material);

/// Returns true where elements of a material may be inverted.
/// The options decide, or the material itself where the options say nothing.
bool allows_inversion(const MaterialOptions& material);
/// Returns true where a material pushes inverted elements back; false for an unknown name.
bool recovers(std::string_view material);

/// Returns the material of one of tissues(), with the values of its source.
/// Throws InputError for another name.
MaterialOptions tissue_material(std::string_view name);

}  // namespace plica
