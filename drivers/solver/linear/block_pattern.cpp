// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/solver/linear/block_pattern.hpp>
#include <plica/drivers/solver/linear/host_pattern.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/drivers/solver/spaces/row_ranges.hpp>
#include <plica/kernels/elastic/elastic_blocks.hpp>
#include <tuple>
#include <utility>

namespace plica {

namespace {

/// One block of one element: the pair of vertices it is for, first < second, whether it is for them turned round, and where it stands
/// among the patch's element blocks.
struct ElementPair {
  int first, second, turned, slot;
  auto operator<=>(const ElementPair&) const = default;
};

/// A pair of a patch's vertices: its element blocks [begin, straight) as they are, [straight, end) turned.
struct PairOfPatch {
  int first, second;
  std::size_t begin, straight, end;
};

template <class B>
class PatternBuilder {
 public:
  explicit PatternBuilder(const Model<B>& model)
      : vertices_(model.vertices),
        inverse_mass_(on_host(model.inverse_mass)),
        first_pack_(on_host(model.patches.first_pack)),
        first_vertex_(on_host(model.patches.first_vertex)),
        vertex_(on_host(model.patches.vertex)),
        corner_(on_host(model.patches.corner)),
        element_(on_host(model.patches.element)) {
    for (int p = 0; p < model.patches.count; ++p) find_pairs(p);
    make_rows();
    count_patches();
    for (int p = 0; p < model.patches.count; ++p) sort_pairs(p);
    place_pairs();
  }

  BlockPattern<B> finish() const {
    BlockPattern<B> made;
    made.matrix = block_matrix<B>("matrix", pattern_);
    PatchPairs<B>& P = made.pairs;
    P.shares = first_share_.back();
    P.first_pair = to_device<Indices<B>>("pairs.first_pair", first_pair_);
    P.first_shared = to_device<Indices<B>>("pairs.first_shared", first_shared_);
    P.first_slot = to_device<Indices<B>>("pairs.first_slot", first_slot_);
    P.first_turned = to_device<Indices<B>>("pairs.first_turned", first_turned_);
    P.slot = to_device<decltype(P.slot)>("pairs.slot", slot_);
    P.place = to_device<Indices<B>>("pairs.place", place_);
    P.first_share = to_device<Indices<B>>("pairs.first_share", first_share_);
    P.shared_place = to_device<Indices<B>>("pairs.shared_place", shared_place_);
    return made;
  }

 private:
  template <class View>
  using Host = decltype(on_host(std::declval<View>()));
  int vertices_;
  Host<Scalars<B>> inverse_mass_;
  Host<Indices<B>> first_pack_, first_vertex_, vertex_;
  Host<decltype(Patches<B>::corner)> corner_;
  Host<Indices<B>> element_;
  std::vector<ElementPair> block_;  // of elements, patch by patch, pair by pair
  std::vector<PairOfPatch> pair_;   // patch by patch
  HostPattern pattern_;
  std::vector<int> patches_of_;  // [blocks that are stored] how many have the pair
  std::vector<int> first_pair_{0}, first_shared_, first_slot_{0}, first_turned_, place_;
  std::vector<std::uint16_t> slot_;
  std::vector<int> first_share_{0}, shared_place_;

  bool is_free(int a) const { return inverse_mass_(a) > 0; }

  void find_pairs(int p) {
    const std::size_t begin = block_.size();
    for (int q = first_pack_(p); q < first_pack_(p + 1); ++q)
      for (int l = 0; l < B::lanes; ++l)
        if (element_(q * B::lanes + l) >= 0) add_element(p, q, l);
    std::sort(block_.begin() + static_cast<std::ptrdiff_t>(begin), block_.end());
    for (std::size_t i = begin; i < block_.size(); ++i) {
      const ElementPair& b = block_[i];
      if (i == begin || b.first != pair_.back().first || b.second != pair_.back().second)
        pair_.push_back({b.first, b.second, i, i, i});
      pair_.back().end = i + 1;
      if (b.turned == 0) pair_.back().straight = i + 1;
    }
    first_pair_.push_back(static_cast<int>(pair_.size()));
  }

