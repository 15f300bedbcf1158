// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/elastic/nodal_rows.hpp>
#include <plica/kernels/elastic/viscous_history.hpp>
#include <plica/kernels/patch_kernel.hpp>

// Relaxed stress, which relaxation takes off the forces and energies of any material: see
// viscous_history.hpp.
namespace plica {

/// Computes the relaxed stress `relaxed` of every slot from the memory: stress S_n, terms H_i.
template <class B>
struct CombineHistory {
  using Real = typename B::Real;
  ViscousHistory<B> stress;
  /// [regions][1 + terms] factors of S_n and of each -H_i
  Scalars<B> weight;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {  // number i of `relaxed`
    constexpr int six = 6 * B::lanes;
    const int count = 1 + stress.terms;
    const Real* const at = &stress.memory(i / six * six * count + i % six);
    const Real* const w = &weight(stress.region(i / six) * count);
    Real sum = w[0] * at[0];
    for (int k = 1; k < count; ++k) sum -= w[k] * at[k * six];
    stress.relaxed(i) = sum;
  }
};

/// Forces of the relaxed stress in linear elements, f_a += V F lost grad N_a.
template <class B>
struct RelaxedForce {
  static constexpr int fields = 1;
  static constexpr bool adds = true;
  Vectors<B> field[1];
  Scalars<B> relaxed;
  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const ElementShape<T>& shape,
                                         Vec3<T> (&corner)[4], int, int pack) const {
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    stress_to_corners(T(-1) * (F * matrix_of(load_symmetric<B, T>(relaxed, pack * B::lanes))),
                      shape, corner);
  }
};

/// Returns lost:(F^T F - 1) / 2, by which relaxation lowers the energy of a step.
template <class T>
KOKKOS_INLINE_FUNCTION T lost_energy(const Mat3<T>& F, const SymMat3<T>& relaxed) {
  const Mat3<T> L = matrix_of(relaxed);
  return T(0.5f) * (inner(F * L, F) - trace(L));
}

template <class B>
struct RelaxedEnergy {
  static constexpr int fields = 1;
  static constexpr bool adds = true;
  Vectors<B> field[1];
  Scalars<B> relaxed;
  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const ElementShape<T>& shape,
                                         Vec3<T> (&corner)[4], int, int pack) const {
    const SymMat3<T> L = load_symmetric<B, T>(relaxed, pack * B::lanes);
    const T quarter = T(-0.25f) * shape.volume * lost_energy(Mat3<T>::identity() + G[0], L);
    for (Vec3<T>& at : corner) at = {quarter, T(0), T(0)};
  }
};

/// Stress -F lost of the relaxed stress in nodal elements.
template <class B>
struct RelaxedRows {
  static constexpr int fields = 1;
  using T = RowPack<B>;
  Scalars<B> relaxed;
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const Vec3<T> (&)[1],
                                         const RowsAt<B>& at, int, Mat3<T>& Q, Vec3<T>& v) const {
    Q = T(-1) * ((Mat3<T>::identity() + G[0]) * matrix_of(load_symmetric<B, T>(relaxed, at.slot)));
    v = {T(0), T(0), T(0)};
  }
};

template <class B>
struct RelaxedRowEnergy {
  using T = RowPack<B>;
  NodalRows<B> rows;
  NodalWork<B> work;
  Scalars<B> relaxed;
  Vectors<B> partial;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    Vec3<T> own[1];
    Mat3<T> G[1];
    row_gradients<B, 1>(rows, work.near, at, own, G);
    const SymMat3<T> L = load_symmetric<B, T>(relaxed, at.slot);
    const T energy =
        load_rows<B>(&rows.volume(at.slot)) * lost_energy(Mat3<T>::identity() + G[0], L);
    for (int l = 0; l < B::lanes; ++l) partial(at.slot + l, 0) -= lane(energy, l);
  }
};

/// Adds the forces of the relaxed stress to level.partial.
template <class B>
void add_relaxed_force(const typename B::Exec& exec, const LevelData<B>& level,
                       const Vectors<B>& u) {
  const NodalRows<B>& rows = level.model.rows;
  if (rows.slices == 0)
    return launch_patches<B>(exec, "plica::lost_force", level.model.patches,
                             RelaxedForce<B>{{u}, level.stress.relaxed}, level.partial);
  lay_out<B>(exec, level, {u});
  for_rows<B>(exec, "plica::lost_stresses", rows,
              RowStresses<B, RelaxedRows<B>>{rows, level.nodal, {level.stress.relaxed}});
  share_slots<B>(exec, level, level.nodal.records, 12);
  for_rows<B>(exec, "plica::lost_forces", rows,
              RowForces<B, true>{rows, level.nodal.records, level.partial});
}

/// Takes the energy of the relaxed stress off level.partial, in the x components.
template <class B>
void add_relaxed_energy(const typename B::Exec& exec, const LevelData<B>& level,
                        const Vectors<B>& u) {
  const NodalRows<B>& rows = level.model.rows;
  if (rows.slices == 0)
    return launch_patches<B>(exec, "plica::lost_energy", level.model.patches,
                             RelaxedEnergy<B>{{u}, level.stress.relaxed}, level.partial);
  lay_out<B>(exec, level, {u});
  for_rows<B>(exec, "plica::lost_energy", rows,
              RelaxedRowEnergy<B>{rows, level.nodal, level.stress.relaxed, level.partial});
}

}  // namespace plica
