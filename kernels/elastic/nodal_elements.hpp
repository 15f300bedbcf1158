// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/elastic/damping_stress.hpp>
#include <plica/kernels/elastic/nodal_rows.hpp>
#include <plica/kernels/elastic/stress_fields.hpp>
#include <plica/kernels/elastic/viscous_history.hpp>
#include <plica/kernels/vectors.hpp>

// Elements with one strain per vertex and region ("nodal"), stabilised:
//
//   F_a = (1/V_a) sum_t V_t/4 F_t
//   E   = sum_a V_a Psi(F_a) + beta mu/2 [sum_t V_t |F_t|^2 - sum_a V_a |F_a|^2]
//
// In the family of node-based uniform strain and stabilised nodally integrated tetrahedra:
// Dohrmann, Heinstein, Jung, Key & Witkowski 2000; Bonet, Marriott & Hassan 2001; Puso & Solberg
// 2006; Gee, Dohrmann, Key & Wall 2009. The bracket is sum_t sum_{a in t} V_t/4 |F_t - F_a|^2: zero
// for affine motion, unchanged by rotations, of a constant matrix. beta was tuned, not derived:
// below 0.2 modes appear that are no motion of a body, high ones stiffen bending. mu is that of
// small strains. With G = F - I,
//
//   Q_a = P(F_a) - beta mu G_a,   f_b = -sum_a Q_a C_ab - beta mu sum_a w_ab u_a.
//
// Smoothed volumes, for lambda beyond 2 mu: Psi has lambda_c = min(lambda, 2 mu), and the rest
// (`bulk_excess`) acts on x~ = S x, a mean over neighbours of the law's dilatation x(F), which is J
// in most laws: + sum_a V_a bulk_excess U(x~_a) with the U of the law. Its stress is p~_a dx/dF
// with p~ = S [excess U'(x~)], V S symmetric. Where F is the same everywhere, x~ = x, and the
// energy is that of Psi with the whole lambda.
//
// Damping by stiffness (damping_stress.hpp) acts on the strain rates of the domains, and on that of
// x~ by tau S [excess U''(x~) S (dx/dF : Fdot)] dx/dF. It does not act on the bracket: where strain
// varies, the rate of F_t - F_a is not 0 for a body that only turns.
namespace plica {

/// Constants, fibres, stabiliser and damping of the regions; see NodalRows.
template <class B>
struct RowScales {
  Scalars<B> constants, fibres, stabiliser, damping;
  explicit RowScales(const NodalRows<B>& rows)
      : constants(rows.constants),
        fibres(rows.fibres),
        stabiliser(rows.stabiliser),
        damping(rows.damping) {}
};

/// Pressures from smoothed dilatations, and their changes, in the order of the slots; `stride`
/// numbers for each slot.
template <class B>
struct RowPressure {
  Scalars<B> pressure;
  int stride = 1;
  KOKKOS_INLINE_FUNCTION RowPack<B> at(int slot, int k) const {
    RowPack<B> p;
    for (int l = 0; l < B::lanes; ++l) set_lane(p, l, pressure((slot + l) * stride + k));
    return p;
  }
};

/// Calls launch(std::true_type) where pressures are smoothed, else launch(std::false_type).
template <class Material, class B, class Launch>
void by_smoothing(const NodalRows<B>& rows, const Launch& launch) {
  if constexpr (smooths_dilatation<Material>)
    by_case(rows.bulk_excess.extent(0) > 0, launch);
  else
    launch(std::false_type());
}

/// Stress of the force f = -dE/du. Damped: with the stress of -D(u) v.
template <class B, class Material, bool Watched, bool Damped, bool Smoothed>
struct NodalForce {
  static constexpr int fields = Damped ? 2 : 1;
  using T = RowPack<B>;
  RowScales<B> scales;
  ElementFlags<B> flags;  ///< raised by det F <= 0, where Watched; a record per slice
  Changing<B, int> evaluation;
  RowPressure<B> pressure;

  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[fields], const Vec3<T> (&field)[fields],
                                         const RowsAt<B>& at, int region, Mat3<T>& Q,
                                         Vec3<T>& v) const {
    const auto c = load_constants<Material, T>(scales.constants, region, scales.fibres, at.slot);
    const T b = T(scales.stabiliser(region));
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    Q = Material::stress(F, c) - b * G[0];
    v = field[0];
    if constexpr (Smoothed) {
      T p = pressure.at(at.slot, 0);
      if constexpr (Damped) p += T(scales.damping(region)) * pressure.at(at.slot, 1);
      Q = Q + p * typename Material::template Dilatation<T>(F).slope;
    }
    if constexpr (Damped)
      Q = Q + T(scales.damping(region)) * DampingTangent<Material, T>{F, c}(G[1]);
    if constexpr (Watched) {
      const T J = determinant(F);
      if (!all_positive(J)) raise(J, at);
    }
  }

