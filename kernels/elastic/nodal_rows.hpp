// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inlining.hpp>
#include <plica/core/level_data.hpp>
#include <plica/kernels/halo.hpp>
#include <plica/kernels/sliced_rows.hpp>
#include <plica/kernels/vectors.hpp>

// How nodal elements are computed: by rows of vertices, without tetrahedra. Each domain a
// (core/nodal_rows.hpp) has one deformation gradient F_a = I + sum_b (u_b - u_a) (x) C_ab / V_a and
// one stress. A force is a sum over the neighbours' stresses. Both sums read the same constants
// C_ab: C_ab = S_ab - C_ba, with S_ab stored for pairs on the surface only:
//
//   1. lay out   near[slot]     = fields of the slot's vertex        u [vertices][3] -> 4 a slot
//   2. stresses  records[slot]  = stress Q_a, field v_a              gathers near of the neighbours
//   3. forces    partial[slot]  = sum_a (Q_a + Q_b) C_ba - Q_a S_ab - stabiliser w_ab (v_a - v_b)
//                                 with b = slot                      gathers records
//   4. gather_forces: vertices between regions add up their slots    as for linear elements
//
// One slice of rows is computed at a time, a row per lane. Each lane's neighbour is read whole and
// transposed in registers:
//
//   neighbours of entry e  17  4 23  9     near[17]: x y z 0  -.         x x x x
//   (one per row)                          near[ 4]: x y z 0   |  load   y y y y    one pack for
//                                          near[23]: x y z 0   |------>  z z z z    each component
//                                          near[ 9]: x y z 0  -'         0 0 0 0
//
// A work item writes to its own rows only, and every sum is in a stored order: the same bits for
// any number of threads. Bytes per domain, n neighbours (about 14), s = sizeof(Real), by step: 2. n
// (4 + 3 s) + 13 s + 12 s, 3. n (4 + 4 s) + 12 s + 3 s, 1. 7 s; gathers hit a cache.
namespace plica {

/// Loads C or S of one entry.
template <class B, class Array>
KOKKOS_INLINE_FUNCTION Vec3<RowPack<B>> load_gradient(const Array& gradient, int entry,
                                                      int offset) {
  const typename B::Real* const from = &gradient(entry, 0, offset);
  constexpr int height = NodalRows<B>::height;
  return {load_rows<B>(from), load_rows<B>(from + height), load_rows<B>(from + 2 * height)};
}

/// Runs work(item) for every item of RowsAt.
template <class B, class Work>
void for_rows(const typename B::Exec& exec, const char* label, const NodalRows<B>& rows,
              const Work& work) {
  update_vertices<B>(exec, label, rows.slots() / B::lanes, work);
}

/// Step 1: copies the fields of vertices to near[slot].
template <class B, int fields>
struct LayOut {
  using Real = typename B::Real;
  Indices<B> vertex;
  Vectors<B> field[fields];
  Scalars<B> near;
  KOKKOS_INLINE_FUNCTION void operator()(int slot) const {
    const int a = vertex(slot);
    Real* const to = &near(slot * 4 * fields);
    for (int f = 0; f < fields; ++f)
      for (int k = 0; k < 4; ++k) to[4 * f + k] = a >= 0 && k < 3 ? field[f](a, k) : Real(0);
  }
};

template <class B, int fields>
void lay_out(const typename B::Exec& exec, const NodalRows<B>& rows, const NodalWork<B>& work,
             const Vectors<B> (&field)[fields]) {
  LayOut<B, fields> copy{rows.vertex, {}, work.near};
  for (int f = 0; f < fields; ++f) copy.field[f] = field[f];
  update_vertices<B>(exec, "plica::nodal_layout", static_cast<int>(rows.vertex.extent(0)), copy);
}

/// Step 1 of a level, one of whose vertices other ranks may own: their values are received first.
template <class B, int fields>
void lay_out(const typename B::Exec& exec, const LevelData<B>& level,
             const Vectors<B> (&field)[fields]) {
  for (const Vectors<B>& one : field) share_vertices<B>(exec, level, one);
  lay_out<B>(exec, level.model.rows, level.nodal, field);
}

/// Computes the gradients G of the fields in `near`, and loads the slots' own values.
template <class B, int fields>
KOKKOS_INLINE_FUNCTION void row_gradients(const NodalRows<B>& rows, const Scalars<B>& near,
                                          const RowsAt<B>& at, Vec3<RowPack<B>>* own,
                                          Mat3<RowPack<B>>* G) {
  using Real = typename B::Real;
  constexpr int stride = 4 * fields;
  const Real* const base = near.data();
  for (int f = 0; f < fields; ++f)
    load_vectors([=](int l) { return base + (at.slot + l) * stride + 4 * f; }, own[f]);
  for (int e = rows.first(at.slice); e < rows.first(at.slice + 1); ++e) {
    const int* const neighbour = &rows.neighbour(e, at.offset);
    const Vec3<RowPack<B>> C = load_gradient<B>(rows.gradient, e, at.offset);
    for (int f = 0; f < fields; ++f) {
      Vec3<RowPack<B>> u;
      load_vectors([=](int l) { return base + neighbour[l] * stride + 4 * f; }, u);
      const Vec3<RowPack<B>> d = u - own[f];
      for (int r = 0; r < 3; ++r) G[f][r] += d[r] * C;
    }
  }
  const RowPack<B> inverse = load_rows<B>(&rows.inverse_volume(at.slot));
  for (int f = 0; f < fields; ++f) G[f] = inverse * G[f];
}

/// Computes and keeps the gradients of the field in `near`, for tangents about it.
template <class B>
struct KeepGradients {
  NodalRows<B> rows;
  NodalWork<B> work;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    Vec3<RowPack<B>> own[1];
    Mat3<RowPack<B>> G[1];
    row_gradients<B, 1>(rows, work.near, at, own, G);
    for (int k = 0; k < 9; ++k)
      for (int l = 0; l < B::lanes; ++l)
        work.gradient(packed<B>(at.slot, k, 9) + l) = lane(G[0][k / 3][k % 3], l);
  }
};

