// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>
#include <plica/kernels/contact/penalty.hpp>

namespace plica {

/// The laws of all rows of records, of one body after the other.
template <class B>
struct PointLaws {
  using Law = PenaltyLaw<typename B::Real>;
  Kokkos::View<Law*, typename B::Memory> law;  ///< [rows * bodies]
  Indices<B> body;                             ///< of each point; empty: there is one
  int bodies = 1;
  KOKKOS_INLINE_FUNCTION const Law& operator()(int row, int p) const {
    return law(row * bodies + (bodies > 1 ? body(p) : 0));
  }
};

}  // namespace plica
