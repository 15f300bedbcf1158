// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/type_list.hpp>
#include <plica/kernels/materials/arruda_boyce.hpp>
#include <plica/kernels/materials/costa.hpp>
#include <plica/kernels/materials/gent.hpp>
#include <plica/kernels/materials/holzapfel_gasser_ogden.hpp>
#include <plica/kernels/materials/mooney_rivlin.hpp>
#include <plica/kernels/materials/ogden.hpp>
#include <plica/kernels/materials/polynomial.hpp>
#include <plica/kernels/materials/transversely_isotropic.hpp>
#include <plica/kernels/materials/veronda_westmann.hpp>

namespace plica {

/// Laws that share the kernels of TissueLaws. To add one, include its file and name it here.
using IsochoricLaws = TypeList<MooneyRivlin, Polynomial, Ogden, VerondaWestmann, ArrudaBoyce, Gent,
                               TransverselyIsotropic, HolzapfelGasserOgden, Costa>;

/// Calls f(law{}) for the law at a place of the list.
template <class... Laws, class F>
KOKKOS_INLINE_FUNCTION void with_law(TypeList<Laws...>, int place, const F& f) {
  (void)((place-- == 0 ? (f(Laws{}), true) : false) || ...);
}

/// Law that stands for any of IsochoricLaws: a number among the constants, equal in all lanes, says
/// which one. So the kernels are compiled once for all laws, and the laws once for all kernels.
struct TissueLaws : Isochoric<TissueLaws> {
  template <class T>
  PLICA_CALL PLICA_FLATTEN static KOKKOS_FUNCTION T isochoric(const Mat3<T>& C,
                                                              const IsochoricConstants<T>& c) {
    T W = T(0);
    with_law(IsochoricLaws{}, static_cast<int>(lane(c.law, 0)),
             [&](auto law) { W = decltype(law)::isochoric(C, c); });
    return W;
  }
  template <class T, class To>
  PLICA_CALL PLICA_FLATTEN static KOKKOS_FUNCTION void respond(const Mat3<T>& C,
                                                               const IsochoricConstants<T>& c,
                                                               To& to) {
    with_law(IsochoricLaws{}, static_cast<int>(lane(c.law, 0)),
             [&](auto law) { decltype(law)::respond(C, c, to); });
  }
  template <class T>
  PLICA_CALL PLICA_FLATTEN static KOKKOS_FUNCTION Mat3<T> shape_at_rest(
      const Mat3<T>& e, const IsochoricConstants<T>& c) {
    Mat3<T> S;
    with_law(IsochoricLaws{}, static_cast<int>(lane(c.law, 0)),
             [&](auto law) { S = decltype(law)::shape_at_rest(e, c); });
    return S;
  }
};

}  // namespace plica
