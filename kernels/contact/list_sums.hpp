// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/core/exact_sum.hpp>
#include <plica/kernels/contact/contact_list.hpp>
#include <plica/kernels/contact/contact_records.hpp>
#include <plica/kernels/reduce.hpp>
#include <utility>
#include <vector>

// Sums over the records in use. Which of them are neighbours in the list depends on what other
// ranks have, so that their terms are added without loss: the sum is that of any order.
//
// On several ranks the integers of sums wait until finish() adds them up over the ranks, those of a
// whole macro step in one message.
namespace plica {

/// Memory of such sums: integers of ExactSum for each part of the list.
template <class B>
class ListSums {
 public:
  static constexpr int widest = 6;
  using View = Kokkos::View<std::int64_t*, Kokkos::LayoutRight, typename B::Memory>;
  using Exec = typename B::Exec;
  ListSums() = default;
  /// @param most   largest length of the list
  /// @param ranks  ranks over which sums are taken; null: this process alone
  /// @param terms  most terms of a record that sum_long_terms() keeps
  ListSums(int most, Ranks* ranks, int terms = 0)
      : terms_(zeros<Doubles<B>>("plica::list_terms", static_cast<std::size_t>(most * terms))),
        ranks_(ranks) {
    const int workers = B::for_cpu ? typename B::Exec().concurrency() : 64;
    parts_ = Kokkos::max(1, Kokkos::min(workers, most / 64));
    integers_ = zeros<View>("plica::list_sums",
                            static_cast<std::size_t>(parts_ * widest * ExactSum::words));
  }
  int parts() const { return parts_; }
  Ranks* ranks() const { return ranks_; }
  const View& integers() const { return integers_; }
  const Doubles<B>& terms() const { return terms_; }

  /// Takes the integers of a sum of n numbers, which finish() sums over the ranks. total(exec) then
  /// computes the result from those of all ranks.
  void keep(const Exec& exec, int n, std::function<void(const Exec&)> total) const {
    const auto words = static_cast<std::size_t>(n * ExactSum::words);
    std::vector<std::int64_t> all(words * static_cast<std::size_t>(parts_));
    launch_gathered<Exec>();
    fields::download(exec, all.data(), integers_.data(), all.size() * sizeof all[0]);
    for (std::size_t i = words; i < all.size(); ++i) all[i % words] += all[i];
    waiting_.insert(waiting_.end(), all.begin(), all.begin() + static_cast<std::ptrdiff_t>(words));
    totals_.push_back({words, std::move(total)});
  }

  /// Finishes the sums that wait, in their order. All ranks have as many. Does nothing on one
  /// process.
  void finish(const Exec& exec) const {
    if (totals_.empty()) return;
    ranks_->sum(waiting_);
    const std::int64_t* from = waiting_.data();
    for (const Total& one : totals_) {
      fields::upload<typename B::Memory>(integers_.data(), from, one.words * sizeof *from);
      one.compute(exec);
      from += one.words;
    }
    waiting_.clear(), totals_.clear();
  }

 private:
  struct Total {
    std::size_t words;
    std::function<void(const Exec&)> compute;
  };
  int parts_ = 0;
  View integers_;
  Doubles<B> terms_;  ///< [records in use][terms]
  Ranks* ranks_ = nullptr;
  mutable std::vector<std::int64_t> waiting_;
  mutable std::vector<Total> totals_;
};

/// Adds the terms of a part of the list: integers(part, k). A term is computed of every record, and
/// counts where this rank owns its point.
template <class B, int N, class Term>
struct SumOfPart {
  DeviceList<B> list;
  Indices<B> counted;                         ///< see ContactRecords
  typename ContactRecords<B>::Stencil point;  ///< likewise
  Term term;
  int parts;
  typename ListSums<B>::View integers;
  KOKKOS_INLINE_FUNCTION void operator()(int part) const {
    const long long n = static_cast<long long>(list.count(0));
    ExactSum total[N];
    for (long long i = n * part / parts; i < n * (part + 1) / parts; ++i) {
      const auto one = term(static_cast<int>(i));
      const int r = list.item(static_cast<int>(i));
      if (counted.extent(0) > 0 && counted(point(r, 0)) == 0) continue;
      for (int k = 0; k < N; ++k) total[k].add(one[k]);
    }
    for (int k = 0; k < N; ++k) total[k].store(&integers((part * N + k) * ExactSum::words));
  }
};

/// Computes result(k) from the integers of all parts, then the work that follows.
template <class B, int N, class Then>
struct TotalOfParts {
  int parts;
  typename ListSums<B>::View integers;
  Doubles<B> result;
  Then then;
  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    for (int k = 0; k < N; ++k) {
      std::int64_t* const sum = &integers(k * ExactSum::words);
      for (int part = 1; part < parts; ++part)
        for (int i = 0; i < ExactSum::words; ++i)
          sum[i] += integers((part * N + k) * ExactSum::words + i);
      result(k) = ExactSum::load(sum).take();
    }
    then();
  }
};

/// Computes result(k) = sum of term(i)[k] over the records in use, of all ranks, exact but for one
/// rounding. `then`: see reduce(). On several ranks result and `then` wait for ListSums::finish().
template <class B, int N, class Term, class Then = Nothing>
void sum_records_later(const typename B::Exec& exec, const ContactRecords<B>& records,
                       const char* label, const Term& term, const ListSums<B>& memory,
                       const Doubles<B>& result, const Then& then = {}) {
  static_assert(N <= ListSums<B>::widest);
  const auto& integers = memory.integers();
  update_vertices<B>(exec, label, memory.parts(),
                     SumOfPart<B, N, Term>{records.list, records.counted, records.point, term,
                                           memory.parts(), integers});
  const auto total = [=](const typename B::Exec& on, int parts) {
    update_vertices<B>(on, label, 1, TotalOfParts<B, N, Then>{parts, integers, result, then});
  };
  if (memory.ranks())
    memory.keep(exec, N, [=](const typename B::Exec& on) { total(on, 1); });
  else
    total(exec, memory.parts());
}

/// Computes such a sum at once. On several ranks it waits.
template <class B, int N, class Term>
void sum_records(const typename B::Exec& exec, const ContactRecords<B>& records, const char* label,
                 const Term& term, const ListSums<B>& memory, const Doubles<B>& result) {
  sum_records_later<B, N>(exec, records, label, term, memory, result);
  memory.finish(exec);
}

/// Keeps the terms of a record in use.
template <class B, class Term>
struct KeepTerms {
  Term term;
  Doubles<B> terms;
  int count;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const auto one = term(i);
    for (int k = 0; k < count; ++k) terms(i * count + k) = one[k];
  }
};
template <class B, int N>
struct KeptTerms {
  Doubles<B> terms;
  KOKKOS_INLINE_FUNCTION Sums<N> operator()(int i) const {
    Sums<N> one;
    for (int k = 0; k < N; ++k) one[k] = terms(i * N + k);
    return one;
  }
};

/// Computes such a sum of terms that take long: a GPU has a thread for each record.
template <class B, int N, class Term>
void sum_long_terms(const typename B::Exec& exec, const ContactRecords<B>& records,
                    const char* label, const Term& term, const ListSums<B>& memory,
                    const Doubles<B>& result) {
  over_list<B>(exec, records.list, label, KeepTerms<B, Term>{term, memory.terms(), N});
  sum_records<B, N>(exec, records, label, KeptTerms<B, N>{memory.terms()}, memory, result);
}

}  // namespace plica
