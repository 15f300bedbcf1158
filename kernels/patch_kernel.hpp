// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inlining.hpp>
#include <plica/core/launch.hpp>
#include <plica/core/patches.hpp>
#include <plica/core/small.hpp>
#include <plica/core/transposed.hpp>

namespace plica {

/// What an integrand is given of the elements of one pack.
template <class T>
struct ElementShape {
  Vec3<T> gradient[3];  ///< of the shape functions of corners 1, 2, 3 [1/m]; corner 0's is minus their sum
  T volume;             ///< [m^3]
};

/// Where a pack's numbers lie in scratch.
template <class B>
inline constexpr int patch_stride = B::lanes >= 4 ? 4 : 3;  ///< of vectors: whole quarters of a register

/// What the pack after next but one reads: a patch's streams are too many and too short for the hardware to foresee.
template <int lanes, class Number>
KOKKOS_INLINE_FUNCTION void prefetch_pack([[maybe_unused]] const Number* from, [[maybe_unused]] int count) {
#if defined(__GNUC__) && !defined(__CUDACC__)
  if constexpr (lanes > 1)
    for (int i = 0; i < count; i += 64 / static_cast<int>(sizeof(Number))) __builtin_prefetch(from + i);
#endif
}

/// A pack's elements, and the gradients G of the vertex fields in `local`.
template <class B, int fields, class T>
KOKKOS_INLINE_FUNCTION void load_pack(const Patches<B>& patches, int pack, const typename B::Real* local,
                                      ElementShape<T>& shape, Mat3<T> (&G)[fields]) {
  using Real = typename B::Real;
  constexpr int lanes = B::lanes;
  const Real* const stored = &patches.shape(pack, 0, 0);
  const std::uint16_t* const corner_of = &patches.corner(pack, 0, 0);
  prefetch_pack<lanes>(stored + 3 * 10 * lanes, 10 * lanes), prefetch_pack<lanes>(corner_of + 3 * 4 * lanes, 4 * lanes);
  const auto load = [&](int k) {
    T r;
    for (int l = 0; l < lanes; ++l) set_lane(r, l, stored[k * lanes + l]);
    return r;
  };
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 3; ++k) shape.gradient[c][k] = load(3 * c + k);
  shape.volume = load(9);
  for (int f = 0; f < fields; ++f) {
    Vec3<T> u[4];
    for (int c = 0; c < 4; ++c) {
      const std::uint16_t* const at = corner_of + c * lanes;
      load_vectors([=](int l) { return local + (at[l] * fields + f) * patch_stride<B>; }, u[c]);
    }
    const Vec3<T> d[3] = {u[1] - u[0], u[2] - u[0], u[3] - u[0]};
    for (int r = 0; r < 3; ++r)
      G[f][r] = d[0][r] * shape.gradient[0] + d[1][r] * shape.gradient[1] + d[2][r] * shape.gradient[2];
  }
}

// How nodal forces are summed without a conflict and in the same order on any number of threads. The mesh is cut into patches of
// at most 256 neighbouring tetrahedra (core/patches.hpp). One team of threads works on one patch, in memory that is its own: the
// first-level cache of a CPU, the shared memory of a GPU. It gathers the displacements of the patch's vertices once. It computes
// the elements a pack at a time: one element in each lane of a vector register, so that each instruction serves 2 to 16 elements.
// Each element writes the forces at its four corners to a place of its own, and nobody else writes there. Then each vertex of the
// patch adds up the places that belong to it, in a stored order. A vertex on the border of patches has such a sum in each of
// them; a second kernel, gather_forces, adds these up. No two threads ever write to one number, so no atomics are needed.
//
//   u [vertices][3]                                      one patch, in scratch
//     | 1. gather by `vertex`          .--------------------------------------------------------------.
//     '------------------------------> | local   [patch vertex] (x y z -)    a fourth number pads it  |
//                                      |   | 2. by `corner`, transposed: lane l = element l of a pack |
//   corner, shape [pack] ------------> |   v     element(): grad u -> integrand -> 4 corner vectors   |
//     (streamed from memory)           | forces  [pack][corner][x y z][lane]                          |
//                                      |   | 3. each patch vertex adds its slots, by `slot`           |
//     .------------------------------- |   v     sums                                                 |
//     v                                '--------------------------------------------------------------'
//   partial [patch vertex][3]
//     | 4. gather_forces: each vertex of the mesh adds its copies, by `copy`, and its weight
//     v
//   f [vertices][3]

