// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <map>
#include <memory>
#include <plica/core/fields.hpp>
#include <plica/core/level_data.hpp>
#include <plica/core/rank_part.hpp>
#include <plica/core/ranks.hpp>
#include <plica/kernels/vectors.hpp>
#include <string>

// Rows of arrays that are copied from the ranks that own them. Neighbours send them packed; what
// comes from one neighbour is consecutive:
//
//   own rows     r0 r1 r2 r3 r4 r5 ...
//                 |     |  |             pack, by `sent`
//   packed       r0 | r3 r4              to rank 1 | to rank 4
//
//   array        | from ranks below | own rows | from ranks above |
namespace plica {

/// Packs rows of `width` numbers.
template <class Real, class Rows>
struct PackRows {
  const Real* from;
  Rows sent;
  Real* to;
  int width;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const Real* const row = from + static_cast<std::ptrdiff_t>(sent(i)) * width;
    Real* const packed = to + static_cast<std::ptrdiff_t>(i) * width;
    for (int k = 0; k < width; ++k) packed[k] = row[k];
  }
};

/// Exchange of rows of arrays that are laid out alike.
template <class B>
class Halo {
 public:
  using Real = typename B::Real;
  using Exec = typename B::Exec;

  /// Makes the messages for rows of each width. All ranks make them in the same order.
  /// @param what    names the rows in messages: "shares of level 0"
  /// @param widths  numbers in a row, ascending
  /// @param place   array whose rows are received in place; null: any array's may be
  Halo(Ranks& ranks, const std::string& what, HaloRows rows, const std::vector<int>& widths,
       Real* place = nullptr)
      : rows_(std::move(rows)),
        place_(place),
        staged_(!B::on_host && !ranks.device_pointers()),
        sent_(to_device<Indices<B>>("halo.sent", rows_.sent)),
        out_(field("plica::halo.out", rows_.sent.size(), widths)),
        in_(field("plica::halo.in", place ? 0 : static_cast<std::size_t>(rows_.received()),
                  widths)) {
    if (staged_)
      host_out_.resize(out_.extent(0)),
          host_in_.resize(static_cast<std::size_t>(rows_.received() * widths.back()));
    for (const int width : widths) open(ranks, what, width);
  }

  /// Receives the rows of `array` that other ranks own, of `width` numbers each. Waits.
  void exchange(const Exec& exec, Real* array, int width) const {
    exchange(exec, array, array, width);
  }
  /// Sends rows of `from`, and receives those of `array`. Waits.
  void exchange(const Exec& exec, const Real* from, Real* array, int width) const {
    const int count = static_cast<int>(rows_.sent.size());
    update_vertices<B>(exec, "plica::pack_rows", count,
                       PackRows<Real, Indices<B>>{from, sent_, out_.data(), width});
    fence(exec, "plica::halo");
    const std::size_t bytes = sizeof(Real) * static_cast<std::size_t>(width);
    if (staged_) fields::download(exec, host_out_.data(), out_.data(), rows_.sent.size() * bytes);
    Exchange& messages = *exchange_.at(width);
    messages.start();
    messages.wait();
    place_rows(exec, array, width);
  }

 private:
  HaloRows rows_;
  Real* place_;
  bool staged_;  // messages are in the host's memory, and the arrays are not
  Indices<B> sent_;
  Scalars<B> out_, in_;  // packed rows
  mutable std::vector<Real> host_out_, host_in_;
  std::map<int, std::unique_ptr<Exchange>> exchange_;  // by width

  static Scalars<B> field(const char* name, std::size_t rows, const std::vector<int>& widths) {
    return zeros<Scalars<B>>(name, rows * static_cast<std::size_t>(widths.back()));
  }

