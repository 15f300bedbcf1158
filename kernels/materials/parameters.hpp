// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/keys.hpp>

// What materials are given. No kernel, no Kokkos: lists, validation and readers include this.
namespace plica {

/// Those that are options of every body.
namespace parameter {
inline constexpr MaterialParameter young_modulus{
    "young_modulus", {keys::pressure, keys::positive}, "stiffness E", 20e3};
inline constexpr MaterialParameter poisson_ratio{
    "poisson_ratio", {keys::plain, {.min = 0, .max = 0.5, .max_excluded = true}}, "lateral contraction nu", 0.4};
}  // namespace parameter

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
