// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>
#include <plica/core/launch.hpp>
#include <type_traits>

namespace plica {

/// N sums, always in double. The last `Maxima` of them are maxima instead, of values not below 0.
template <int N, int Maxima = 0>
struct Sums {
  static constexpr int maxima = Maxima;
  double value[N] = {};
  KOKKOS_INLINE_FUNCTION double& operator[](int i) { return value[i]; }
  KOKKOS_INLINE_FUNCTION double operator[](int i) const { return value[i]; }
  KOKKOS_INLINE_FUNCTION Sums& operator+=(const Sums& other) {
    for (int i = 0; i < N - Maxima; ++i) value[i] += other.value[i];
    for (int i = N - Maxima; i < N; ++i)
      value[i] = value[i] < other.value[i] ? other.value[i] : value[i];
    return *this;
  }
};

}  // namespace plica

template <int N, int Maxima>
struct Kokkos::reduction_identity<plica::Sums<N, Maxima>> {
  KOKKOS_FORCEINLINE_FUNCTION static plica::Sums<N, Maxima> sum() { return {}; }
};

namespace plica {

/// Memory in which reductions keep the sums of their blocks; sized once for the longest field.
template <class B>
class BlockSums {
 public:
  static constexpr int block = 512;  ///< items added up by one team, whatever the number of threads
  static constexpr int widest = 16;
  using View = Kokkos::View<double* [widest], Kokkos::LayoutRight, typename B::Memory>;
  BlockSums() = default;
  explicit BlockSums(int items)
      : sums_(zeros<View>("plica::block_sums", (items + block - 1) / block + 1)) {}
  const View& view() const { return sums_; }

 private:
  View sums_;
};

/// Default for the work that follows a sum in the same launch: there is none.
struct Nothing {
  KOKKOS_INLINE_FUNCTION void operator()() const {}
};

/// Computes the sums of blocks: blocks(b, k) = the sum of term(i)[k] over the items i of block b. A
/// thread of a CPU takes a block at a time, a team of a GPU one block.
template <class B, int N, class Term, class Tally, class Then>
struct SumOfBlock {
  using Member = typename Kokkos::TeamPolicy<typename B::Exec>::member_type;
  int n, block;
  Term term;
  typename BlockSums<B>::View blocks;
  bool last;  ///< true where this sum is the result, and `then` follows
  Then then;

  KOKKOS_INLINE_FUNCTION int begin(int b) const { return b * block; }
  KOKKOS_INLINE_FUNCTION int end(int b) const { return Kokkos::min(begin(b) + block, n); }
  KOKKOS_INLINE_FUNCTION void keep(int b, const Tally& total) const {
    for (int k = 0; k < N; ++k) blocks(b, k) = total[k];
    if (last) then();
  }
  KOKKOS_INLINE_FUNCTION void operator()(int b) const {
    Tally total;
    for (int i = begin(b); i < end(b); ++i) total += term(i);
    keep(b, total);
  }
  KOKKOS_INLINE_FUNCTION void operator()(const Member& team) const {
    const int b = league_rank(team);
    Tally total;
    Kokkos::parallel_reduce(
        Kokkos::TeamThreadRange(team, begin(b), end(b)), [&](int i, Tally& sum) { sum += term(i); },
        Kokkos::Sum<Tally, typename B::Memory>(total));
    Kokkos::single(Kokkos::PerTeam(team), [&]() { keep(b, total); });
  }
};

/// Sums of block b, as the terms of a sum over the blocks.
template <class B, int N, class Tally>
struct BlockTotal {
  typename BlockSums<B>::View blocks;
  KOKKOS_INLINE_FUNCTION Tally operator()(int b) const {
    Tally total;
    for (int k = 0; k < N; ++k) total[k] = blocks(b, k);
    return total;
  }
};

template <class B, class Sum>
void launch_blocks(const typename B::Exec& exec, const char* label, int count, const Sum& sum) {
  using Exec = typename B::Exec;
  if constexpr (B::for_cpu)
    launch(label, Kokkos::RangePolicy<Exec>(exec, 0, count), sum);
  else
    launch(label, Kokkos::TeamPolicy<Exec>(exec, count, team_size<B>(256)), sum);
}

/// Computes result(k) = sum over b < count of blocks(b, k) for k < n. The last `maxima` of them are
/// the maxima over the blocks instead.
template <class B>
void sum_blocks(const typename B::Exec& exec, const char* label, int count, int n, int maxima,
                const typename BlockSums<B>::View& blocks, const Doubles<B>& result);

/// Computes result(k) = sum over i < n of term(i)[k]. The order of additions depends on n alone.
/// term: Tally operator()(int) const. Work that needs the result alone may follow without a launch
/// of its own. then: void operator()() const.
///
///   items    0 ............. 511 | 512 ........... 1023 | 1024 ...     in each block in order
///                  |                      |                  |
///   blocks    sum of block 0        sum of block 1         ...         in order
///                  \_______________________|__________________/
///   result                       their sum, then `then`
template <class B, int N, class Term, class Tally = Sums<N>, class Then = Nothing>
void reduce(const typename B::Exec& exec, const char* label, int n, const Term& term,
            const BlockSums<B>& blocks, const Doubles<B>& result, const Then& then = {}) {
  static_assert(N <= BlockSums<B>::widest);
  constexpr int block = BlockSums<B>::block;
  const int count = (n + block - 1) / block;
  const bool alone = count == 1;  // the block's sum is the result
  const typename BlockSums<B>::View whole(result.data(), 1), &parts = alone ? whole : blocks.view();
  launch_blocks<B>(exec, label, count,
                   SumOfBlock<B, N, Term, Tally, Then>{n, block, term, parts, alone, then});
  if (alone) return;
  if constexpr (std::is_same_v<Then, Nothing>)
    sum_blocks<B>(exec, label, count, N, Tally::maxima, parts, result);
  else
    launch_blocks<B>(exec, label, 1,
                     SumOfBlock<B, N, BlockTotal<B, N, Tally>, Tally, Then>{
                         count, count, {parts}, whole, true, then});
}

}  // namespace plica