  void open(Ranks& ranks, const std::string& what, int width) {
    std::vector<Outgoing> sent;
    std::vector<Incoming> received;
    const std::size_t row = sizeof(Real) * static_cast<std::size_t>(width);
    auto* const out = reinterpret_cast<std::byte*>(staged_ ? host_out_.data() : out_.data());
    auto* const in = reinterpret_cast<std::byte*>(staged_  ? host_in_.data()
                                                  : place_ ? place_ + width * rows_.own
                                                           : in_.data());
    for (std::size_t n = 0; n < rows_.rank.size(); ++n) {
      const auto part = [&](std::byte* all, const std::vector<int>& first) {
        return std::span(all + row * static_cast<std::size_t>(first[n]),
                         row * static_cast<std::size_t>(first[n + 1] - first[n]));
      };
      if (const auto its = part(out, rows_.first_sent); !its.empty())
        sent.push_back({rows_.rank[n], its});
      if (const auto its = part(in, rows_.first_received); !its.empty())
        received.push_back({rows_.rank[n], its});
    }
    exchange_[width] = ranks.open(what, std::move(sent), std::move(received));
  }

  /// Copies what was received to the rows of an array.
  void place_rows(const Exec& exec, Real* array, int width) const {
    if (place_ && !staged_) return;
    const std::size_t row = sizeof(Real) * static_cast<std::size_t>(width);
    const auto put = [&](int first, int last, int to) {
      const std::ptrdiff_t begin = std::ptrdiff_t{first} * width;
      const std::size_t bytes = row * static_cast<std::size_t>(last - first);
      if (bytes == 0) return;
      Real* const at = array + std::ptrdiff_t{to} * width;
      if (staged_)
        fields::upload<typename B::Memory>(at, host_in_.data() + begin, bytes);
      else
        fields::copy_bytes(exec, at, in_.data() + begin, bytes);
    };
    put(0, rows_.before, 0);
    put(rows_.before, rows_.received(), rows_.before + rows_.own);
  }
};

/// Vertices of a level that several ranks share, gathered for a rank's part of the level beside it.
///
///   a field of the level   | copies | own rows | copies |
///                                      pack, by `own`
///   gathered               | from ranks below | own | from ranks above |
template <class B>
class GatheredVertices {
 public:
  using Real = typename B::Real;
  using Exec = typename B::Exec;
  static constexpr int places = 4;  ///< numbers of fields that can be gathered side by side

  /// Makes the messages. All ranks make them in the same order.
  /// @param own  local rows of the level that are the rank's own among the gathered ones
  GatheredVertices(Ranks& ranks, const std::string& what, const HaloRows& rows,
                   const std::vector<int>& own)
      : before_(rows.before),
        own_(to_device<Indices<B>>("gathered.own", own)),
        halo_(ranks, what, rows, {1, 3}) {
    const auto n = static_cast<std::size_t>(rows.received() + rows.own);
    for (Vectors<B>& field : fields_) field = zeros<Vectors<B>>("plica::gathered", n);
  }

  /// Returns a field of the level at the gathered vertices, until the next one takes its place.
  /// Waits.
  const Vectors<B>& operator()(const Exec& exec, const Vectors<B>& field, int place) const {
    const Vectors<B>& gathered = fields_[static_cast<std::size_t>(place)];
    gather(exec, field.data(), gathered.data(), 3);
    return gathered;
  }
  /// Returns such a field of numbers, in memory of its own.
  Scalars<B> operator()(const Exec& exec, const Scalars<B>& field) const {
    const auto gathered = zeros<Scalars<B>>("plica::gathered.numbers", fields_[0].extent(0));
    gather(exec, field.data(), gathered.data(), 1);
    return gathered;
  }

 private:
  int before_;      // number of gathered vertices from ranks below
  Indices<B> own_;  // local rows
  Halo<B> halo_;
  std::array<Vectors<B>, places> fields_;

  void gather(const Exec& exec, const Real* from, Real* to, int width) const {
    update_vertices<B>(
        exec, "plica::gather_own", static_cast<int>(own_.extent(0)),
        PackRows<Real, Indices<B>>{from, own_, to + std::ptrdiff_t{before_} * width, width});
    halo_.exchange(exec, from, to, width);
  }
};