  PLICA_SELDOM KOKKOS_FUNCTION void raise(const T& J, const RowsAt<B>& at) const {
    for (int l = 0; l < B::lanes; ++l)
      if (!(lane(J, l) > 0)) flags.raise(at.slice, *evaluation, at.slot + l, lane(J, l));
  }
};

/// Stress of -K(u) p. Damped: with `damping_scale` times the stress of -D(u) p.
template <class B, class Material, template <class> class Tangent, bool Damped, bool Smoothed>
struct NodalTangent {
  static constexpr int fields = 2;  // u, p
  static constexpr bool is_tangent = true;
  using T = RowPack<B>;
  RowScales<B> scales;
  typename B::Real damping_scale;  ///< factor of the damping times [1/s]
  RowPressure<B> pressure;

  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[2], const Vec3<T> (&field)[2],
                                         const RowsAt<B>& at, int region, Mat3<T>& Q,
                                         Vec3<T>& v) const {
    const T b = T(scales.stabiliser(region));
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    const auto c = load_constants<Material, T>(scales.constants, region, scales.fibres, at.slot);
    Q = Tangent<T>(F, c)(G[1]) - b * G[1];
    v = field[1];
    if constexpr (Smoothed) {
      const typename Material::template Dilatation<T> x(F);
      T change = pressure.at(at.slot, 1);
      if constexpr (Damped) change += T(damping_scale * scales.damping(region)) * change;
      Q = Q + change * x.slope + pressure.at(at.slot, 0) * x.slope_change(G[1]);
    }
    if constexpr (Damped)
      Q = Q + T(damping_scale * scales.damping(region)) * DampingTangent<Material, T>{F, c}(G[1]);
  }
};

/// Computes the dilatation of each slot, and with two fields its change.
template <class B, class Material, int fields>
struct RowDilatations {
  using T = RowPack<B>;
  NodalRows<B> rows;
  NodalWork<B> work;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    Vec3<T> own[fields];
    Mat3<T> G[fields];
    row_gradients<B, fields>(rows, work.near, at, own, G);
    const typename Material::template Dilatation<T> x(Mat3<T>::identity() + G[0]);
    T change = T(0);
    if constexpr (fields > 1) change = inner(x.slope, G[1]);
    for (int l = 0; l < B::lanes; ++l) {
      work.ratio((at.slot + l) * fields) = lane(x.value, l);
      if constexpr (fields > 1) work.ratio((at.slot + l) * fields + 1) = lane(change, l);
    }
  }
};

/// Returns the mixed dilatations, which an implicit stage has as unknowns beside the displacement:
/// one per slot, behind the other numbers of work.pressure; empty: there are none. The stage's
/// tangent and potential take the pressures of these instead of those of the state; see
/// mixed_dilatations.hpp.
template <class B>
Scalars<B> carried_dilatations(const NodalRows<B>& rows, const NodalWork<B>& work) {
  const auto slots = static_cast<std::size_t>(rows.slots());
  return work.pressure.extent(0) > 2 * slots ? Scalars<B>(work.pressure.data() + 2 * slots, slots)
                                             : Scalars<B>();
}

/// Computes excess U'(x~) of work.ratio, and with two fields excess U''(x~) S dx. With mixed
/// dilatations m: excess U'(m), and U'' half way from m to x~, so that both tell the same pressure
/// after a change.
template <class B, class Material, int fields>
struct ExcessPressures {
  using T = RowPack<B>;
  NodalRows<B> rows;
  NodalWork<B> work;
  Scalars<B> carried;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    const int region = rows.region(at.slice);
    const auto c = load_constants<Material, T>(rows.constants, region);
    const T excess = T(rows.bulk_excess(region));
    const T x = smoothed<B>(rows, work.ratio.data(), fields, at);
    const T mixed = carried.extent(0) > 0 ? load_rows<B>(&carried(at.slot)) : x;
    const T p = excess * Material::volumetric(mixed, c).first;
    T change = T(0);
    if constexpr (fields > 1)
      change = excess * Material::volumetric(T(0.5f) * (mixed + x), c).second *
               smoothed<B>(rows, work.ratio.data() + 1, fields, at);
    for (int l = 0; l < B::lanes; ++l) {
      work.records((at.slot + l) * fields) = lane(p, l);
      if constexpr (fields > 1) work.records((at.slot + l) * fields + 1) = lane(change, l);
    }
  }
};