/// Keeps the gradients of displacements at which forces have been computed: values at vertices that
/// other ranks own were received then.
template <class B>
void keep_gradients(const typename B::Exec& exec, const LevelData<B>& level, const Vectors<B>& u) {
  const NodalRows<B>& rows = level.model.rows;
  lay_out<B>(exec, rows, level.nodal, {u});
  for_rows<B>(exec, "plica::nodal_gradients", rows, KeepGradients<B>{rows, level.nodal});
}

/// Returns one of the kept gradients.
template <class B>
KOKKOS_INLINE_FUNCTION Mat3<RowPack<B>> kept_gradient(const Scalars<B>& kept, const RowsAt<B>& at) {
  Mat3<RowPack<B>> G;
  for (int k = 0; k < 9; ++k) G[k / 3][k % 3] = load_rows<B>(&kept(packed<B>(at.slot, k, 9)));
  return G;
}

/// Returns (S x)_a = (x_a V_a / 4 + sum_b s_ab x_b) / V_a of a number per slot, x(slot) =
/// values[slot * stride]. V S is symmetric.
template <class B>
KOKKOS_INLINE_FUNCTION RowPack<B> smoothed(const NodalRows<B>& rows, const typename B::Real* values,
                                           int stride, const RowsAt<B>& at) {
  using T = RowPack<B>;
  const auto value = [&](int slot) { return values[slot * stride]; };
  T sum = T(0);
  for (int e = rows.first(at.slice); e < rows.first(at.slice + 1); ++e) {
    const int* const neighbour = &rows.neighbour(e, at.offset);
    T x;
    for (int l = 0; l < B::lanes; ++l) set_lane(x, l, value(neighbour[l]));
    sum += load_rows<B>(&rows.smoothing(e, at.offset)) * x;
  }
  T own;
  for (int l = 0; l < B::lanes; ++l) set_lane(own, l, value(at.slot + l));
  return load_rows<B>(&rows.inverse_volume(at.slot)) * sum + T(0.25f) * own;
}

/// Stores four numbers of each of three columns in records.
template <class B>
KOKKOS_INLINE_FUNCTION void store_record(const Scalars<B>& records, const RowsAt<B>& at,
                                         const Mat3<RowPack<B>>& Q, const Vec3<RowPack<B>>& v) {
  typename B::Real* const base = records.data() + at.slot * 12;
  for (int j = 0; j < 3; ++j) {
    const RowPack<B> four[4] = {Q[0][j], Q[1][j], Q[2][j], v[j]};
    store_fours(four, [=](int l) { return base + 12 * l + 4 * j; });
  }
}

/// Step 2: computes the records of an integrand, which has
///   static constexpr int fields;        what it reads, in `near`
///   static constexpr bool is_tangent;   where the first field's gradient may be kept
///   void operator()(const Mat3<T> (&G)[fields], const Vec3<T> (&v)[fields], const RowsAt<B>&,
///                   int region, Mat3<T>& Q, Vec3<T>& v)
/// with the gradients G of the fields. It writes the stress Q that acts on the neighbours and the
/// field v that the stabiliser takes.
template <class B, class Integrand>
struct RowStresses {
  static constexpr int fields = Integrand::fields;
  using T = RowPack<B>;
  NodalRows<B> rows;
  NodalWork<B> work;
  Integrand integrand;
  bool kept = false;  ///< gradients of a tangent are kept: `near` has all fields but the first

  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    Vec3<T> own[fields], v;
    Mat3<T> G[fields], Q;
    gradients(at, own, G);
    integrand(G, own, at, rows.region(at.slice), Q, v);
    store_record<B>(work.records, at, Q, v);
  }
  KOKKOS_INLINE_FUNCTION void gradients(const RowsAt<B>& at, Vec3<T>* own, Mat3<T>* G) const {
    if constexpr (requires { Integrand::is_tangent; })
      if (kept) {
        G[0] = kept_gradient<B>(work.gradient, at);
        if constexpr (fields > 1) row_gradients<B, fields - 1>(rows, work.near, at, own + 1, G + 1);
        return;
      }
    row_gradients<B, fields>(rows, work.near, at, own, G);
  }
};

