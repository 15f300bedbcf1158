// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cstring>
#include <plica/core/functions.hpp>
#include <plica/core/small.hpp>
#include <plica/kernels/materials/parameters.hpp>
#include <type_traits>
#include <utility>
#include <vector>

// A material is a struct of pointwise functions of the deformation gradient F = dx/dX, on T = a
// number or a pack:
//   energy(F, c)              energy density per rest volume [J/m^3]
//   stress(F, c)              first Piola-Kirchhoff stress P = d energy/dF [Pa]
//   Tangent<T>(F, c)          dP/dF at F: (dF) -> dP/dF : dF [Pa], symmetric as a bilinear form;
//                             what dF does not enter is worked out once. Its corner(g), of a
//                             gradient g, and block(p, q) of two corners give the matrix
//                             a -> (dP/dF : (a q^T)) p, an element matrix in few operations;
//                             exchange of p and q transposes it
//   stress_change(F, dF, c)   dP/dF : dF for a single dF
//   stress_at_rest(G, c)      dP/dF at rest : G [Pa], symmetric; a fibre that bears tension only
//                             counts as if it were under tension
// The constants c have the type Constants<T>, a struct of any number of members of type T and
// nothing else. A material declares
//   parameters                std::array of the MaterialParameters that a scene gives
//   kernel_constants(p)       Constants<double> of their values, in that order; once per region
//   small_strains(c)          Lame's constants of its tangent at rest, by which steps are bounded
//   splits_shape              where its energy is W of the shape, J^(-2/3) F^T F, and U of the
//                             volume: Prony series act on W
//   with_lambda(c, lambda)    where its volume has a stiffness of its own: the constants with
//                             another volume stiffness, such that Lame's constant at rest is lambda
//   Dilatation<T>(F), volumetric(x, c)
//                             where energies of two lambda differ by their difference times U(x) of
//                             a dilatation x of F, 1 at rest, which a rotation of the body does not
//                             change: x, dx/dF and its change, as VolumeDilatation has them; and U,
//                             whose second derivative at rest is 1. Nodal elements then smooth x
// and has these properties:
//   name, summary             what a scene calls it; one line for lists
//   rotation_invariant        a rotated state has the same energy
//   isotropic                 its tangent at rest is that of small_strains(), which else bounds it
//   survives_inversion        finite with finite derivatives for det F <= 0
//   recovers                  no stable state but rotations: inverted, flat and collapsed elements
//                             are pushed back
//   allows_inversion          an element with det F <= 0 goes on where a scene does not say, else
//                             it ends the run
namespace plica {

/// Base of the materials that are given by Young's modulus and Poisson's ratio.
struct TwoConstants {
  template <class T>
  using Constants = Lame<T>;
  static constexpr bool isotropic = true;
  static constexpr std::array parameters{parameter::young_modulus, parameter::poisson_ratio};
  static Lame<double> kernel_constants(const double* p) { return lame_constants(p[0], p[1]); }
  static Lame<double> small_strains(const Lame<double>& c) { return c; }
  static Lame<double> with_lambda(const Lame<double>& c, double lambda) { return {lambda, c.mu}; }
  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress_at_rest(const Mat3<T>& G,
                                                       const Lame<T>& c) {  // Hooke's law
    return c.mu * (G + transpose(G)) + Mat3<T>::diagonal(c.lambda * trace(G));
  }
};

/// Corner for block() where a tangent has no shorter way: dP for e_k g^T.
template <class T>
struct ColumnsOfCorner {
  Vec3<T> g;
  Mat3<T> dP[3];
  /// Returns the block of corner p and this corner.
  KOKKOS_INLINE_FUNCTION Mat3<T> block(const ColumnsOfCorner& p) const {
    return transpose(Mat3<T>{dP[0] * p.g, dP[1] * p.g, dP[2] * p.g});
  }
};

/// Property of a material: its energy has a part of a dilatation alone, which nodal elements can
/// smooth.
template <class Material>
inline constexpr bool smooths_dilatation = requires {
  typename Material::template Dilatation<double>;
};

/// Number of constants that a material's kernels get.
template <class Material>
inline constexpr int constant_count =
    static_cast<int>(sizeof(typename Material::template Constants<double>) / sizeof(double));

template <class Material, class T, class View, std::size_t... k>
KOKKOS_INLINE_FUNCTION auto load_each_constant(const View& all, int set,
                                               std::index_sequence<k...>) {
  return typename Material::template Constants<T>{
      T(all(set * constant_count<Material> + static_cast<int>(k)))...};
}

/// Returns the numbers of Constants<double> one after the other, as load_constants() reads them.
template <class Constants>
std::vector<double> as_list(const Constants& constants) {
  static_assert(std::is_trivially_copyable_v<Constants> && sizeof(Constants) % sizeof(double) == 0);
  std::vector<double> list(sizeof(Constants) / sizeof(double));
  std::memcpy(list.data(), &constants, sizeof(Constants));
  return list;
}

/// Loads set number `set` from a list of all sets' numbers, equal in all lanes.
template <class Material, class T, class View>
KOKKOS_INLINE_FUNCTION typename Material::template Constants<T> load_constants(const View& all,
                                                                               int set) {
  return load_each_constant<Material, T>(all, set,
                                         std::make_index_sequence<constant_count<Material>>());
}

/// Loads set number `set`, with the directions of fibres of each element where elements have their
/// own. The directions are at `slot` and behind it, one in each lane.
template <class Material, class T, class View>
KOKKOS_INLINE_FUNCTION typename Material::template Constants<T> load_constants(
    const View& all, int set, [[maybe_unused]] const View& fibres, [[maybe_unused]] int slot) {
  auto c = load_constants<Material, T>(all, set);
  if constexpr (requires { c.axis; }) {
    if (fibres.extent(0) == 0) return c;
    for (int k = 0; k < 6; ++k)
      for (int l = 0; l < LaneOf<T>::count; ++l)
        set_lane(c.axis[k / 3][k % 3], l, fibres((slot + l) * 6 + k));
  }
  return c;
}

/// Returns the true stress sigma = P F^T / J [Pa]. Bonet & Wood, Nonlinear Continuum Mechanics for
/// FEA, 2nd ed., eq. 5.45a.
template <class Material, class T>
KOKKOS_INLINE_FUNCTION Mat3<T> cauchy_stress(const Mat3<T>& F,
                                             const typename Material::template Constants<T>& c) {
  return (T(1) / determinant(F)) * (Material::stress(F, c) * transpose(F));
}

/// Returns von Mises' equivalent stress sqrt(3/2 s : s), s the deviator [Pa]. It takes the
/// symmetric part, since a law for small strains gives a symmetric Cauchy stress to first order
/// only.
template <class T>
KOKKOS_INLINE_FUNCTION T von_mises(const Mat3<T>& sigma) {
  const T x = sigma[0][0] - sigma[1][1], y = sigma[1][1] - sigma[2][2],
          z = sigma[2][2] - sigma[0][0];
  const T xy = sigma[0][1] + sigma[1][0], yz = sigma[1][2] + sigma[2][1],
          zx = sigma[2][0] + sigma[0][2];
  return sqrt(T(0.5f) * (x * x + y * y + z * z) + T(0.75f) * (xy * xy + yz * yz + zx * zx));
}

}  // namespace plica