  void add_element(int patch, int pack, int lane) {
    const int e = (pack - first_pack_(patch)) * B::lanes + lane;
    for (int p = 0; p < 4; ++p)
      for (int q = p + 1; q < 4; ++q) {
        const int a = vertex_(first_vertex_(patch) + corner_(pack, p, lane));
        const int b = vertex_(first_vertex_(patch) + corner_(pack, q, lane));
        if (!is_free(a) && !is_free(b)) continue;
        block_.push_back(
            {std::min(a, b), std::max(a, b), a > b ? 1 : 0, element_numbers * e + 9 * element_block(p, q)});
      }
  }

  void make_rows() {
    std::vector<std::vector<int>> rows(index_of(vertices_));
    for (int a = 0; a < vertices_; ++a) rows[index_of(a)].push_back(a);
    for (const PairOfPatch& pair : pair_) {
      if (is_free(pair.first)) rows[index_of(pair.first)].push_back(pair.second);
      if (is_free(pair.second)) rows[index_of(pair.second)].push_back(pair.first);
    }
    std::vector<int> first{0}, column;
    for (std::vector<int>& row : rows) {
      std::sort(row.begin(), row.end());
      column.insert(column.end(), row.begin(), std::unique(row.begin(), row.end()));
      first.push_back(static_cast<int>(column.size()));
    }
    pattern_ = {std::move(first), std::move(column)};
  }

  /// Of a pair's block in the matrix.
  int place_of(const PairOfPatch& pair) const {
    const auto [a, b] = is_free(pair.first) ? std::pair(pair.first, pair.second) : std::pair(pair.second, pair.first);
    const auto row = pattern_.column.begin() + pattern_.first[index_of(a)];
    const auto block = std::lower_bound(row, row + pattern_.blocks_of_row(a), b);
    return pattern_.place[static_cast<std::size_t>(block - pattern_.column.begin())];
  }

  void count_patches() {
    patches_of_.resize(index_of(pattern_.stored));
    for (const PairOfPatch& pair : pair_) ++patches_of_[index_of(place_of(pair))];
  }

  /// Those that other patches have too last; then by how many blocks they have, so that a processor foresees the ends of their sums.
  void sort_pairs(int p) {
    const auto first = pair_.begin() + first_pair_[index_of(p)], last = pair_.begin() + first_pair_[index_of(p + 1)];
    const auto key = [&](const PairOfPatch& a) {
      return std::tuple(patches_of_[index_of(place_of(a))] > 1, a.straight - a.begin, a.end - a.begin, a.first,
                        a.second);
    };
    std::sort(first, last, [&](const PairOfPatch& a, const PairOfPatch& b) { return key(a) < key(b); });
    const auto shared =
        std::find_if(first, last, [&](const PairOfPatch& a) { return patches_of_[index_of(place_of(a))] > 1; });
    first_shared_.push_back(static_cast<int>(shared - pair_.begin()));
    for (auto pair = first; pair != last; ++pair) {
      for (std::size_t i = pair->begin; i < pair->end; ++i) slot_.push_back(static_cast<std::uint16_t>(block_[i].slot));
      first_turned_.push_back(first_slot_.back() + static_cast<int>(pair->straight - pair->begin));
      first_slot_.push_back(static_cast<int>(slot_.size()));
    }
  }

  /// Shares of a block follow each other in the order of the patches.
  void place_pairs() {
    std::vector<int> first_share(patches_of_.size(), -1);
    for (const PairOfPatch& pair : pair_) {
      const int place = place_of(pair);
      if (patches_of_[index_of(place)] == 1) {
        place_.push_back(place);
        continue;
      }
      int& share = first_share[index_of(place)];
      if (share < 0) {
        share = first_share_.back();
        shared_place_.push_back(place);
        first_share_.push_back(share + patches_of_[index_of(place)]);
      }
      place_.push_back(share++);
    }
  }
};

}  // namespace

template <class B>
BlockPattern<B> block_pattern(const Model<B>& model) {
  return PatternBuilder<B>(model).finish();
}

#define PLICA_INSTANTIATE(Real, Exec) \
  template BlockPattern<Backend<Real, Exec>> block_pattern<Backend<Real, Exec>>(const Model<Backend<Real, Exec>>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