/// Step 3: computes partial[slot] from records; `adds`: adds to what is in it.
template <class B, bool adds = false>
struct RowForces {
  using Real = typename B::Real;
  using T = RowPack<B>;
  NodalRows<B> rows;
  Scalars<B> records;
  Vectors<B> partial;

  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    const Real* const base = records.data();
    T own[3][4];
    for (int j = 0; j < 3; ++j)
      load_fours([=](int l) { return base + (at.slot + l) * 12 + 4 * j; }, own[j]);
    Vec3<T> f, drag, sum;
    for (int e = rows.first(at.slice); e < rows.first(at.slice + 1); ++e) {
      const int* const neighbour = &rows.neighbour(e, at.offset);
      const Vec3<T> C = load_gradient<B>(rows.gradient, e, at.offset);
      const T w = load_rows<B>(&rows.coupling(e, at.offset));
      for (int j = 0; j < 3; ++j) {
        T four[4];
        load_fours([=](int l) { return base + neighbour[l] * 12 + 4 * j; }, four);
        for (int i = 0; i < 3; ++i) f[i] += C[j] * four[i];
        drag[j] += w * (four[3] - own[j][3]);
      }
      sum += C;
    }
    for (int e = rows.first_surface(at.slice); e < rows.first_surface(at.slice + 1); ++e) {
      const int* const neighbour = &rows.surface_neighbour(e, at.offset);
      const Vec3<T> S = load_gradient<B>(rows.surface_gradient, e, at.offset);
      for (int j = 0; j < 3; ++j) {
        T four[4];
        load_fours([=](int l) { return base + neighbour[l] * 12 + 4 * j; }, four);
        for (int i = 0; i < 3; ++i) f[i] -= S[j] * four[i];
      }
    }
    const T stabiliser = T(rows.stabiliser(rows.region(at.slice)));
    for (int i = 0; i < 3; ++i) {
      f[i] += own[0][i] * sum[0] + own[1][i] * sum[1] + own[2][i] * sum[2] - stabiliser * drag[i];
      for (int l = 0; l < B::lanes; ++l) {
        if constexpr (adds)
          partial(at.slot + l, i) += lane(f[i], l);
        else
          partial(at.slot + l, i) = lane(f[i], l);
      }
    }
  }
};

template <class B, class Integrand>
void launch_rows(const typename B::Exec& exec, const char* label, const LevelData<B>& level,
                 const Integrand& integrand, bool kept = false) {
  const NodalRows<B>& rows = level.model.rows;
  for_rows<B>(exec, label, rows, RowStresses<B, Integrand>{rows, level.nodal, integrand, kept});
  share_slots<B>(exec, level, level.nodal.records, 12);
  for_rows<B>(exec, "plica::nodal_forces", rows,
              RowForces<B>{rows, level.nodal.records, level.partial});
}

// Functions that are equal for all materials are compiled once, in nodal_elements.cpp.
#define PLICA_NODAL_ROWS(EXTERN, ...)                                                         \
  EXTERN template void lay_out<__VA_ARGS__, 1>(                                               \
      const __VA_ARGS__::Exec&, const NodalRows<__VA_ARGS__>&, const NodalWork<__VA_ARGS__>&, \
      const Vectors<__VA_ARGS__>(&)[1]);                                                      \
  EXTERN template void lay_out<__VA_ARGS__, 2>(                                               \
      const __VA_ARGS__::Exec&, const NodalRows<__VA_ARGS__>&, const NodalWork<__VA_ARGS__>&, \
      const Vectors<__VA_ARGS__>(&)[2]);                                                      \
  EXTERN template void keep_gradients<__VA_ARGS__>(                                           \
      const __VA_ARGS__::Exec&, const LevelData<__VA_ARGS__>&, const Vectors<__VA_ARGS__>&);  \
  EXTERN template void for_rows<__VA_ARGS__>(const __VA_ARGS__::Exec&, const char*,           \
                                             const NodalRows<__VA_ARGS__>&,                   \
                                             const RowForces<__VA_ARGS__>&);
#define PLICA_EXTERN_NODAL_ROWS(Real, Exec) PLICA_NODAL_ROWS(extern, Backend<Real, Exec>)
PLICA_FOR_EACH_PRECISION(PLICA_EXTERN_NODAL_ROWS)
#undef PLICA_EXTERN_NODAL_ROWS

}  // namespace plica
