// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/keys.hpp>

// Parameters of materials. No kernel, no Kokkos: lists, validation and readers include this file.
namespace plica {

/// Parameters of materials that are options of every body.
namespace parameter {
inline constexpr MaterialParameter young_modulus{
    "young_modulus", {keys::pressure, keys::stiffness}, "stiffness E", 20e3};
inline constexpr MaterialParameter poisson_ratio{
    "poisson_ratio",
    {keys::plain, {.min = 0, .max = 0.5, .max_excluded = true}},
    "lateral contraction nu",
    0.4};
// Parameters that several laws of tissue have in common
inline constexpr MaterialParameter bulk_modulus{
    "bulk_modulus",
    {keys::pressure, keys::stiffness},
    "of laws of tissue: kappa, stiffness of the volume at rest",
    33e3};
inline constexpr MaterialParameter mu{"mu",
                                      {keys::pressure, keys::stiffness},
                                      "shear stiffness; of fibrous laws that of the matrix",
                                      5e3};
inline constexpr MaterialParameter c10{
    "c10",
    {keys::pressure},
    "of mooney_rivlin and polynomial: times I1 - 3; 2 (c10 + c01) is mu at rest",
    2.5e3};
inline constexpr MaterialParameter c01{
    "c01", {keys::pressure}, "of mooney_rivlin and polynomial: times I2 - 3", 1e3};
}  // namespace parameter

/// Settings that laws of tissue get in addition to their parameters, stored behind them.
struct TissueSettings {
  static constexpr int most_terms = 6;
  double volume = 0;                             ///< place in volumes()
  double axis[3] = {2 / 3., 2 / 3., 1 / 3.};     ///< unit vector of fibres
  double sheet[3] = {-2 / 3., 1 / 3., 2 / 3.};   ///< unit vector of their sheet, orthogonal to axis
  double coefficient[most_terms] = {600, 1000};  ///< c of Ogden's terms [Pa]; 0: none
  double exponent[most_terms] = {4, -2};         ///< alpha of Ogden's terms
};

/// Lame's constants [Pa]: lambda = E nu / ((1 + nu)(1 - 2 nu)), mu = E / (2 (1 + nu)).
template <class T>
struct Lame {
  T lambda;
  T mu;
};

inline Lame<double> lame_constants(double young_modulus, double poisson_ratio) {
  return {young_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio)),
          young_modulus / (2 * (1 + poisson_ratio))};
}

}  // namespace plica
