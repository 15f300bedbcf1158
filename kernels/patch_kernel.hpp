// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inlining.hpp>
#include <plica/core/launch.hpp>
#include <plica/core/patches.hpp>
#include <plica/core/small.hpp>
#include <plica/core/transposed.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

/// Gradients and volumes of the elements of one pack, one element in each lane.
template <class T>
struct ElementShape {
  /// Gradients of the shape functions of corners 1, 2, 3 [1/m]; that of corner 0 is minus their sum
  Vec3<T> gradient[3];
  T volume;  ///< volume [m^3]
};

/// Numbers from one vector of a patch to the next in scratch. With 4, each vector fills whole
/// quarters of a register.
template <class B>
inline constexpr int patch_stride = B::lanes >= 4 ? 4 : 3;

/// Prefetches `count` numbers, those of the pack three ahead of the present one. A patch's streams
/// are too many and too short for the hardware to foresee.
template <int lanes, class Number>
KOKKOS_INLINE_FUNCTION void prefetch_pack([[maybe_unused]] const Number* from,
                                          [[maybe_unused]] int count) {
#if defined(__GNUC__) && !defined(__CUDACC__)
  if constexpr (lanes > 1)
    for (int i = 0; i < count; i += 64 / static_cast<int>(sizeof(Number)))
      __builtin_prefetch(from + i);
#endif
}

/// Loads the vectors that a patch's vertices have in some fields into `local`. A CPU reads four
/// numbers at once, except at the greatest vertex, behind which there may be nothing to read.
template <class B, int fields, class Member>
KOKKOS_INLINE_FUNCTION void load_patch(const Member& team, const Patches<B>& patches, int patch,
                                       const Vectors<B> (&field)[fields], typename B::Real* local) {
  const int first = patches.first_vertex(patch), vertices = patches.first_vertex(patch + 1) - first;
  Kokkos::parallel_for(Kokkos::TeamThreadRange(team, vertices), [&](int i) {
    const int a = patches.vertex(first + i);
    for (int f = 0; f < fields; ++f) {
      typename B::Real* const to = local + (i * fields + f) * patch_stride<B>;
      if constexpr (patch_stride<B> == 4)
        if (i + 1 < vertices) {
          store_lanes(four_at<B>(field[f], a), to);
          continue;
        }
      const auto x = vector_at<B>(field[f], a);
      for (int k = 0; k < 3; ++k) to[k] = x[k];
    }
  });
  team.team_barrier();
}

/// Loads a pack's elements, and computes the gradients G of the vertex fields in `local`.
template <class B, int fields, class T>
KOKKOS_INLINE_FUNCTION void load_pack(const Patches<B>& patches, int pack,
                                      const typename B::Real* local, ElementShape<T>& shape,
                                      Mat3<T> (&G)[fields]) {
  using Real = typename B::Real;
  constexpr int lanes = B::lanes;
  const Real* const stored = &patches.shape(pack, 0, 0);
  const std::uint16_t* const corner_of = &patches.corner(pack, 0, 0);
  prefetch_pack<lanes>(stored + 3 * 10 * lanes, 10 * lanes),
      prefetch_pack<lanes>(corner_of + 3 * 4 * lanes, 4 * lanes);
  // written out: a loop that the compiler does not unroll would keep packs in memory
  const auto number = [&](int k) { return load_lanes<T>(stored + k * lanes); };
  const auto vector = [&](int k) { return Vec3<T>{number(k), number(k + 1), number(k + 2)}; };
  shape.gradient[0] = vector(0), shape.gradient[1] = vector(3), shape.gradient[2] = vector(6);
  shape.volume = number(9);
  for (int f = 0; f < fields; ++f) {
    const auto corner = [&](int c) {
      Vec3<T> u;
      const std::uint16_t* const at = corner_of + c * lanes;
      load_vectors(
          [=](int l) { return local + (std::size_t{at[l]} * fields + f) * patch_stride<B>; }, u);
      return u;
    };
    const Vec3<T> u0 = corner(0), d[3] = {corner(1) - u0, corner(2) - u0, corner(3) - u0};
    for (int r = 0; r < 3; ++r)
      G[f][r] =
          d[0][r] * shape.gradient[0] + d[1][r] * shape.gradient[1] + d[2][r] * shape.gradient[2];
  }
}

// How nodal forces are summed without a conflict and in the same order on any number of threads.
// The mesh is cut into patches of at most 256 neighbouring tetrahedra (core/patches.hpp). One team
// of threads works on one patch, in memory that is its own: the first-level cache of a CPU, the
// shared memory of a GPU. It gathers the displacements of the patch's vertices once. It computes
// the elements a pack at a time: one element in each lane of a vector register, so that each
// instruction serves 2 to 16 elements. Each element writes the forces at its four corners to slots
// of its own. Then each vertex of the patch adds up the slots that belong to it, in a stored order;
// a CPU does so for four vertices at once. A vertex on the border of patches has such a sum in each
// of them; a second kernel, gather_forces, adds these up. No two threads ever write to one number,
// so no atomics are needed.
//
//   u [vertices][3]                                  one patch, in scratch
//     | 1. gather by `vertex`      .--------------------------------------------------------------.
//     '--------------------------> | local   [patch vertex] (x y z -)    a fourth number pads it  |
//                                  |   | 2. by `corner`, transposed: lane l = element l of a pack |
//   corner, shape [pack] --------> |   v     element(): grad u -> integrand -> 4 corner vectors   |
//     (streamed from memory)       | forces  [pack][corner][x y z][lane]                          |
//                                  |   | 3. each patch vertex adds its slots, by `slot`           |
//     .--------------------------- |   v     sums                                                 |
//     v                            '--------------------------------------------------------------'
//   partial [patch vertex][3]
//     | 4. gather_forces: each vertex of the mesh adds its copies, by `copy`, and its weight
//     v
//   f [vertices][3]

