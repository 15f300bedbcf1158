// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <plica/core/obstacles.hpp>
#include <plica/drivers/solver/materials.hpp>
#include <string>
#include <vector>

/// Parts of a problem as its scene names them.
namespace plica::app {

/// A material of this kind: "neo_hookean, young_modulus 20 kPa, poisson_ratio 0.4, density 1000 kg/m^3". The parameters are those
/// that the material declares.
std::string material_text(const MaterialInfo& info, const MaterialOptions& material);

/// The same: {"model", each parameter by its name, "density"}, in SI units.
nlohmann::ordered_json material_json(const MaterialInfo& info, const MaterialOptions& material);

/// The obstacles, so that a picture can show what was hit. Of a surface its box and counts.
nlohmann::ordered_json obstacles_json(const std::vector<ObstacleOptions>& obstacles);

}  // namespace plica::app