/// Computes to = S from for `fields` numbers per slot.
template <class B, int fields>
struct SmoothRows {
  NodalRows<B> rows;
  Scalars<B> from, to;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    for (int k = 0; k < fields; ++k) {
      const RowPack<B> x = smoothed<B>(rows, from.data() + k, fields, at);
      for (int l = 0; l < B::lanes; ++l) to((at.slot + l) * fields + k) = lane(x, l);
    }
  }
};

/// Computes work.pressure of the fields that have been laid out.
template <class B, class Material, int fields>
void smooth_pressures(const typename B::Exec& exec, const LevelData<B>& level,
                      const Scalars<B>& carried = {}) {
  const NodalRows<B>& rows = level.model.rows;
  const NodalWork<B>& work = level.nodal;
  for_rows<B>(exec, "plica::nodal_volumes", rows, RowDilatations<B, Material, fields>{rows, work});
  share_slots<B>(exec, level, work.ratio, fields);
  for_rows<B>(exec, "plica::nodal_pressures", rows,
              ExcessPressures<B, Material, fields>{rows, work, carried});
  share_slots<B>(exec, level, work.records, fields);
  for_rows<B>(exec, "plica::nodal_smooth", rows,
              SmoothRows<B, fields>{rows, work.records, work.pressure});
}

/// Computes the internal force, with damping where the rows have it. Without flags, nothing watches
/// for inverted domains.
template <class B, class Material>
void nodal_force(const typename B::Exec& exec, const LevelData<B>& level, const State<B>& state,
                 int evaluation) {
  const NodalRows<B>& rows = level.model.rows;
  by_case(rows.damping.extent(0) > 0, [&]<bool damped>(std::bool_constant<damped>) {
    if constexpr (damped)
      lay_out<B>(exec, level, {state.u, state.v});
    else
      lay_out<B>(exec, level, {state.u});
    by_smoothing<Material>(rows, [&]<bool smoothed>(std::bool_constant<smoothed>) {
      constexpr int fields = damped ? 2 : 1;
      if constexpr (smoothed) smooth_pressures<B, Material, fields>(exec, level);
      by_case(level.flags.evaluation.extent(0) > 0, [&]<bool watched>(std::bool_constant<watched>) {
        launch_rows<B>(
            exec, "plica::nodal_stresses", level,
            NodalForce<B, Material, watched, damped, smoothed>{
                RowScales<B>(rows), level.flags, evaluation, {level.nodal.pressure, fields}});
      });
    });
  });
}

/// Computes -K(u) p. An empty u: K about the state whose gradients are kept.
template <class B, class Material, template <class> class Tangent>
void nodal_tangent(const typename B::Exec& exec, const LevelData<B>& level, const Vectors<B>& u,
                   const Vectors<B>& p, double damping_scale) {
  const NodalRows<B>& rows = level.model.rows;
  const bool kept = u.extent(0) == 0;
  if (kept)
    lay_out<B>(exec, level, {p});
  else
    lay_out<B>(exec, level, {u, p});
  by_smoothing<Material>(rows, [&]<bool smoothed>(std::bool_constant<smoothed>) {
    if constexpr (smoothed)
      smooth_pressures<B, Material, 2>(exec, level, carried_dilatations<B>(rows, level.nodal));
    by_case(damping_scale > 0 && rows.damping.extent(0) > 0,
            [&]<bool damped>(std::bool_constant<damped>) {
              launch_rows<B>(exec, "plica::nodal_tangent", level,
                             NodalTangent<B, Material, Tangent, damped, smoothed>{
                                 RowScales<B>(rows),
                                 static_cast<typename B::Real>(damping_scale),
                                 {level.nodal.pressure, 2}},
                             kept);
            });
  });
}

