// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/implicit_weights.hpp>
#include <plica/core/matrices.hpp>
#include <plica/core/model.hpp>
#include <plica/kernels/elastic/elastic_tangent.hpp>
#include <plica/kernels/vectors.hpp>

// Assembles A = (1 + b c) M + a K(u) + b D(u) as blocks, see ImplicitWeights and
// damping_stress.hpp.
//
//   1. ElasticBlocks, per patch    the six blocks between two corners of each element, into
//                                  scratch; then, pair by pair of the patch's vertices, their sum,
//                                  to the matrix, or to `shares` where other patches have the pair
//                                  as well
//   2. AddShares                   the shares of pairs of several patches, to the matrix
//   3. OwnBlocks                   a vertex's own block: the mass, minus the sum of its row, as the
//                                  stiffness has no force against a motion of the whole body
//
// All sums are in a fixed order. Bytes per element, s = sizeof(Real): 8 (corners) + 10 s (shape) +
// 12 (slots), and 9 s per stored block of the matrix, written, and read once or twice more; in
// scratch, which a second-level cache holds, 56 s written and 54 s read.
namespace plica {

/// Numbers of an element's six blocks, filled up to whole quarters of a register.
constexpr int element_numbers = 56;

/// Returns the place of block (p, q), p < q, of an element among its six.
KOKKOS_INLINE_FUNCTION constexpr int element_block(int p, int q) { return p * (5 - p) / 2 + q - 1; }

/// Computes scale * volume (dP/dF : grad N_q) grad N_p for corners p < q, column by column. The
/// blocks of corner 0 follow by balance.
template <class T, class Tangent>
KOKKOS_INLINE_FUNCTION void element_blocks(const Tangent& tangent, const ElementShape<T>& shape,
                                           const T& scale, T (&K)[element_numbers]) {
  const T weight = scale * shape.volume;
  const typename Tangent::Corner corner[3] = {tangent.corner(shape.gradient[0]),
                                              tangent.corner(shape.gradient[1]),
                                              tangent.corner(shape.gradient[2])};
  for (int q = 1; q < 4; ++q)
    for (int p = 1; p < q; ++p) {
      const Mat3<T> block = tangent.block(corner[p - 1], corner[q - 1]);
      for (int k = 0; k < 9; ++k) K[9 * element_block(p, q) + k] = weight * block[k % 3][k / 3];
    }
  for (int q = 1; q < 4; ++q) {
    const Mat3<T> own = tangent.block(corner[q - 1], corner[q - 1]);
    for (int k = 0; k < 9; ++k) {
      T sum = weight * own[k % 3][k / 3];
      for (int p = 1; p < 4; ++p)
        if (p < q)
          sum = sum + K[9 * element_block(p, q) + k];
        else if (p > q)
          sum = sum + K[9 * element_block(q, p) + k % 3 * 3 + k / 3];
      K[9 * element_block(0, q) + k] = T(0) - sum;
    }
  }
  K[54] = K[55] = T(0);
}

/// Step 1: sums up the blocks of elements, pair by pair of a patch's vertices.
template <class B, class Material, class Tangent, bool Damped>
struct ElasticBlocks {
  using Real = typename B::Real;
  using Policy = Kokkos::TeamPolicy<typename B::Exec>;
  using Member = typename Policy::member_type;
  static constexpr int lanes = B::lanes;
  static KOKKOS_FUNCTION constexpr std::size_t near_bytes() {
    return Patches<B>::vertex_capacity * patch_stride<B> * sizeof(Real);
  }
  static KOKKOS_FUNCTION constexpr std::size_t far_bytes() {
    return static_cast<std::size_t>((Patches<B>::capacity + lanes - 1) / lanes * lanes) *
           element_numbers * sizeof(Real);
  }
  using T = typename PackOf<Real, lanes>::type;

  Patches<B> patches;
  PatchPairs<B> pairs;
  Vectors<B> field[1];
  BlockMatrix<B> A;
  Blocks9<B> shares;
  DampingRate<B> rate;
  Real a;

  KOKKOS_INLINE_FUNCTION void operator()(const Member& team) const {
    const int p = league_rank(team);
    const int first_pack = patches.first_pack(p), packs = patches.first_pack(p + 1) - first_pack;
    const int first = pairs.first_pair(p), first_shared = pairs.first_shared(p),
              count = pairs.first_pair(p + 1) - first;
    Real* const local = team_scratch<Real>(team, 0, near_bytes() / sizeof(Real));
    Real* const blocks = team_scratch<Real>(team, 1, far_bytes() / sizeof(Real));
    load_patch<B>(team, patches, p, field, local);
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, packs), [&](int q) {
      element(p, first_pack + q, local, blocks + q * lanes * element_numbers);
    });
    team.team_barrier();
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, count),
                         [&](int i) { sum(first + i, first + i >= first_shared, blocks); });
  }

  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void element(int patch, int pack, const Real* local,
                                                    Real* blocks) const {
    ElementShape<T> shape;
    Mat3<T> G[1];
    load_pack<B, 1>(patches, pack, local, shape, G);
    T K[element_numbers];
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    const auto c =
        load_constants<Material, T>(patches.constants, patch, patches.fibres, pack * lanes);
    element_blocks(Tangent(F, c), shape, T(a), K);
    if constexpr (Damped) {
      T D[element_numbers];
      element_blocks(DampingTangent<Material, T>{F, c}, shape, T(rate(patch)), D);
      for (int k = 0; k < element_numbers; ++k) K[k] += D[k];
    }
    for (int k = 0; k < element_numbers; k += 4) {
      const T four[4] = {K[k], K[k + 1], K[k + 2], K[k + 3]};
      store_fours(four, [=](int l) { return blocks + l * element_numbers + k; });
    }
  }

  KOKKOS_INLINE_FUNCTION void sum(int pair, bool shared, const Real* blocks) const {
    Real total[9] = {};
    int s = pairs.first_turned(pair);
    const int last = pairs.first_slot(pair + 1);
    if (s < last) {
      Real turned[9] = {};
      for (; s < last; ++s) {
        const Real* const from = blocks + pairs.slot(s);
        for (int k = 0; k < 9; ++k) turned[k] += from[k];
      }
      for (int k = 0; k < 9; ++k) total[k] = turned[k % 3 * 3 + k / 3];
    }
    for (s = pairs.first_slot(pair); s < pairs.first_turned(pair); ++s) {
      const Real* const from = blocks + pairs.slot(s);
      for (int k = 0; k < 9; ++k) total[k] += from[k];
    }
    Real* const to = shared ? &shares(pairs.place(pair), 0) : &A.value(pairs.place(pair), 0);
    for (int k = 0; k < 9; ++k) to[k] = total[k];
  }
};

