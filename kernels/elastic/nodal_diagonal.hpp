// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/elastic/nodal_elements.hpp>

// Diagonal blocks of the stiffness of nodal elements, one for each vertex. A displacement of vertex
// b along d moves every domain a around it by G_a = d (x) C_ab / V_a. With the tangents T_a = dP/dF
// at F_a,
//
//   d.K_bb d = sum_a V_a G_a:(T_a - beta mu):G_a + beta mu w_bb |d|^2,
//
// where a are the neighbours of b, and b itself. With damping, the tangent of damping_stress.hpp is
// added to T_a. The effect of smoothed pressures, which act beyond neighbours, is left out.
namespace plica {

/// Writes a domain's stiffness as a record (Q, v) of coefficients. A neighbour's c = C_ab makes a
/// symmetric 3x3 matrix of that stiffness; the record is for its rows `direction` and the next
/// (cyclic). The coefficients are those of c_x c_x, c_y c_y, c_z c_z, c_x c_y, c_x c_z, c_y c_z,
/// times `weight`. dP: by the column of F that moves.
template <class T>
KOKKOS_INLINE_FUNCTION void diagonal_record(const Mat3<T> (&dP)[3], const T& weight, int direction,
                                            Mat3<T>& Q, Vec3<T>& v) {
  T number[12];
  for (int row = 0; row < 2; ++row) {
    const int i = (direction + row) % 3;
    T* const to = number + 6 * row;
    for (int j = 0; j < 3; ++j) to[j] = weight * dP[j][i][j];
    to[3] = weight * (dP[0][i][1] + dP[1][i][0]);
    to[4] = weight * (dP[0][i][2] + dP[2][i][0]);
    to[5] = weight * (dP[1][i][2] + dP[2][i][1]);
  }
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) Q[i][j] = number[4 * j + i];
    v[j] = number[4 * j + 3];
  }
}

/// Record of diagonal_record() for each domain, divided by V_a.
template <class B, class Material, template <class> class Tangent, bool Damped>
struct NodalDiagonal {
  static constexpr int fields = 1;
  static constexpr bool is_tangent = true;
  using T = RowPack<B>;
  RowScales<B> scales;
  Scalars<B> inverse_volume;
  typename B::Real damping_scale;  ///< factor of the damping times [1/s]
  int direction;

  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const Vec3<T> (&)[1],
                                         const RowsAt<B>& at, int region, Mat3<T>& Q,
                                         Vec3<T>& v) const {
    const T weight = load_rows<B>(&inverse_volume(at.slot));
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    const auto c = load_constants<Material, T>(scales.constants, region, scales.fibres, at.slot);
    const Tangent<T> tangent(F, c);
    Mat3<T> dP[3];  // by the column of F that moves
    for (int j = 0; j < 3; ++j) {
      Mat3<T> dF;
      dF[direction][j] = T(1);
      dP[j] = tangent(dF) - T(scales.stabiliser(region)) * dF;
      if constexpr (Damped)
        dP[j] = dP[j] +
                T(damping_scale * scales.damping(region)) * DampingTangent<Material, T>{F, c}(dF);
    }
    diagonal_record(dP, weight, direction, Q, v);
  }
};