/// Energy of each domain [J], in the x component of partial: V Psi(F), its part of the bracket, and
/// that of the smoothed dilatation.
template <class B, class Material, bool Smoothed>
struct NodalEnergy {
  using T = RowPack<B>;
  NodalRows<B> rows;
  NodalWork<B> work;
  Vectors<B> partial;
  Scalars<B> carried;

  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    const int region = rows.region(at.slice);
    Vec3<T> own[1];
    Mat3<T> G[1];
    row_gradients<B, 1>(rows, work.near, at, own, G);
    T spread = T(0);  // -sum_b w_ab |u_b - u_a|^2 / 2: over all domains sum_t V_t |G_t|^2
    const typename B::Real* const base = work.near.data();
    for (int e = rows.first(at.slice); e < rows.first(at.slice + 1); ++e) {
      const int* const neighbour = &rows.neighbour(e, at.offset);
      Vec3<T> u;
      load_vectors([=](int l) { return base + neighbour[l] * 4; }, u);
      const Vec3<T> d = u - own[0];
      spread -= load_rows<B>(&rows.coupling(e, at.offset)) * dot(d, d);
    }
    const T volume = load_rows<B>(&rows.volume(at.slot)), half = T(0.5f);
    const auto c = load_constants<Material, T>(rows.constants, region, rows.fibres, at.slot);
    T energy = volume * Material::energy(Mat3<T>::identity() + G[0], c) +
               half * T(rows.stabiliser(region)) * (half * spread - volume * inner(G[0], G[0]));
    if constexpr (Smoothed) {
      const T x = smoothed<B>(rows, work.ratio.data(), 1, at);
      const T excess = T(rows.bulk_excess(region));
      // the augmented Lagrangian, which has its minimum where the energy has it
      if (carried.extent(0) > 0) {
        const T mixed = load_rows<B>(&carried(at.slot)), away = x - mixed;
        const T augmented = T(Kokkos::min(rows.bulk_excess(region), 100 * rows.stabiliser(region)));
        energy += volume * (excess * Material::volumetric(mixed, c).first * (x - T(1)) +
                            half * augmented * away * away);
      } else {
        energy += volume * (excess * Material::volumetric(x, c).energy);
      }
    }
    for (int l = 0; l < B::lanes; ++l) {
      partial(at.slot + l, 0) = lane(energy, l);
      partial(at.slot + l, 1) = partial(at.slot + l, 2) = 0;
    }
  }
};

template <class B, class Material>
void nodal_energy(const typename B::Exec& exec, const LevelData<B>& level, const Vectors<B>& u) {
  const NodalRows<B>& rows = level.model.rows;
  lay_out<B>(exec, level, {u});
  by_smoothing<Material>(rows, [&]<bool smoothed>(std::bool_constant<smoothed>) {
    if constexpr (smoothed) {
      for_rows<B>(exec, "plica::nodal_volumes", rows,
                  RowDilatations<B, Material, 1>{rows, level.nodal});
      share_slots<B>(exec, level, level.nodal.ratio, 1);
    }
    for_rows<B>(exec, "plica::nodal_energy", rows,
                NodalEnergy<B, Material, smoothed>{rows, level.nodal, level.partial,
                                                   carried_dilatations<B>(rows, level.nodal)});
  });
}

/// Stress and strain of every slot; for output. Where pressures are smoothed, F_a is scaled by
/// (x~/x)^(1/3), so that with x = J its volume ratio is J~, as in F-bar elements (de Souza Neto,
/// Peric, Dutko & Owen 1996). So the pressure of x, which alternates from vertex to vertex, does
/// not show. A domain that is inverted keeps its own F_a.
template <class B, class Material, bool Smoothed>
struct NodalStress {
  using T = RowPack<B>;
  NodalRows<B> rows;
  NodalWork<B> work;
  RowPressure<B> pressure;
  StressFields<B> fields;
  Scalars<B> relaxed;  ///< relaxed stress; see ViscousHistory
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    Vec3<T> own[1];
    Mat3<T> G[1];
    row_gradients<B, 1>(rows, work.near, at, own, G);
    Mat3<T> F = Mat3<T>::identity() + G[0];
    T J = determinant(F);
    if constexpr (Smoothed)
      if (!fields.own_volumes) {
        const T part = smoothed<B>(rows, work.ratio.data(), 1, at) /
                       typename Material::template Dilatation<T>(F).value;
        const T scale = where_positive(J, where_positive(part, part, T(1)), T(1));
        F = (T(1) / inverse_cube_root(scale)) * F, J = scale * J;
      }
    const int region = rows.region(at.slice);
    Mat3<T> sigma = cauchy_stress<Material>(
        F, load_constants<Material, T>(rows.constants, region, rows.fibres, at.slot));
    if (relaxed.extent(0) > 0)
      sigma = sigma - pushed_forward(F, load_symmetric<B, T>(relaxed, at.slot));
    if constexpr (Smoothed)
      sigma = sigma + (pressure.at(at.slot, 0) / J) *
                          (typename Material::template Dilatation<T>(F).slope * transpose(F));
    const T equivalent = von_mises(sigma);
    for (int l = 0; l < B::lanes; ++l) {
      work.records(2 * (at.slot + l)) = lane(equivalent, l);
      work.records(2 * (at.slot + l) + 1) = lane(J, l);
    }
    if (fields.of_domains.extent(0) > 0) store_tensors<B>(fields.of_domains, at.slot, sigma, F);
  }
};