/// Step 2: adds up the blocks in which several patches have a share.
template <class B>
struct AddShares {
  PatchPairs<B> pairs;
  Blocks9<B> shares;
  BlockMatrix<B> A;
  KOKKOS_INLINE_FUNCTION void operator()(int b) const {
    typename B::Real total[9] = {};
    for (int s = pairs.first_share(b); s < pairs.first_share(b + 1); ++s)
      for (int k = 0; k < 9; ++k) total[k] += shares(s, k);
    for (int k = 0; k < 9; ++k) A.value(pairs.shared_place(b), k) = total[k];
  }
};

/// Step 3: computes row a's own block, its mass minus the sum of the row's other blocks.
template <class B>
struct OwnBlocks {
  using Real = typename B::Real;
  BlockMatrix<B> A;
  Scalars<B> mass;
  MassDamping<B> damping;
  Real b;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const int own = A.diagonal(a), at = A.place(own);
    Real sum[9] = {};  // blocks turned or not: the result is the symmetric part of their sum
    const auto subtract = [&](int first, int last) {
      for (int s = first; s < last; ++s)
        for (int k = 0; k < 9; ++k) sum[k] -= A.value(A.place(s), k);
    };
    subtract(A.first(a), own), subtract(own + 1, A.first(a + 1));
    const Real m = (1 + b * damping(a)) * mass(a);
    for (int k = 0; k < 9; ++k)
      A.value(at, k) = Real(0.5) * (sum[k] + sum[k % 3 * 3 + k / 3]) + (k % 4 == 0 ? m : Real(0));
  }
};

/// Runs steps 2 and 3.
template <class B>
void finish_blocks(const typename B::Exec& exec, const Model<B>& model, const PatchPairs<B>& pairs,
                   const ImplicitWeights& weights, const Blocks9<B>& shares,
                   const BlockMatrix<B>& A) {
  update_vertices<B>(exec, "plica::add_shares", static_cast<int>(pairs.shared_place.extent(0)),
                     AddShares<B>{pairs, shares, A});
  update_vertices<B>(
      exec, "plica::own_blocks", model.vertices,
      OwnBlocks<B>{A, model.mass, model.damping, static_cast<typename B::Real>(weights.b)});
}

/// Assembles A of vertices that are free; the rows of the others keep their mass alone.
template <class B, class Material, template <class> class Tangent>
void elastic_blocks(const typename B::Exec& exec, const Model<B>& model, const PatchPairs<B>& pairs,
                    const Vectors<B>& u, const ImplicitWeights& weights, const Blocks9<B>& shares,
                    const BlockMatrix<B>& A) {
  using Real = typename B::Real;
  const DampingRate<B> rate{model.patches.damping, static_cast<Real>(weights.b)};
  by_case(rate.counts(), [&]<bool damped>(std::bool_constant<damped>) {
    using Kernel =
        ElasticBlocks<B, Material, Tangent<typename PackOf<Real, B::lanes>::type>, damped>;
    typename Kernel::Policy policy(exec, model.patches.count, team_size<B>(128));
    policy.set_scratch_size(0, Kokkos::PerTeam(Kernel::near_bytes() + 64));
    policy.set_scratch_size(1, Kokkos::PerTeam(Kernel::far_bytes() + 64));
    launch("plica::elastic_blocks", policy,
           Kernel{model.patches, pairs, {u}, A, shares, rate, static_cast<Real>(weights.a)});
  });
  finish_blocks<B>(exec, model, pairs, weights, shares, A);
}

// Functions that are equal for all materials are compiled once, in elastic_blocks.cpp.
#define PLICA_ELASTIC_BLOCKS(EXTERN, ...)                                                  \
  EXTERN template void finish_blocks<__VA_ARGS__>(                                         \
      const __VA_ARGS__::Exec&, const Model<__VA_ARGS__>&, const PatchPairs<__VA_ARGS__>&, \
      const ImplicitWeights&, const Blocks9<__VA_ARGS__>&, const BlockMatrix<__VA_ARGS__>&);
#define PLICA_EXTERN_ELASTIC_BLOCKS(Real, Exec) PLICA_ELASTIC_BLOCKS(extern, Backend<Real, Exec>)
PLICA_FOR_EACH_BACKEND(PLICA_EXTERN_ELASTIC_BLOCKS)
#undef PLICA_EXTERN_ELASTIC_BLOCKS

}  // namespace plica
