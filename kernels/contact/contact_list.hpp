// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/launch.hpp>
#include <plica/kernels/contact/contact_records.hpp>
#include <plica/kernels/reduce.hpp>

// Lists of the items in use, and work over such lists. They are made on the device, and the host
// does not know their lengths. A list is in ascending order whatever the number of threads: blocks
// count, one item adds their counts up, blocks write.
//
//   in use     . x . . | x x . . | . . . x      blocks of a fixed length
//   counts        1         2         1
//   begins        0         1         3
//   list       1 4 5 11
namespace plica {

/// Runs work(i) for i < count(0). Where there is a `gate` and it is 0, nothing runs.
template <class B, class Work>
struct OverList {
  const double *count, *gate;
  int parts;  ///< work items: the threads of a CPU; on a GPU one for all that may be in the list
  Work work;
  KOKKOS_INLINE_FUNCTION void operator()(int part) const {
    const long long n = gate && !(*gate > 0) ? 0 : static_cast<long long>(*count);
    if constexpr (B::for_cpu) {
      for (long long i = n * part / parts; i < n * (part + 1) / parts; ++i)
        work(static_cast<int>(i));
    } else if (part < n) {
      work(part);
    }
  }
};

template <class B, class Work>
void over_list(const typename B::Exec& exec, const DeviceList<B>& list, const char* label,
               const Work& work, const Doubles<B>& gate = {}) {
  const int parts =
      B::for_cpu ? Kokkos::min(exec.concurrency(), Kokkos::max(1, list.most / 64)) : list.most;
  update_vertices<B>(exec, label, parts,
                     OverList<B, Work>{list.count.data(), gate.data(), parts, work});
}

/// Terms of the items in a list; 0 beyond its end.
template <class B, class Term>
struct TermOfList {
  const double* count;
  Term term;
  KOKKOS_INLINE_FUNCTION auto operator()(int i) const {
    return i < static_cast<int>(*count) ? term(i) : decltype(term(i)){};
  }
};

template <class B, int N, class Term, class Tally = Sums<N>>
void sum_list(const typename B::Exec& exec, const DeviceList<B>& list, const char* label,
              const Term& term, const BlockSums<B>& blocks, const Doubles<B>& result) {
  reduce<B, N, TermOfList<B, Term>, Tally>(exec, label, list.most, {list.count.data(), term},
                                           blocks, result);
}

/// Counts the items in use of each block, and sums up their entries.
template <class B, class Entries>
struct CountBlock {
  int n, block;
  Entries entries;  ///< int(int i): entries of item i; 0: not in use
  Indices<B> used, summed;
  const double* gate;  ///< nothing is in use where this is 0; null: unknown
  KOKKOS_INLINE_FUNCTION int begin(int b) const {
    return gate && !(*gate > 0) ? end(b) : b * block;
  }
  KOKKOS_INLINE_FUNCTION int end(int b) const { return Kokkos::min(n, (b + 1) * block); }
  KOKKOS_INLINE_FUNCTION void operator()(int b) const {
    int count = 0, sum = 0;
    for (int i = begin(b); i < end(b); ++i) {
      const int its = entries(i);
      count += its > 0, sum += its;
    }
    used(b) = count, summed(b) = sum;
  }
};

/// Turns the counts of the blocks into begins.
template <class B>
struct AddBlocksUp {
  int blocks;
  Indices<B> used, summed;
  Doubles<B> count;
  KOKKOS_INLINE_FUNCTION void operator()(int) const {
    int n = 0, sum = 0;
    for (int b = 0; b < blocks; ++b) {
      const int own = used(b), its = summed(b);
      used(b) = n, summed(b) = sum;
      n += own, sum += its;
    }
    count(0) = n;
  }
};

/// Calls write(j, i, begin) for the j-th item in use, which is item i and whose entries begin at
/// `begin`.
template <class B, class Entries, class Write>
struct WriteBlock {
  CountBlock<B, Entries> counted;
  Write write;
  KOKKOS_INLINE_FUNCTION void operator()(int b) const {
    int j = counted.used(b), begin = counted.summed(b);
    for (int i = counted.begin(b); i < counted.end(b); ++i)
      if (const int its = counted.entries(i); its > 0) write(j++, i, begin), begin += its;
  }
};

/// Memory in which lists are made.
template <class B>
struct ListMaker {
  static constexpr int block = 256;
  Indices<B> used, summed;  ///< [blocks]
  ListMaker() = default;
  explicit ListMaker(int items)
      : used(zeros<Indices<B>>("plica::list.used", static_cast<std::size_t>(items / block + 1))),
        summed(
            zeros<Indices<B>>("plica::list.summed", static_cast<std::size_t>(items / block + 1))) {}

