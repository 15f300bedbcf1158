// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/functions.hpp>
#include <plica/core/small.hpp>

// A material is a struct of pointwise functions of the deformation gradient F = dx/dX, on T = a number or a pack:
//   energy(F, c)              energy density per rest volume [J/m^3]
//   stress(F, c)              first Piola-Kirchhoff stress P = d energy/dF [Pa]
//   Tangent<T>(F, c)          dP/dF at F: (dF) -> dP/dF : dF [Pa], symmetric as a bilinear form; what dF does not enter is
//                             worked out once. Its corner(g), of a gradient g, and block(p, q) of two such give the matrix
//                             a -> (dP/dF : (a q^T)) p, symmetric in (p, q) but for a transposition: an element matrix in few operations
//   stress_change(F, dF, c)   the same for one dF
// with the constants c [Pa], and says of itself:
//   name, summary             what a scene calls it; one line for lists
//   rotation_invariant        a rotated state has the same energy
//   survives_inversion        finite with finite derivatives for det F <= 0
//   recovers                  no stable state but rotations: inverted, flat and collapsed elements are pushed back
//   allows_inversion          whether an element with det F <= 0 goes on where a scene does not say, or ends the run
namespace plica {

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
