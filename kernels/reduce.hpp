// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/exact_sum.hpp>
#include <plica/core/fields.hpp>
#include <plica/core/launch.hpp>
#include <plica/core/ranks.hpp>
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

/// Items of a reduction: terms are computed of all, and summed over those that are owned.
struct Items {
  int n;      ///< number of items
  int first;  ///< first owned one
  int last;   ///< one behind the last owned one

  /// Makes n items, all of them owned.
  KOKKOS_INLINE_FUNCTION Items(int count) : n(count), first(0), last(count) {}  // NOLINT: as an int
  /// Makes n items, of which [first, last) are owned.
  KOKKOS_INLINE_FUNCTION Items(int count, int first_owned, int last_owned)
      : n(count), first(first_owned), last(last_owned) {}
};

/// Blocks of items. Those of owned items come first; then those of the items before and after them.
///
///   items    0 ........... first ............ last ........... n
///   blocks   | own, own + 1, ... | 0 ... own - 1 | after those |
struct ItemBlocks {
  static constexpr int block = 512;  ///< items of a block, whatever the number of threads
  Items items;
  /// Items [begin, end) of a block.
  struct Range {
    int begin, end;
  };

  KOKKOS_INLINE_FUNCTION int blocks_of(int count) const { return (count + block - 1) / block; }
  KOKKOS_INLINE_FUNCTION int owned() const { return blocks_of(items.last - items.first); }
  KOKKOS_INLINE_FUNCTION int count() const {
    return owned() + blocks_of(items.first) + blocks_of(items.n - items.last);
  }
  KOKKOS_INLINE_FUNCTION Range at(int b) const {
    const int own = owned(), before = blocks_of(items.first);
    if (b < own) return part(items.first, items.last, b);
    if (b < own + before) return part(0, items.first, b - own);
    return part(items.last, items.n, b - own - before);
  }

 private:
  KOKKOS_INLINE_FUNCTION Range part(int first, int last, int b) const {
    const int begin = first + b * block;
    return {begin, Kokkos::min(begin + block, last)};
  }
};

/// Memory in which reductions keep the sums of their blocks; sized once for the longest field.
template <class B>
class BlockSums {
 public:
  static constexpr int block = ItemBlocks::block;
  static constexpr int widest = 16;
  using View = Kokkos::View<double* [widest], Kokkos::LayoutRight, typename B::Memory>;
  BlockSums() = default;
  /// @param ranks  ranks over which sums are taken; null: this process alone. All ranks then take
  ///               them in the same order
  explicit BlockSums(int items, Ranks* ranks = nullptr)
      : sums_(zeros<View>("plica::block_sums", (items + block - 1) / block + 1)), ranks_(ranks) {}
  const View& view() const { return sums_; }
  Ranks* ranks() const { return ranks_; }

 private:
  View sums_;
  Ranks* ranks_ = nullptr;
};

/// Default for the work that follows a sum in the same launch: there is none.
struct Nothing {
  KOKKOS_INLINE_FUNCTION void operator()() const {}
};

/// Computes the terms of all items, and the sums of owned blocks: blocks(b, k) = the sum of
/// term(i)[k] over the items i of block b. A thread of a CPU takes a block at a time, a team of a
/// GPU one block.
template <class B, int N, class Term, class Tally, class Then>
struct SumOfBlock {
  using Member = typename Kokkos::TeamPolicy<typename B::Exec>::member_type;
  ItemBlocks items;
  Term term;
  typename BlockSums<B>::View blocks;
  bool last;  ///< true where there is one block: its sum is the result, and `then` follows
  Then then;