/// Runs an integrand over all elements, and adds its corner vectors up per patch vertex. One team
/// works on a patch, in three steps:
///   1. the patch's vertex fields into scratch,
///   2. the corner vectors of its elements into scratch,
///   3. their sums per patch vertex into `partial`.
/// An integrand has
///   static constexpr int fields;   Vectors<B> field[fields];        what it reads, [vertices][3]
///   void operator()(const Mat3<T> (&G)[fields], const ElementShape<T>&, Vec3<T> (&corner)[4],
///                   int patch, int pack)
/// with G the gradients of the fields. An integrand that has a member `adds` adds to what is in
/// `partial`. Bytes that must move per element, s = sizeof(Real): 8 (corners) + 10 s (shape) + 8
/// (slots), and per patch vertex 7 + 3 s fields + 3 s.
template <class B, class Integrand>
struct PatchKernel {
  using Real = typename B::Real;
  using Policy = Kokkos::TeamPolicy<typename B::Exec>;
  using Member = typename Policy::member_type;
  static constexpr int lanes = B::lanes;
  static constexpr int fields = Integrand::fields;
  static constexpr int stride = patch_stride<B>;
  static constexpr bool adds = requires { Integrand::adds; };
  static constexpr int at_once = Patches<B>::at_once;
  static constexpr int force_slots = Patches<B>::nothing + 3 * lanes;
  static KOKKOS_FUNCTION constexpr std::size_t scratch_bytes() {
    return (static_cast<std::size_t>(force_slots) + Patches<B>::vertex_capacity * stride * fields) *
           sizeof(Real);
  }
  using T = typename PackOf<Real, lanes>::type;

  Patches<B> patches;
  Integrand integrand;
  Vectors<B> partial;  ///< [patch vertices][3]

  KOKKOS_INLINE_FUNCTION void operator()(const Member& team) const {
    const int p = league_rank(team);
    const int first_vertex = patches.first_vertex(p),
              vertices = patches.first_vertex(p + 1) - first_vertex;
    const int first_pack = patches.first_pack(p), packs = patches.first_pack(p + 1) - first_pack;
    Real* const forces = team_scratch<Real>(team, 0, scratch_bytes() / sizeof(Real));
    Real* const local = forces + force_slots;
    if constexpr (at_once > 1)  // zeros, to which slot `nothing` refers
      for (int k = 0; k < 3; ++k) forces[Patches<B>::nothing + k * lanes] = 0;

    load_patch<B>(team, patches, p, integrand.field, local);
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, packs), [&](int q) {
      element(p, first_pack + q, local, forces + q * 12 * lanes);
    });
    team.team_barrier();
    const int first_sum = patches.first_sum(p), sums = patches.first_sum(p + 1) - first_sum;
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, sums), [&](int i) {
      Real x[at_once] = {}, y[at_once] = {}, z[at_once] = {};
      const int last = patches.first_slot(first_sum + i + 1);
      for (int s = patches.first_slot(first_sum + i); s < last; s += at_once)
        for (int j = 0; j < at_once; ++j) {
          const Real* f = forces + patches.slot(s + j);
          x[j] += f[0], y[j] += f[lanes], z[j] += f[2 * lanes];
        }
      for (int j = 0; j < at_once && i * at_once + j < vertices; ++j) {
        const int to = first_vertex + patches.summed(first_vertex + i * at_once + j);
        const Vec3<Real> sum{x[j], y[j], z[j]};
        set_vector<B>(partial, to, adds ? vector_at<B>(partial, to) + sum : sum);
      }
    });
  }

  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void element(int patch, int pack, const Real* local,
                                                    Real* forces) const {
    ElementShape<T> shape;
    Mat3<T> G[fields];
    load_pack<B, fields>(patches, pack, local, shape, G);
    Vec3<T> corner[4];
    integrand(G, shape, corner, patch, pack);
    for (int c = 0; c < 4; ++c)
      for (int k = 0; k < 3; ++k) store_lanes(corner[c][k], forces + (c * 3 + k) * lanes);
  }
};

/// Computes the corner vectors of a stress P: -volume * P * gradient, with a sum of 0.
template <class T>
KOKKOS_INLINE_FUNCTION void stress_to_corners(const Mat3<T>& P, const ElementShape<T>& shape,
                                              Vec3<T> (&corner)[4]) {
  const T minus_volume = -shape.volume;
  for (int c = 0; c < 3; ++c) corner[c + 1] = minus_volume * (P * shape.gradient[c]);
  corner[0] = T(-1) * (corner[1] + corner[2] + corner[3]);
}

/// Launches an integrand on all patches, with its sums per patch vertex in `partial`.
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
