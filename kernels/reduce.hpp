// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/backend.hpp>

namespace plica {

/// N sums at once, always in double.
template <int N>
struct Sums {
  double value[N] = {};
  KOKKOS_INLINE_FUNCTION double& operator[](int i) { return value[i]; }
  KOKKOS_INLINE_FUNCTION double operator[](int i) const { return value[i]; }
  KOKKOS_INLINE_FUNCTION Sums& operator+=(const Sums& other) {
    for (int i = 0; i < N; ++i) value[i] += other.value[i];
    return *this;
  }
};

}  // namespace plica

template <int N>
struct Kokkos::reduction_identity<plica::Sums<N>> {
  KOKKOS_FORCEINLINE_FUNCTION static plica::Sums<N> sum() { return {}; }
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

/// result(k) = sum over i < n of term(i)[k]; the order of additions depends on n alone. term: Sums<N> operator()(int) const.
template <class B, int N, class Term>
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
    Sums<N> total;
    Kokkos::parallel_reduce(
        Kokkos::TeamThreadRange(team, first, last), [&](int i, Sums<N>& sum) { sum += term(i); },
        Kokkos::Sum<Sums<N>, typename B::Memory>(total));
    Kokkos::single(Kokkos::PerTeam(team), [&]() {
      for (int k = 0; k < N; ++k) blocks(team.league_rank(), k) = total[k];
    });
  }

  KOKKOS_INLINE_FUNCTION void operator()(Blocks, const Member& team) const {
    Sums<N> total;
    Kokkos::parallel_reduce(
        Kokkos::TeamThreadRange(team, (n + BlockSums<B>::block - 1) / BlockSums<B>::block),
        [&](int b, Sums<N>& sum) {
          for (int k = 0; k < N; ++k) sum[k] += blocks(b, k);
        },
        Kokkos::Sum<Sums<N>, typename B::Memory>(total));
    Kokkos::single(Kokkos::PerTeam(team), [&]() {
      for (int k = 0; k < N; ++k) result(k) = total[k];
    });
  }
};

template <class B, int N, class Term>
void reduce(const typename B::Exec& exec, const char* label, int n, const Term& term, const BlockSums<B>& blocks,
            const Kokkos::View<double*, typename B::Memory>& result) {
  static_assert(N <= BlockSums<B>::widest);
  using Reduction = BlockReduction<B, N, Term>;
  const Reduction reduction{n, term, blocks.view(), result};
  const int teams = (n + BlockSums<B>::block - 1) / BlockSums<B>::block;
  Kokkos::parallel_for(label,
                       Kokkos::TeamPolicy<typename B::Exec, typename Reduction::Terms>(exec, teams, team_size<B>(256)),
                       reduction);
  Kokkos::parallel_for(
      label, Kokkos::TeamPolicy<typename B::Exec, typename Reduction::Blocks>(exec, 1, team_size<B>(256)), reduction);
}

}  // namespace plica