  /// Makes the list of those of n items that have entries; count(0) becomes their number. Where
  /// there is a `gate` and it is 0, the list is empty.
  template <class Entries, class Write>
  void make(const typename B::Exec& exec, const char* label, int n, const Entries& entries,
            const Write& write, const Doubles<B>& count, const Doubles<B>& gate = {}) const {
    const int blocks = (n + block - 1) / block;
    const CountBlock<B, Entries> counting{n, block, entries, used, summed, gate.data()};
    update_vertices<B>(exec, label, blocks, counting);
    update_vertices<B>(exec, label, 1, AddBlocksUp<B>{blocks, used, summed, count});
    update_vertices<B>(exec, label, blocks, WriteBlock<B, Entries, Write>{counting, write});
  }
};

/// Number of entries of a slot: 1 where it is in use.
template <class B>
struct SlotInUse {
  Indices<B> near;
  KOKKOS_INLINE_FUNCTION int operator()(int r) const { return near(r); }
};
template <class B>
struct WriteSlot {
  Indices<B> list;
  KOKKOS_INLINE_FUNCTION void operator()(int j, int r, int) const { list(j) = r; }
};

/// Calls use(vertex's number, key) for each of the entries of the i-th record in the list.
template <class B, class Use>
KOKKOS_INLINE_FUNCTION void each_entry(const EmbeddedSurface<B>& surface,
                                       const ContactRecords<B>& records, int i, const Use& use) {
  const int r = records.list.item(i);
  for (int c = 0; c < 4; ++c) {
    const int p = records.point(r, c);
    if (p < 0 || records.weight(r, c) == 0) continue;
    for (int e = 0; e < 4; ++e)
      if (surface.embedding.weight(p, e) != 0)
        use(records.transpose.place(surface.embedding.source(p, e)), 16 * i + 4 * c + e);
  }
}

/// Counts the entries of each vertex; `filled` is 0 before.
template <class B>
struct CountEntries {
  EmbeddedSurface<B> surface;
  ContactRecords<B> records;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    each_entry<B>(surface, records, i,
                  [&](int place, int) { Kokkos::atomic_inc(&records.transpose.filled(place)); });
  }
};
template <class B>
struct EntriesOfVertex {
  Indices<B> filled;
  KOKKOS_INLINE_FUNCTION int operator()(int place) const { return filled(place); }
};
/// Lists a vertex; `filled` becomes the place of its next entry.
template <class B>
struct ListVertex {
  ContactTranspose<B> of;
  KOKKOS_INLINE_FUNCTION void operator()(int j, int place, int begin) const {
    of.vertices.item(j) = place;
    of.first(j) = begin, of.last(j) = begin + of.filled(place);
    of.filled(place) = begin;
  }
};
/// Writes the entries one behind the other, in any order.
template <class B>
struct PlaceEntries {
  EmbeddedSurface<B> surface;
  ContactRecords<B> records;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    each_entry<B>(surface, records, i, [&](int place, int key) {
      records.transpose.record(Kokkos::atomic_fetch_add(&records.transpose.filled(place), 1)) = key;
    });
  }
};
/// Sorts a vertex's entries, of which there are few, and adds up those of one record. It sets
/// `filled` to 0 again.
template <class B>
struct SortEntries {
  EmbeddedSurface<B> surface;
  ContactRecords<B> records;
  KOKKOS_INLINE_FUNCTION void operator()(int j) const {
    const ContactTranspose<B>& of = records.transpose;
    const int begin = of.first(j), end = of.last(j);
    of.filled(of.vertices.item(j)) = 0;
    for (int i = begin + 1; i < end; ++i) {
      const int key = of.record(i);
      int k = i;
      for (; k > begin && of.record(k - 1) > key; --k) of.record(k) = of.record(k - 1);
      of.record(k) = key;
    }
    int to = begin;
    for (int i = begin; i < end; ++i) {
      const int key = of.record(i), r = records.list.item(key / 16), c = key / 4 % 4, e = key % 4;
      const auto w = records.weight(r, c) * surface.embedding.weight(records.point(r, c), e);
      if (to > begin && of.record(to - 1) == r)
        of.weight(to - 1) += w;
      else
        of.record(to) = r, of.weight(to) = w, ++to;
    }
    of.last(j) = to;
  }
};

/// Lists the slots in use, and the vertices that have a part in them.
template <class B>
void list_contacts(const typename B::Exec& exec, const EmbeddedSurface<B>& surface,
                   const ContactRecords<B>& records, const ListMaker<B>& maker) {
  const ContactTranspose<B>& of = records.transpose;
  maker.make(exec, "plica::contact_list", records.slots(), SlotInUse<B>{records.near},
             WriteSlot<B>{records.list.item}, records.list.count);
  over_list<B>(exec, records.list, "plica::contact_entries", CountEntries<B>{surface, records});
  maker.make(exec, "plica::contact_vertices", surface.touched, EntriesOfVertex<B>{of.filled},
             ListVertex<B>{of}, of.vertices.count, records.list.count);
  over_list<B>(exec, records.list, "plica::contact_place", PlaceEntries<B>{surface, records});
  over_list<B>(exec, of.vertices, "plica::contact_sort", SortEntries<B>{surface, records});
}

}  // namespace plica
