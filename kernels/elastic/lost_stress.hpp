// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/elastic/nodal_rows.hpp>
#include <plica/kernels/elastic/stress_memory.hpp>
#include <plica/kernels/patch_kernel.hpp>

// Relaxed stress, which relaxation takes off the forces and energies of any material: see
// stress_memory.hpp.
namespace plica {

/// Computes the relaxed stress `lost` of every slot from the memory: stress S_n, terms H_i.
template <class B>
struct CombineMemory {
  using Real = typename B::Real;
  StressMemory<B> stress;
  /// [regions][1 + terms] factors of S_n and of each -H_i
  Scalars<B> weight;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {  // number i of `lost`
    constexpr int six = 6 * B::lanes;
    const int count = 1 + stress.terms;
    const Real* const at = &stress.memory(i / six * six * count + i % six);
    const Real* const w = &weight(stress.region(i / six) * count);
    Real sum = w[0] * at[0];
    for (int k = 1; k < count; ++k) sum -= w[k] * at[k * six];
    stress.lost(i) = sum;
  }
};

/// Forces of the relaxed stress in linear elements, f_a += V F lost grad N_a.
template <class B>
struct LostForce {
  static constexpr int fields = 1;
  static constexpr bool adds = true;
  Vectors<B> field[1];
  Scalars<B> lost;
  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const ElementShape<T>& shape,
                                         Vec3<T> (&corner)[4], int, int pack) const {
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    stress_to_corners(T(-1) * (F * matrix_of(load_symmetric<B, T>(lost, pack * B::lanes))), shape,
                      corner);
  }
};

/// Returns lost:(F^T F - 1) / 2, by which relaxation lowers the energy of a step.
template <class T>
KOKKOS_INLINE_FUNCTION T lost_energy(const Mat3<T>& F, const SymMat3<T>& lost) {
  const Mat3<T> L = matrix_of(lost);
  return T(0.5f) * (inner(F * L, F) - trace(L));
}

template <class B>
struct LostEnergy {
  static constexpr int fields = 1;
  static constexpr bool adds = true;
  Vectors<B> field[1];
  Scalars<B> lost;
  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const ElementShape<T>& shape,
                                         Vec3<T> (&corner)[4], int, int pack) const {
    const SymMat3<T> L = load_symmetric<B, T>(lost, pack * B::lanes);
    const T quarter = T(-0.25f) * shape.volume * lost_energy(Mat3<T>::identity() + G[0], L);
    for (Vec3<T>& at : corner) at = {quarter, T(0), T(0)};
  }
};

/// Stress -F lost of the relaxed stress in nodal elements.
template <class B>
struct LostRows {
  static constexpr int fields = 1;
  using T = RowPack<B>;
  Scalars<B> lost;
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const Vec3<T> (&)[1],
                                         const RowsAt<B>& at, int, Mat3<T>& Q, Vec3<T>& v) const {
    Q = T(-1) * ((Mat3<T>::identity() + G[0]) * matrix_of(load_symmetric<B, T>(lost, at.slot)));
    v = {T(0), T(0), T(0)};
  }
};

template <class B>
struct LostRowEnergy {
  using T = RowPack<B>;
  NodalRows<B> rows;
  NodalWork<B> work;
  Scalars<B> lost;
  Vectors<B> partial;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    Vec3<T> own[1];
    Mat3<T> G[1];
    row_gradients<B, 1>(rows, work.near, at, own, G);
    const SymMat3<T> L = load_symmetric<B, T>(lost, at.slot);
    const T energy =
        load_rows<B>(&rows.volume(at.slot)) * lost_energy(Mat3<T>::identity() + G[0], L);
    for (int l = 0; l < B::lanes; ++l) partial(at.slot + l, 0) -= lane(energy, l);
  }
};

/// Adds the forces of the relaxed stress to level.partial.
template <class B>
void add_lost_force(const typename B::Exec& exec, const Level<B>& level, const Vectors<B>& u) {
  const NodalRows<B>& rows = level.model.rows;
  if (rows.slices == 0)
    return launch_patches<B>(exec, "plica::lost_force", level.model.patches,
                             LostForce<B>{{u}, level.stress.lost}, level.partial);
  lay_out<B>(exec, rows, level.nodal, {u});
  for_rows<B>(exec, "plica::lost_stresses", rows,
              RowStresses<B, LostRows<B>>{rows, level.nodal, {level.stress.lost}});
  for_rows<B>(exec, "plica::lost_forces", rows,
              RowForces<B, true>{rows, level.nodal.records, level.partial});
}

/// Takes the energy of the relaxed stress off level.partial, in the x components.
template <class B>
void add_lost_energy(const typename B::Exec& exec, const Level<B>& level, const Vectors<B>& u) {
  const NodalRows<B>& rows = level.model.rows;
  if (rows.slices == 0)
    return launch_patches<B>(exec, "plica::lost_energy", level.model.patches,
                             LostEnergy<B>{{u}, level.stress.lost}, level.partial);
  lay_out<B>(exec, rows, level.nodal, {u});
  for_rows<B>(exec, "plica::lost_energy", rows,
              LostRowEnergy<B>{rows, level.nodal, level.stress.lost, level.partial});
}

}  // namespace plica