  KOKKOS_INLINE_FUNCTION void keep(int b, const Tally& total) const {
    if (b >= items.owned()) return;
    for (int k = 0; k < N; ++k) blocks(b, k) = total[k];
    if (last) then();
  }
  KOKKOS_INLINE_FUNCTION void operator()(int b) const {
    const auto range = items.at(b);
    Tally total;
    for (int i = range.begin; i < range.end; ++i) total += term(i);
    keep(b, total);
  }
  KOKKOS_INLINE_FUNCTION void operator()(const Member& team) const {
    const int b = league_rank(team);
    const auto range = items.at(b);
    Tally total;
    Kokkos::parallel_reduce(
        Kokkos::TeamThreadRange(team, range.begin, range.end),
        [&](int i, Tally& sum) { sum += term(i); }, Kokkos::Sum<Tally, typename B::Memory>(total));
    Kokkos::single(Kokkos::PerTeam(team), [&]() { keep(b, total); });
  }
};

/// Digits of a sum, as a sum over the threads of a team.
template <int N>
struct DigitSums {
  std::int64_t digit[N] = {};
  KOKKOS_INLINE_FUNCTION DigitSums& operator+=(const DigitSums& other) {
    for (int i = 0; i < N; ++i) digit[i] += other.digit[i];
    return *this;
  }
};

}  // namespace plica

template <int N>
struct Kokkos::reduction_identity<plica::DigitSums<N>> {
  KOKKOS_FORCEINLINE_FUNCTION static plica::DigitSums<N> sum() { return {}; }
};

namespace plica {

/// Returns the exact sum of value(b) over b < count, see ExactSum. All threads of the team get it.
/// Threads hold a window of digits, which is wide enough for terms that differ by less than 2^100.
/// Where they differ by more, or are not finite, each thread adds up all of them.
template <class B, class Member, class Value>
KOKKOS_INLINE_FUNCTION double exact_sum(const Member& team, int count, const Value& value) {
  constexpr int window = 6, spare = 2;
  using Extent = Sums<3, 3>;  // 64 - the lowest digit, the highest one, 1 where not finite
  using Digits = DigitSums<window + spare>;
  Extent extent;
  Kokkos::parallel_reduce(
      Kokkos::TeamThreadRange(team, count),
      [&](int b, Extent& all) {
        const double x = value(b);
        Extent own;
        if (!is_finite(x)) {
          own[2] = 1;
        } else if (x != 0) {
          const int first = NumberDigits(x).first;
          own[0] = 64 - first, own[1] = first + NumberDigits::count;
        }
        all += own;
      },
      Kokkos::Sum<Extent, typename B::Memory>(extent));
  const int first = 64 - static_cast<int>(extent[0]);
  if (extent[2] > 0 || static_cast<int>(extent[1]) - first > window) {
    ExactSum sum;
    for (int b = 0; b < count; ++b) sum.add(value(b));
    return sum.take();
  }
  Digits total;
  Kokkos::parallel_reduce(
      Kokkos::TeamThreadRange(team, count),
      [&](int b, Digits& sum) {
        const NumberDigits number(value(b));
        for (int i = 0; i < window; ++i)
          for (int k = 0; k < NumberDigits::count; ++k)
            if (number.first - first + k == i) sum.digit[i] += number.digit[k];
      },
      Kokkos::Sum<Digits, typename B::Memory>(total));
  return rounded_digits(total.digit, window + spare, first);
}

/// Totals of the blocks' sums: the sum over b < count of blocks(b, k), or the maximum.
template <class B>
struct TotalOfBlocks {
  int count;
  typename BlockSums<B>::View blocks;

