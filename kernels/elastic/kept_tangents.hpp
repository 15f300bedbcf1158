// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/elastic/nodal_diagonal.hpp>
#include <plica/kernels/materials/positive_tangent.hpp>

// Projected tangents of nodal elements, computed once for a state and read in every product. C_a =
// dP/dF at F_a with its negative eigenvalues dropped, less the stabiliser beta mu. There is no
// damping in them, and no smoothed pressures, which act beyond a domain.
namespace plica {

/// Count of numbers of a symmetric 9x9 matrix: rows of its lower triangle.
inline constexpr int symmetric_nine = 45;

/// Returns true where tangents are kept: in nodal elements without damping and smoothed pressures.
/// Elsewhere tangents are projected anew in every product.
template <class B>
bool keeps_tangents(const NodalRows<B>& rows) {
  return rows.slices > 0 && rows.damping.extent(0) == 0 && rows.bulk_excess.extent(0) == 0;
}

/// Computes the tangents of the state whose gradients are kept.
template <class B, class Material>
struct KeepTangents {
  using T = RowPack<B>;
  NodalRows<B> rows;
  NodalWork<B> work;
  RowScales<B> scales;
  KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    const int region = rows.region(at.slice);
    const Mat3<T> F = Mat3<T>::identity() + kept_gradient<B>(work.gradient, at);
    const auto c = load_constants<Material, T>(scales.constants, region, scales.fibres, at.slot);
    typename PositiveTangent<Material>::template Of<T> tangent(F, c);
    const T b = T(scales.stabiliser(region));
    for (int i = 0; i < 9; ++i) {
      tangent.C.a[i][i] = tangent.C.a[i][i] - b;
      for (int j = 0; j <= i; ++j)
        for (int l = 0; l < B::lanes; ++l)
          work.tangent(packed<B>(at.slot, i * (i + 1) / 2 + j, symmetric_nine) + l) =
              lane(tangent.C.a[i][j], l);
    }
  }
};

template <class B>
KOKKOS_INLINE_FUNCTION RowPack<B> kept_number(const Scalars<B>& tangent, int slot, int i, int j) {
  const int k = i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i;
  return load_rows<B>(&tangent(packed<B>(slot, k, symmetric_nine)));
}

/// Stress of -K p by the kept tangents.
template <class B>
struct KeptTangent {
  static constexpr int fields = 1;
  using T = RowPack<B>;
  Scalars<B> tangent;
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const Vec3<T> (&field)[1],
                                         const RowsAt<B>& at, int, Mat3<T>& Q, Vec3<T>& v) const {
    T q[9];
    for (int i = 0; i < 9; ++i) {
      q[i] = kept_number<B>(tangent, at.slot, i, i) * G[0][i / 3][i % 3];
      for (int j = 0; j < i; ++j) {
        const T c = kept_number<B>(tangent, at.slot, i, j);
        q[i] += c * G[0][j / 3][j % 3];
        q[j] += c * G[0][i / 3][i % 3];
      }
    }
    for (int i = 0; i < 9; ++i) Q[i / 3][i % 3] = q[i];
    v = field[0];
  }
};

/// Record of diagonal_record() for each domain, divided by V_a, by the kept tangents.
template <class B>
struct KeptDiagonal {
  static constexpr int fields = 1;
  static constexpr bool is_tangent = true;
  using T = RowPack<B>;
  Scalars<B> tangent, inverse_volume;
  int direction;
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&)[1], const Vec3<T> (&)[1],
                                         const RowsAt<B>& at, int, Mat3<T>& Q, Vec3<T>& v) const {
    const T weight = load_rows<B>(&inverse_volume(at.slot));
    Mat3<T> dP[3];  // by the column of F that moves
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 9; ++i)
        dP[j][i / 3][i % 3] = kept_number<B>(tangent, at.slot, i, 3 * direction + j);
    diagonal_record(dP, weight, direction, Q, v);
  }
};

/// Computes level.nodal.tangent for the state whose gradients are kept.
template <class B, class Material>
void keep_nodal_tangents(const typename B::Exec& exec, const LevelData<B>& level) {
  const NodalRows<B>& rows = level.model.rows;
  for_rows<B>(exec, "plica::nodal_keep_tangents", rows,
              KeepTangents<B, Material>{rows, level.nodal, RowScales<B>(rows)});
}

template <class B>
void kept_tangent(const typename B::Exec& exec, const LevelData<B>& level, const Vectors<B>& p) {
  lay_out<B>(exec, level, {p});
  launch_rows<B>(exec, "plica::nodal_kept_tangent", level, KeptTangent<B>{level.nodal.tangent});
}

template <class B>
void kept_diagonal(const typename B::Exec& exec, const LevelData<B>& level, int direction) {
  const NodalRows<B>& rows = level.model.rows;
  for_rows<B>(exec, "plica::nodal_diagonal", rows,
              RowStresses<B, KeptDiagonal<B>>{
                  rows, level.nodal, {level.nodal.tangent, rows.inverse_volume, direction}, true});
  share_slots<B>(exec, level, level.nodal.records, 12);
  for_rows<B>(
      exec, "plica::nodal_own_blocks", rows,
      RowDiagonal<B>{rows, RowScales<B>(rows), level.nodal.records, level.partial, direction});
}

}  // namespace plica
