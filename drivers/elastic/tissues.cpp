// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numbers>
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <utility>

// Materials by the name of a tissue. Their sources assume incompressible tissue; kappa here is
// about 50 times mu at rest. Densities are those of ICRU Report 44, Tissue Substitutes in Radiation
// Dosimetry and Measurement, 1989, or else 1000 kg/m^3.
namespace plica {

namespace {

constexpr double kPa = 1e3, degree = std::numbers::pi / 180;
constexpr double nearly = 0.49;  // nu at which kappa is 49.7 mu

struct Tissue {
  Choice name;
  MaterialOptions material;
};

/// Returns a neo-Hookean material.
/// @param mu       shear modulus at rest [Pa]
/// @param density  [kg/m^3]
/// @param prony    relaxation; empty: elastic
MaterialOptions of_shear_modulus(double mu, double density, std::vector<PronyTerm> prony = {}) {
  return {.young_modulus = 2 * (1 + nearly) * mu,
          .poisson_ratio = nearly,
          .density = density,
          .prony = std::move(prony)};
}

const std::vector<Tissue>& tissue_list() {
  static const std::vector<Tissue> all = {
      {{"heart_muscle",
        "costa: a 2 kPa, b_ff 8, across 2, fibre and cross 4; needs body.fibres. "
        "Land et al., Proc. R. Soc. A 471:20150641, 2015, problem 1; read in the input of "
        "FEniCSx-pulse, not in the "
        "paper"},
       {.model = "costa",
        .parameters = {{"a", 2 * kPa},
                       {"b_ff", 8},
                       {"b_ss", 2},
                       {"b_nn", 2},
                       {"b_sn", 2},
                       {"b_fs", 4},
                       {"b_fn", 4},
                       {"bulk_modulus", 400 * kPa}}}},
      {{"artery_adventitia",
        "holzapfel_gasser_ogden: c 7.64 kPa, k1 996.6 kPa, k2 524.6, kappa 0.226, angle 49.98 deg; "
        "needs body.fibres: axis around the artery, sheet along it. "
        "Gasser, Ogden & Holzapfel, J. R. Soc. Interface 3, 2006; read in the input of "
        "svFSI-Tests, not in the paper"},
       {.model = "holzapfel_gasser_ogden",
        .parameters = {{"c", 7.64 * kPa},
                       {"k1", 996.6 * kPa},
                       {"k2", 524.6},
                       {"kappa", 0.226},
                       {"angle", 49.98 * degree},
                       {"bulk_modulus", 15000 * kPa}}}},
      {{"liver",
        "neo_hookean: mu 2.0 kPa, that of small waves in healthy livers; a liver stiffens at large "
        "strains, this law does not. Rouviere et al., Radiology 240, 2006, "
        "doi:10.1148/radiol.2402050606: 2.0 +- 0.3 kPa; J. Magn. Reson. Imaging 39, 2014, "
        "doi:10.1002/jmri.24084: 2.09 +- 0.22 kPa; both read in the abstract"},
       of_shear_modulus(2.0 * kPa, 1060)},
      {{"kidney",
        "neo_hookean: mu 4.9 kPa, that of small waves at 45 Hz in healthy kidneys; at 76 Hz it is "
        "9.4 kPa, and in slow motion less. Rouviere et al., J. Magn. Reson. "
        "Imaging 34, 2011, doi:10.1002/jmri.22670: 4.9 +- 0.5 kPa; read in the abstract"},
       of_shear_modulus(4.9 * kPa, 1050)},
      {{"fat",
        "neo_hookean: mu 0.53 kPa, prony alpha 0.39, tau 700 s; below the skin of pigs, pressed "
        "slowly. Sims et al., Biomech. Model. Mechanobiol. 9, 2010, "
        "doi:10.1007/s10237-010-0207-9: 0.53 +- 0.31 kPa, 0.39 +- 0.03, 700 +- 255 s; read in the "
        "abstract, mu taken as that at once"},
       of_shear_modulus(0.53 * kPa, 950, {{0.39, 700}})},
      {{"brain",
        "ogden: mu 842 Pa, alpha -4.7, two_mu_over_alpha2, prony alpha 0.450 and 0.365, tau 0.5 s "
        "and 50 s; of pigs, in slow tension and compression. Miller & Chinzei, J. Biomech. 35, "
        "2002, doi:10.1016/S0021-9290(01)00234-2; as it is quoted, not read in the paper"},
       {.model = "ogden",
        .density = 1040,
        .parameters = {{"bulk_modulus", 50 * 842.0}},
        .convention = "two_mu_over_alpha2",
        .terms = {{842, -4.7}},
        .prony = {{0.450, 0.5}, {0.365, 50}}}},
      {{"skin",
        "polynomial: c10 9.4 kPa, c11 82 kPa; of the forearm, sucked into an opening of some "
        "millimetres. Pulled in its plane, skin is up to a hundred times as stiff. Hendriks et "
        "al., Skin Res. Technol. 9, 2003, doi:10.1034/j.1600-0846.2003.00019.x: 9.4 +- 3.6 and 82 "
        "+- 60 kPa; the means read in the sources of FunG, not in the paper"},
       {.model = "polynomial",
        .density = 1090,
        .parameters = {{"c10", 9.4 * kPa},
                       {"c01", 0},
                       {"c20", 0},
                       {"c11", 82 * kPa},
                       {"c02", 0},
                       {"bulk_modulus", 50 * 2 * 9.4 * kPa}}}}};
  return all;
}

}  // namespace

std::vector<Choice> tissues() {
  std::vector<Choice> all;
  for (const Tissue& one : tissue_list()) all.push_back(one.name);
  return all;
}

MaterialOptions tissue_material(std::string_view name) {
  const auto found = std::ranges::find(
      tissue_list(), name, [](const Tissue& one) { return std::string_view(one.name.name); });
  if (found == tissue_list().end())
    throw InputError(unknown_name("tissue", name, names(tissues())));
  MaterialOptions m = found->material;
  m.tissue = name;
  return m;
}

}  // namespace plica