  KOKKOS_INLINE_FUNCTION double sum(int k) const {
    ExactSum total;
    for (int b = 0; b < count; ++b) total.add(blocks(b, k));
    return total.take();
  }
  KOKKOS_INLINE_FUNCTION double most(int k) const {
    double total = 0;
    for (int b = 0; b < count; ++b) total = total < blocks(b, k) ? blocks(b, k) : total;
    return total;
  }
  template <class Member>
  KOKKOS_INLINE_FUNCTION double sum(const Member& team, int k) const {
    return exact_sum<B>(team, count, [&](int b) { return blocks(b, k); });
  }
  template <class Member>
  KOKKOS_INLINE_FUNCTION double most(const Member& team, int k) const {
    double total = 0;
    Kokkos::parallel_reduce(
        Kokkos::TeamThreadRange(team, count),
        [&](int b, double& all) { all = all < blocks(b, k) ? blocks(b, k) : all; },
        Kokkos::Max<double, typename B::Memory>(total));
    return Kokkos::max(total, 0.0);
  }
};

/// Computes result(k) = total k of the blocks, then the work that follows.
template <class B, int N, int Maxima, class Then>
struct FinishSum {
  using Member = typename Kokkos::TeamPolicy<typename B::Exec>::member_type;
  TotalOfBlocks<B> blocks;
  Doubles<B> result;
  Then then;

  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    for (int k = 0; k < N; ++k) result(k) = k < N - Maxima ? blocks.sum(k) : blocks.most(k);
    then();
  }
  KOKKOS_INLINE_FUNCTION void operator()(const Member& team) const {
    double total[N];
    for (int k = 0; k < N; ++k)
      total[k] = k < N - Maxima ? blocks.sum(team, k) : blocks.most(team, k);
    Kokkos::single(Kokkos::PerTeam(team), [&]() {
      for (int k = 0; k < N; ++k) result(k) = total[k];
      then();
    });
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

/// Computes result(k) = sum over the blocks of all ranks, as sum_blocks() does for those of one.
/// Waits.
template <class B>
void sum_over_ranks(const typename B::Exec& exec, int count, int n, int maxima,
                    const BlockSums<B>& blocks, const Doubles<B>& result);

/// Kernel of work that needs a sum alone.
template <class Then>
struct AfterSum {
  Then then;
  KOKKOS_INLINE_FUNCTION void operator()(int) const { then(); }
};

/// Computes result(k) = sum over owned items i of term(i)[k]. Terms of the other items are computed
/// too, for what they write. The sums of blocks depend on their items alone; their total is exact
/// but for one rounding, so that it does not depend on the order of the blocks. term: Tally
/// operator()(int) const. Work that needs the result alone may follow without a launch of its own.
/// then: void operator()() const.
///
///   items    0 ............. 511 | 512 ........... 1023 | 1024 ...     in each block in order
///                  |                      |                  |
///   blocks    sum of block 0        sum of block 1         ...         in any order
///                  \_______________________|__________________/
///   result                       their sum, then `then`
///
/// On several ranks each has whole blocks, and the host adds their sums up.
template <class B, int N, class Term, class Tally = Sums<N>, class Then = Nothing>
void reduce(const typename B::Exec& exec, const char* label, const Items& items, const Term& term,
            const BlockSums<B>& blocks, const Doubles<B>& result, const Then& then = {}) {
  static_assert(N <= BlockSums<B>::widest);
  const ItemBlocks all{items};
  const int count = all.owned();
  Ranks* const ranks = blocks.ranks();
  const bool alone = !ranks && count == 1 && all.count() == 1;  // the block's sum is the result
  const typename BlockSums<B>::View whole(result.data(), 1), &parts = alone ? whole : blocks.view();
  launch_blocks<B>(exec, label, all.count(),
                   SumOfBlock<B, N, Term, Tally, Then>{all, term, parts, alone, then});
  if (alone) return;
  if (ranks) {
    sum_over_ranks<B>(exec, count, N, Tally::maxima, blocks, result);
    if constexpr (!std::is_same_v<Then, Nothing>)
      launch(label, Kokkos::RangePolicy<typename B::Exec>(exec, 0, 1), AfterSum<Then>{then});
    return;
  }
  if constexpr (std::is_same_v<Then, Nothing>)
    sum_blocks<B>(exec, label, count, N, Tally::maxima, parts, result);
  else
    launch_blocks<B>(exec, label, 1,
                     FinishSum<B, N, Tally::maxima, Then>{{count, parts}, result, then});
}

}  // namespace plica
