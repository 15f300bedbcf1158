// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>
#include <plica/core/small.hpp>

namespace plica {

/// Stress and strain of elements, as kernels compute them. A row is a tetrahedron of the mesh, with
/// nodal elements a vertex.
template <class B>
struct StressFields {
  /// Numbers of a row in `tensors`: Cauchy's stress [Pa], then C = F^T F, each as in SymMat3
  static constexpr int numbers = 12;

  Scalars<B> von_mises;        ///< [rows] equivalent stress [Pa]
  Scalars<B> J;                ///< [rows] volume ratio
  Scalars<B> tensors = {};     ///< [rows * numbers]; empty: left out
  Scalars<B> of_domains = {};  ///< [slots * numbers] work space of nodal elements for `tensors`
  /// true: each domain has its own volume ratio, also where pressures are smoothed. Else it is the
  /// smoothed one there, and F is scaled to have it
  bool own_volumes = false;
};

/// Stores the tensors of the row in each lane. Of the stress it takes the symmetric part, since a
/// law for small strains gives a symmetric one to first order only.
template <class B, class T>
KOKKOS_INLINE_FUNCTION void store_tensors(const Scalars<B>& to, int row, const Mat3<T>& sigma,
                                          const Mat3<T>& F) {
  constexpr int numbers = StressFields<B>::numbers;
  const SymMat3<T> six[2] = {six_of(T(0.5f) * (sigma + transpose(sigma))),
                             six_of(transpose(F) * F)};
  for (int k = 0; k < numbers; ++k)
    for (int l = 0; l < LaneOf<T>::count; ++l)
      to((row + l) * numbers + k) = lane(six[k / 6][k % 6], l);
}

}  // namespace plica
