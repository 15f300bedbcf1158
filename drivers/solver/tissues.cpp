// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numbers>
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/drivers/solver/tissues.hpp>
#include <vector>

namespace plica {

namespace {

constexpr double kPa = 1e3, degree = std::numbers::pi / 180;

/// Values that two sources agree on; both take the tissue for incompressible, bulk_modulus is 50 times mu at rest or more.
struct Tissue {
  Choice name;
  std::string model;
  std::map<std::string, double> parameters;
};

const std::vector<Tissue>& list() {
  static const std::vector<Tissue> all = {
      {{"heart_muscle",
        "costa: a 2 kPa, b_ff 8, across 2, fibre and cross 4; needs body.fibres. "
        "Land et al., Proc. R. Soc. A 471:20150641, 2015, problem 1; read in the input of FEniCSx-pulse, not in the "
        "paper"},
       "costa",
       {{"a", 2 * kPa},
        {"b_ff", 8},
        {"b_ss", 2},
        {"b_nn", 2},
        {"b_sn", 2},
        {"b_fs", 4},
        {"b_fn", 4},
        {"bulk_modulus", 400 * kPa}}},
      {{"artery_adventitia",
        "holzapfel_gasser_ogden: c 7.64 kPa, k1 996.6 kPa, k2 524.6, kappa 0.226, angle 49.98 deg; "
        "needs body.fibres: axis around the artery, sheet along it. "
        "Gasser, Ogden & Holzapfel, J. R. Soc. Interface 3, 2006; read in the input of svFSI-Tests, not in the paper"},
       "holzapfel_gasser_ogden",
       {{"c", 7.64 * kPa},
        {"k1", 996.6 * kPa},
        {"k2", 524.6},
        {"kappa", 0.226},
        {"angle", 49.98 * degree},
        {"bulk_modulus", 15000 * kPa}}}};
  return all;
}

}  // namespace

std::vector<Choice> tissues() {
  std::vector<Choice> all;
  for (const Tissue& one : list()) all.push_back(one.name);
  return all;
}

MaterialOptions tissue_material(std::string_view name) {
  const auto found = std::ranges::find(list(), name, [](const Tissue& one) { return std::string_view(one.name.name); });
  if (found == list().end()) throw InputError(unknown_name("tissue", name, names(tissues())));
  MaterialOptions m;
  m.model = found->model, m.parameters = found->parameters, m.tissue = name;
  return m;
}

}  // namespace plica