/// Runs an integrand over all elements and adds its corner vectors up per patch vertex, one team per patch:
/// 1. the patch's vertex fields into scratch, 2. the corner vectors of its elements into scratch, 3. their sums per
/// patch vertex into `partial`. An integrand has
///   static constexpr int fields;   Vectors<B> field[fields];        what it reads, [vertices][3]
///   void operator()(const Mat3<T> (&G)[fields], const ElementShape<T>&, Vec3<T> (&corner)[4], int patch, int pack)
/// with G the gradients of the fields. One that has a member `adds` adds to what is in `partial`. Bytes that must move per element, s = sizeof(Real): 8 (corners) + 10 s (shape) +
/// 8 (slots), and per patch vertex 10 + 3 s fields + 3 s.
template <class B, class Integrand>
struct PatchKernel {
  using Real = typename B::Real;
  using Policy = Kokkos::TeamPolicy<typename B::Exec>;
  using Member = typename Policy::member_type;
  static constexpr int lanes = B::lanes;
  static constexpr int fields = Integrand::fields;
  static constexpr int stride = patch_stride<B>;
  static constexpr bool adds = requires { Integrand::adds; };
  static constexpr int force_slots = (Patches<B>::capacity + lanes - 1) / lanes * 12 * lanes;
  static KOKKOS_FUNCTION constexpr std::size_t scratch_bytes() {
    return (static_cast<std::size_t>(force_slots) + Patches<B>::vertex_capacity * stride * fields) * sizeof(Real);
  }
  using T = typename PackOf<Real, lanes>::type;

  Patches<B> patches;
  Integrand integrand;
  Vectors<B> partial;  ///< [patch vertices][3]

  KOKKOS_INLINE_FUNCTION void operator()(const Member& team) const {
    const int p = league_rank(team);
    const int first_vertex = patches.first_vertex(p), vertices = patches.first_vertex(p + 1) - first_vertex;
    const int first_pack = patches.first_pack(p), packs = patches.first_pack(p + 1) - first_pack;
    Real* const forces = team_scratch<Real>(team, 0, scratch_bytes() / sizeof(Real));
    Real* const local = forces + force_slots;

    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, vertices), [&](int i) {
      const int a = patches.vertex(first_vertex + i);
      for (int f = 0; f < fields; ++f)
        for (int k = 0; k < 3; ++k) local[(i * fields + f) * stride + k] = integrand.field[f](a, k);
    });
    team.team_barrier();
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, packs),
                         [&](int q) { element(p, first_pack + q, local, forces + q * 12 * lanes); });
    team.team_barrier();
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, vertices), [&](int i) {
      Real x = 0, y = 0, z = 0;
      for (int s = patches.first_slot(first_vertex + i); s < patches.first_slot(first_vertex + i + 1); ++s) {
        const Real* f = forces + patches.slot(s);
        x += f[0], y += f[lanes], z += f[2 * lanes];
      }
      const int to = first_vertex + patches.summed(first_vertex + i);
      if constexpr (adds) x += partial(to, 0), y += partial(to, 1), z += partial(to, 2);
      partial(to, 0) = x, partial(to, 1) = y, partial(to, 2) = z;
    });
  }

  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void element(int patch, int pack, const Real* local, Real* forces) const {
    ElementShape<T> shape;
    Mat3<T> G[fields];
    load_pack<B, fields>(patches, pack, local, shape, G);
    Vec3<T> corner[4];
    integrand(G, shape, corner, patch, pack);
    for (int c = 0; c < 4; ++c)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < lanes; ++l) forces[(c * 3 + k) * lanes + l] = lane(corner[c][k], l);
  }
};

/// Corner vectors of a stress: minus volume * P * gradient, balanced.
template <class T>
KOKKOS_INLINE_FUNCTION void stress_to_corners(const Mat3<T>& P, const ElementShape<T>& shape, Vec3<T> (&corner)[4]) {
  const T minus_volume = -shape.volume;
  for (int c = 0; c < 3; ++c) corner[c + 1] = minus_volume * (P * shape.gradient[c]);
  corner[0] = T(-1) * (corner[1] + corner[2] + corner[3]);
}

template <class B, class Integrand>
void launch_patches(const typename B::Exec& exec, const char* label, const Patches<B>& patches,
                    const Integrand& integrand, const Vectors<B>& partial) {
  using Kernel = PatchKernel<B, Integrand>;
  if (patches.count == 0) return;
  typename Kernel::Policy policy(exec, patches.count, team_size<B>(128));
  launch(label, policy.set_scratch_size(0, Kokkos::PerTeam(Kernel::scratch_bytes() + 64)),
         Kernel{patches, integrand, partial});
}

}  // namespace plica
