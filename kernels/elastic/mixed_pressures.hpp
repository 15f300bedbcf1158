// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/elastic/nodal_elements.hpp>

// Mixed pressures of implicit stages of nearly incompressible bodies. Newton's method on u alone
// takes its tangent with the pressures excess (J~ - 1) at the present u. A step that bends changes
// volumes in its second order, times a stiffness of thousands of mu, and the tangent there has
// large pressures of either sign. With the pressure q of each domain as an unknown of its own
// (Simo, Taylor & Pister 1985),
//
//   sum_a V_a [q_a (J~_a - 1) - q_a^2 / 2 excess]   instead of   sum_a V_a excess/2 (J~_a - 1)^2,
//
// Newton's equations, q eliminated, have the same right side and the same stiffness against a
// change of volume. Where the tangent has a pressure, they have the smooth q of the last iteration.
// Both methods end where q = excess (J~ - 1). Potentials are compared by the augmented Lagrangian
// sum_a V_a [q (J~ - 1) + g/2 (J~ - 1 - q / excess)^2] at one q, with a g of the order of mu.
// Newton's direction leads down in it, while the energy rises with the square of the step.
namespace plica {

/// Computes J + cof F : dF of each slot at u - du, where u includes du already.
template <class B>
struct ForeseenVolumes {
  using T = RowPack<B>;
  NodalRows<B> rows;
  NodalWork<B> work;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    Vec3<T> own[2];
    Mat3<T> G[2];
    row_gradients<B, 2>(rows, work.near, at, own, G);
    const Mat3<T> F = Mat3<T>::identity() + G[0] - G[1];
    const T foreseen = determinant(F) + inner(cofactor(F), G[1]);
    for (int l = 0; l < B::lanes; ++l) work.ratio(at.slot + l) = lane(foreseen, l);
  }
};

/// Computes the mixed pressures after a change du: excess (S (J + cof F : du) - 1) at u - du, where
/// u includes du already.
template <class B>
void carry_pressures(const typename B::Exec& exec, const LevelData<B>& level, const Vectors<B>& u,
                     const Vectors<B>& du) {
  const NodalRows<B>& rows = level.model.rows;
  const NodalWork<B>& work = level.nodal;
  lay_out<B>(exec, rows, work, {u, du});
  for_rows<B>(exec, "plica::nodal_volumes", rows, ForeseenVolumes<B>{rows, work});
  for_rows<B>(exec, "plica::nodal_smooth", rows,
              SmoothRows<B, 1, true>{rows, work.ratio, carried_pressures<B>(rows, work)});
}

}  // namespace plica