/// Returns a field of a level for the level beside it: as it is, or gathered from all ranks.
template <class B>
Vectors<B> sources(const typename B::Exec& exec,
                   const std::shared_ptr<const GatheredVertices<B>>& gathered,
                   const Vectors<B>& field, int place = 0) {
  return gathered ? (*gathered)(exec, field, place) : field;
}
/// Returns a state of a level for the level beside it.
/// @param which  0 or 1: both can be in use at the same time
template <class B>
State<B> sources(const typename B::Exec& exec,
                 const std::shared_ptr<const GatheredVertices<B>>& gathered, const State<B>& state,
                 int which = 0) {
  if (!gathered) return state;
  State<B> of;
  of.u = (*gathered)(exec, state.u, 2 * which);
  of.v = (*gathered)(exec, state.v, 2 * which + 1);
  return of;
}

/// Part of a level on one of several ranks, and its messages.
template <class B>
struct RankLevel {
  Ranks* ranks;                     ///< ranks that share the level
  RankPart part;                    ///< vertices and elements that this one has
  Indices<B> number;                ///< [local vertices] number in the whole mesh
  std::unique_ptr<Halo<B>> shares;  ///< rows of `partial`, of linear elements; none: nodal ones
  /// rows of vertices, of nodal elements and with a matrix
  std::unique_ptr<Halo<B>> vertices;
  std::unique_ptr<Halo<B>> slots;  ///< slots of nodal elements
  HaloRows vertex_rows = {};       ///< rows that `vertices` exchanges
  std::vector<char> given = {};    ///< [local vertices] nonzero: no force moves the vertex
  /// patches of all tetrahedra at owned vertices, of which the rows of a matrix are assembled
  Patches<B> around_owned = {};
  std::vector<int> region_around = {};  ///< region of each of these patches
};

/// Returns the vertices of a level, of which sums are taken over those that this rank owns.
template <class B>
Items vertices_of(const LevelData<B>& level) {
  if (!level.ranks) return level.model.vertices;
  const RankPart& part = level.ranks->part;
  return {level.model.vertices, part.first_owned, part.last_owned};
}

/// Returns the model of which a level's matrix is assembled. On one of several ranks it has all
/// tetrahedra at owned vertices, as linear ones.
template <class B>
Model<B> model_of_matrix(const LevelData<B>& level) {
  Model<B> model = level.model;
  if (level.ranks) model.patches = level.ranks->around_owned;
  return model;
}

/// Returns the ranks that share a level; null: one process has all of it.
template <class B>
Ranks* ranks_of(const LevelData<B>& level) {
  return level.ranks ? level.ranks->ranks : nullptr;
}

/// Returns whether something is so on this rank or on another one that shares the level. All ranks
/// call this.
template <class B>
bool on_any_rank(const LevelData<B>& level, bool own) {
  if (!level.ranks) return own;
  double one = own ? 1 : 0;
  level.ranks->ranks->most({&one, 1});
  return one > 0;
}

/// Receives the rows of `partial` that other ranks compute; of linear elements. On one process it
/// does nothing.
template <class B>
void complete_shares(const typename B::Exec& exec, const LevelData<B>& level) {
  if (level.ranks && level.ranks->shares)
    level.ranks->shares->exchange(exec, level.partial.data(), 3);
}

/// Receives the values of a field at vertices that other ranks own; of nodal elements and with a
/// matrix. On one process it does nothing.
template <class B>
void share_vertices(const typename B::Exec& exec, const LevelData<B>& level,
                    const Vectors<B>& field) {
  if (level.ranks && level.ranks->vertices) level.ranks->vertices->exchange(exec, field.data(), 3);
}

/// Receives the numbers of slots that other ranks own, `width` for each; of nodal elements. On one
/// process it does nothing.
template <class B>
void share_slots(const typename B::Exec& exec, const LevelData<B>& level, const Scalars<B>& numbers,
                 int width) {
  if (level.ranks && level.ranks->slots) level.ranks->slots->exchange(exec, numbers.data(), width);
}

}  // namespace plica