/// Mean of each vertex over its domains, by volume. A vertex between regions has several domains.
template <class B>
struct MeanOfDomains {
  using Real = typename B::Real;
  VertexShares<B> shares;
  Scalars<B> volume, records;
  StressFields<B> fields;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    Real total = 0, stress = 0, J = 0;
    for (int s = shares.first(a); s < shares.first(a + 1); ++s) {
      const int slot = shares.row(s);
      total += volume(slot), stress += volume(slot) * records(2 * slot),
          J += volume(slot) * records(2 * slot + 1);
    }
    fields.von_mises(a) = stress / total, fields.J(a) = J / total;
    constexpr int numbers = StressFields<B>::numbers;
    for (int k = 0; fields.tensors.extent(0) > 0 && k < numbers; ++k) {
      Real sum = 0;
      for (int s = shares.first(a); s < shares.first(a + 1); ++s)
        sum += volume(shares.row(s)) * fields.of_domains(shares.row(s) * numbers + k);
      fields.tensors(a * numbers + k) = sum / total;
    }
  }
};

template <class B>
void mean_of_domains(const typename B::Exec& exec, const LevelData<B>& level,
                     const StressFields<B>& fields) {
  const NodalRows<B>& rows = level.model.rows;
  update_vertices<B>(exec, "plica::nodal_means", level.model.vertices,
                     MeanOfDomains<B>{rows.shares, rows.volume, level.nodal.records, fields});
}

template <class B, class Material>
void nodal_stress(const typename B::Exec& exec, const LevelData<B>& level, const Vectors<B>& u,
                  const StressFields<B>& fields) {
  const NodalRows<B>& rows = level.model.rows;
  lay_out<B>(exec, level, {u});
  by_smoothing<Material>(rows, [&]<bool smoothed>(std::bool_constant<smoothed>) {
    if constexpr (smoothed) smooth_pressures<B, Material, 1>(exec, level);
    for_rows<B>(exec, "plica::nodal_stress", rows,
                NodalStress<B, Material, smoothed>{
                    rows, level.nodal, {level.nodal.pressure, 1}, fields, level.stress.relaxed});
  });
  mean_of_domains<B>(exec, level, fields);
}

// Functions that are equal for all materials are compiled once, in nodal_elements.cpp.
#define PLICA_NODAL_ELEMENTS(EXTERN, ...)                                           \
  EXTERN template void for_rows<__VA_ARGS__>(const __VA_ARGS__::Exec&, const char*, \
                                             const NodalRows<__VA_ARGS__>&,         \
                                             const SmoothRows<__VA_ARGS__, 1>&);    \
  EXTERN template void for_rows<__VA_ARGS__>(const __VA_ARGS__::Exec&, const char*, \
                                             const NodalRows<__VA_ARGS__>&,         \
                                             const SmoothRows<__VA_ARGS__, 2>&);    \
  EXTERN template void mean_of_domains<__VA_ARGS__>(                                \
      const __VA_ARGS__::Exec&, const LevelData<__VA_ARGS__>&, const StressFields<__VA_ARGS__>&);
#define PLICA_EXTERN_NODAL_ELEMENTS(Real, Exec) PLICA_NODAL_ELEMENTS(extern, Backend<Real, Exec>)
PLICA_FOR_EACH_PRECISION(PLICA_EXTERN_NODAL_ELEMENTS)
#undef PLICA_EXTERN_NODAL_ELEMENTS

}  // namespace plica
