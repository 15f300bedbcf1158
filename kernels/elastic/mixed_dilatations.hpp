// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/elastic/nodal_elements.hpp>

// Mixed dilatations of implicit stages of nearly incompressible bodies. Newton's method on u alone
// takes its tangent with the pressures excess U'(x~) at the present u, x~ the smoothed dilatation.
// A step that bends changes volumes in its second order, times a stiffness of thousands of mu, and
// the tangent there has large pressures of either sign. With the dilatation m of each domain and
// its pressure q as unknowns of their own (Simo, Taylor & Pister 1985),
//
//   sum_a V_a [excess U(m_a) + q_a (x~_a - m_a)]   instead of   sum_a V_a excess U(x~_a),
//
// Newton's equations, m and q eliminated, have the same right side and the same stiffness against a
// change of volume. Where the tangent has a pressure, they have q = excess U'(m) with the smooth m
// that the last solve foresaw, m = S (x + dx/dF : dF). The stiffness is excess U'' half way from m
// to x~: then excess U'(x~) plus its change is U' at the next m, up to the square of what m changes
// by. Both methods end where m = x~. Potentials are compared by the augmented Lagrangian sum_a V_a
// [q (x~ - 1) + g/2 (x~ - m)^2] at one m, with a g of the order of mu. Newton's direction leads
// down in it, while the energy rises with the square of the step.
namespace plica {

/// Computes x + dx/dF : dF of each slot at u - du, where u includes du already.
template <class B, class Material>
struct ForeseenDilatations {
  using T = RowPack<B>;
  NodalRows<B> rows;
  NodalWork<B> work;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    Vec3<T> own[2];
    Mat3<T> G[2];
    row_gradients<B, 2>(rows, work.near, at, own, G);
    const typename Material::template Dilatation<T> x(Mat3<T>::identity() + G[0] - G[1]);
    const T foreseen = x.value + inner(x.slope, G[1]);
    for (int l = 0; l < B::lanes; ++l) work.ratio(at.slot + l) = lane(foreseen, l);
  }
};

/// Computes the mixed dilatations after a change du, where u includes du already.
template <class B, class Material>
void carry_dilatations(const typename B::Exec& exec, const LevelData<B>& level, const Vectors<B>& u,
                       const Vectors<B>& du) {
  const NodalRows<B>& rows = level.model.rows;
  const NodalWork<B>& work = level.nodal;
  lay_out<B>(exec, level, {u, du});
  for_rows<B>(exec, "plica::nodal_volumes", rows, ForeseenDilatations<B, Material>{rows, work});
  share_slots<B>(exec, level, work.ratio, 1);
  for_rows<B>(exec, "plica::nodal_smooth", rows,
              SmoothRows<B, 1>{rows, work.ratio, carried_dilatations<B>(rows, work)});
}

}  // namespace plica
