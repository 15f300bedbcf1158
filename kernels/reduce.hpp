// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/backend.hpp>

namespace plica {

/// N sums at once, always in double; the last `Maxima` of them are the largest instead, of values not below 0.
template <int N, int Maxima = 0>
struct Sums {
  double value[N] = {};
  KOKKOS_INLINE_FUNCTION double& operator[](int i) { return value[i]; }
  KOKKOS_INLINE_FUNCTION double operator[](int i) const { return value[i]; }
  KOKKOS_INLINE_FUNCTION Sums& operator+=(const Sums& other) {
    for (int i = 0; i < N - Maxima; ++i) value[i] += other.value[i];
    for (int i = N - Maxima; i < N; ++i) value[i] = value[i] < other.value[i] ? other.value[i] : value[i];
    return *this;
  }
};

}  // namespace plica

template <int N, int Maxima>
struct Kokkos::reduction_identity<plica::Sums<N, Maxima>> {
  KOKKOS_FORCEINLINE_FUNCTION static plica::Sums<N, Maxima> sum() { return {}; }
};

namespace plica {

/// Where reductions keep their block sums; sized once for the longest field.
template <class B>
class BlockSums {
 public:
  static constexpr int block = 512;  ///< items added up by one team, whatever the number of threads
  static constexpr int widest = 16;
  BlockSums() = default;
  explicit BlockSums(int items) : sums_("plica::block_sums", (items + block - 1) / block + 1) {}
  const Kokkos::View<double* [widest], Kokkos::LayoutRight, typename B::Memory>& view() const { return sums_; }

  private : Kokkos::View<double* [widest], Kokkos::LayoutRight, typename B::Memory> sums_;
};

/// result(k) = sum over i < n of term(i)[k]; the order of additions depends on n alone. term: Tally operator()(int) const.
template <class B, int N, class Term, class Tally>
struct BlockReduction {
  using Policy = Kokkos::TeamPolicy<typename B::Exec>;
  using Member = typename Policy::member_type;
  using Block = Kokkos::View<double * [BlockSums<B>::widest], Kokkos::LayoutRight, typename B::Memory>;
  struct Terms {};
  struct Blocks {};

  int n;
  Term term;
  Block blocks;
  Kokkos::View<double*, typename B::Memory> result;

  KOKKOS_INLINE_FUNCTION void operator()(Terms, const Member& team) const {
    const int first = team.league_rank() * BlockSums<B>::block, last = Kokkos::min(first + BlockSums<B>::block, n);
    Tally total;
    Kokkos::parallel_reduce(
        Kokkos::TeamThreadRange(team, first, last), [&](int i, Tally& sum) { sum += term(i); },
        Kokkos::Sum<Tally, typename B::Memory>(total));
    Kokkos::single(Kokkos::PerTeam(team), [&]() {
      for (int k = 0; k < N; ++k) blocks(team.league_rank(), k) = total[k];
    });
  }

  KOKKOS_INLINE_FUNCTION void operator()(Blocks, const Member& team) const {
    Tally total;
    Kokkos::parallel_reduce(
        Kokkos::TeamThreadRange(team, (n + BlockSums<B>::block - 1) / BlockSums<B>::block),
        [&](int b, Tally& sum) {
          Tally block;
          for (int k = 0; k < N; ++k) block[k] = blocks(b, k);
          sum += block;
        },
        Kokkos::Sum<Tally, typename B::Memory>(total));
    Kokkos::single(Kokkos::PerTeam(team), [&]() {
      for (int k = 0; k < N; ++k) result(k) = total[k];
    });
  }
};

template <class B, int N, class Term, class Tally = Sums<N>>
void reduce(const typename B::Exec& exec, const char* label, int n, const Term& term, const BlockSums<B>& blocks,
            const Kokkos::View<double*, typename B::Memory>& result) {
  static_assert(N <= BlockSums<B>::widest);
  using Reduction = BlockReduction<B, N, Term, Tally>;
  const Reduction reduction{n, term, blocks.view(), result};
  const int teams = (n + BlockSums<B>::block - 1) / BlockSums<B>::block;
  Kokkos::parallel_for(label,
                       Kokkos::TeamPolicy<typename B::Exec, typename Reduction::Terms>(exec, teams, team_size<B>(256)),
                       reduction);
  Kokkos::parallel_for(
      label, Kokkos::TeamPolicy<typename B::Exec, typename Reduction::Blocks>(exec, 1, team_size<B>(256)), reduction);
}

}  // namespace plica