/// Computes column `direction` of the diagonal blocks: the number on the diagonal and the next one
/// (cyclic). The third is left 0.
template <class B>
struct RowDiagonal {
  using T = RowPack<B>;
  NodalRows<B> rows;
  RowScales<B> scales;
  Scalars<B> records;
  Vectors<B> partial;
  int direction;

  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    T diagonal = T(0), next = T(0), coupling = T(0);
    const auto add = [&](const Vec3<T>& c, const auto& slot) {
      T number[12];
      for (int j = 0; j < 3; ++j) {
        T four[4];
        load_fours([&](int l) { return records.data() + slot(l) * 12 + 4 * j; }, four);
        for (int i = 0; i < 4; ++i) number[4 * j + i] = four[i];
      }
      const T square[6] = {c[0] * c[0], c[1] * c[1], c[2] * c[2],
                           c[0] * c[1], c[0] * c[2], c[1] * c[2]};
      for (int k = 0; k < 6; ++k)
        diagonal += number[k] * square[k], next += number[6 + k] * square[k];
    };
    Vec3<T> sum;
    for (int e = rows.first(at.slice); e < rows.first(at.slice + 1); ++e) {
      const int* const neighbour = &rows.neighbour(e, at.offset);
      const Vec3<T> C = load_gradient<B>(rows.gradient, e, at.offset);
      sum += C;
      coupling += load_rows<B>(&rows.coupling(e, at.offset));
      add(surface_part(at, neighbour) - C, [=](int l) { return neighbour[l]; });
    }
    add(sum, [=](int l) { return at.slot + l; });
    const int region = rows.region(at.slice);
    diagonal -= T(scales.stabiliser(region)) * coupling;
    for (int l = 0; l < B::lanes; ++l) {
      partial(at.slot + l, direction) = lane(diagonal, l);
      partial(at.slot + l, (direction + 1) % 3) = lane(next, l);
      partial(at.slot + l, (direction + 2) % 3) = 0;
    }
  }

  /// Returns S_ab of one entry, 0 inside the body.
  KOKKOS_INLINE_FUNCTION Vec3<T> surface_part(const RowsAt<B>& at, const int* neighbour) const {
    Vec3<T> S;
    for (int e = rows.first_surface(at.slice); e < rows.first_surface(at.slice + 1); ++e) {
      const int* const other = &rows.surface_neighbour(e, at.offset);
      for (int l = 0; l < B::lanes; ++l)
        if (other[l] == neighbour[l])
          for (int k = 0; k < 3; ++k)
            set_lane(S[k], l, lane(S[k], l) + rows.surface_gradient(e, k, at.offset + l));
    }
    return S;
  }
};

/// Computes column `direction` of the diagonal blocks of K(u). An empty u: about the state whose
/// gradients are kept.
template <class B, class Material, template <class> class Tangent>
void nodal_diagonal(const typename B::Exec& exec, const LevelData<B>& level, const Vectors<B>& u,
                    double damping_scale, int direction) {
  const NodalRows<B>& rows = level.model.rows;
  const RowScales<B> scales(rows);
  const auto rate = static_cast<typename B::Real>(damping_scale);
  const bool kept = u.extent(0) == 0;
  if (!kept) lay_out<B>(exec, level, {u});
  by_case(damping_scale > 0 && rows.damping.extent(0) > 0, [&]<bool damped>(
                                                               std::bool_constant<damped>) {
    for_rows<B>(exec, "plica::nodal_diagonal", rows,
                RowStresses<B, NodalDiagonal<B, Material, Tangent, damped>>{
                    rows, level.nodal, {scales, rows.inverse_volume, rate, direction}, kept});
  });
  share_slots<B>(exec, level, level.nodal.records, 12);
  for_rows<B>(exec, "plica::nodal_own_blocks", rows,
              RowDiagonal<B>{rows, scales, level.nodal.records, level.partial, direction});
}

// Functions that are equal for all materials are compiled once, in nodal_elements.cpp.
#define PLICA_NODAL_DIAGONAL(EXTERN, ...)                                           \
  EXTERN template void for_rows<__VA_ARGS__>(const __VA_ARGS__::Exec&, const char*, \
                                             const NodalRows<__VA_ARGS__>&,         \
                                             const RowDiagonal<__VA_ARGS__>&);
#define PLICA_EXTERN_NODAL_DIAGONAL(Real, Exec) PLICA_NODAL_DIAGONAL(extern, Backend<Real, Exec>)
PLICA_FOR_EACH_PRECISION(PLICA_EXTERN_NODAL_DIAGONAL)
#undef PLICA_EXTERN_NODAL_DIAGONAL

}  // namespace plica
