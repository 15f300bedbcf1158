// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/row_ranges.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/linear/block_pattern.hpp>
#include <plica/drivers/linear/host_pattern.hpp>
#include <plica/kernels/elastic/elastic_blocks.hpp>
#include <tuple>
#include <utility>

namespace plica {

namespace {

/// Block of one element for a pair of vertices, as one number to sort by.
/// It has the two vertices' numbers in the patch, first the vertex with the lower number in the
/// mesh; then whether the block is transposed for this order; then its slot among the element
/// blocks of the patch.
struct ElementPair {
  std::uint64_t key;

  ElementPair(int first, int second, bool turned, int slot)
      : key(std::uint64_t(first) << 48 | std::uint64_t(second) << 32 | std::uint64_t(turned) << 16 |
            std::uint64_t(slot)) {}
  auto operator<=>(const ElementPair&) const = default;
  int first() const { return static_cast<int>(key >> 48); }
  int second() const { return static_cast<int>(key >> 32 & 0xffff); }
  bool turned() const { return (key >> 16 & 1) != 0; }
  std::uint16_t slot() const { return static_cast<std::uint16_t>(key); }
};

/// Pair of a patch's vertices, by their numbers in the mesh, and the range of its element blocks.
/// Blocks [begin, straight) are added as they are, blocks [straight, end) transposed.
struct PairOfPatch {
  int first, second;
  std::size_t begin, straight, end;
  int place = -1;  ///< place of the pair's block in the matrix
};

/// Pairs of vertices of one patch.
struct PairsOfPatch {
  std::vector<std::uint16_t> slot;  ///< slots of the element blocks, pair by pair
  std::vector<PairOfPatch> pair;
};

template <class B>
class PatternBuilder {
 public:
  PatternBuilder(const Model<B>& model, const Items& rows)
      : vertices_(model.vertices),
        is_free_(free_or_following(model, rows)),
        first_pack_(on_host(model.patches.first_pack)),
        first_vertex_(on_host(model.patches.first_vertex)),
        vertex_(on_host(model.patches.vertex)),
        corner_(on_host(model.patches.corner)),
        element_(on_host(model.patches.element)),
        patch_(index_of(model.patches.count)) {
    for_all_patches([&](int p) { find_pairs(p); });
    make_rows();
    for_all_patches([&](int p) {
      for (PairOfPatch& pair : patch_[index_of(p)].pair) pair.place = place_of(pair);
    });
    count_patches();
    for_all_patches([&](int p) { sort_pairs(p); });
    for (const PairsOfPatch& patch : patch_) add_patch(patch);
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
  // [vertices] 1 where forces move an owned vertex, or it follows others
  std::vector<char> is_free_;
  Host<Indices<B>> first_pack_, first_vertex_, vertex_;
  Host<decltype(Patches<B>::corner)> corner_;
  Host<Indices<B>> element_;
  std::vector<PairsOfPatch> patch_;
  HostPattern pattern_;
  std::vector<int> patches_of_;  // [stored blocks] number of patches that have the pair
  // [stored blocks] next share of a block that several patches have; -1: none yet
  std::vector<int> share_of_;
  std::vector<int> first_pair_{0}, first_shared_, first_slot_{0}, first_turned_, place_;
  std::vector<std::uint16_t> slot_;
  std::vector<int> first_share_{0}, shared_place_;

  static std::vector<char> free_or_following(const Model<B>& model, const Items& rows) {
    const auto inverse_mass = on_host(model.inverse_mass);
    const auto follower = on_host(model.followers.place.target);
    std::vector<char> free;
    for (int a = 0; a < model.vertices; ++a)
      free.push_back(inverse_mass(a) > 0 && a >= rows.first && a < rows.last);
    for (int i = 0; i < model.followers.place.rows; ++i) free[index_of(follower(i))] = 1;
    return free;
  }
  bool is_free(int a) const { return is_free_[index_of(a)] != 0; }

  template <class Work>
  void for_all_patches(const Work& work) {
    for_row_ranges(patch_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) work(static_cast<int>(p));
    });
  }

  int vertex_of(int patch, int local) const { return vertex_(first_vertex_(patch) + local); }

  void find_pairs(int p) {
    std::vector<ElementPair> blocks;
    for (int q = first_pack_(p); q < first_pack_(p + 1); ++q)
      for (int l = 0; l < B::lanes; ++l)
        if (element_(q * B::lanes + l) >= 0) add_element(p, q, l, blocks);
    std::ranges::sort(blocks);
    auto& [slot, pair] = patch_[index_of(p)];
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const ElementPair& b = blocks[i];
      if (i == 0 || b.first() != blocks[i - 1].first() || b.second() != blocks[i - 1].second())
        pair.push_back({vertex_of(p, b.first()), vertex_of(p, b.second()), i, i, i});
      pair.back().end = i + 1;
      if (!b.turned()) pair.back().straight = i + 1;
      slot.push_back(b.slot());
    }
  }

  void add_element(int patch, int pack, int lane, std::vector<ElementPair>& blocks) const {
    const int e = (pack - first_pack_(patch)) * B::lanes + lane;
    for (int p = 0; p < 4; ++p)
      for (int q = p + 1; q < 4; ++q) {
        const int i = corner_(pack, p, lane), j = corner_(pack, q, lane);
        const int a = vertex_of(patch, i), b = vertex_of(patch, j);
        if (!is_free(a) && !is_free(b)) continue;
        const int slot = element_numbers * e + 9 * element_block(p, q);
        blocks.emplace_back(a < b ? i : j, a < b ? j : i, a > b, slot);
      }
  }

  void make_rows() {
    std::vector<std::vector<int>> rows(index_of(vertices_));
    for (int a = 0; a < vertices_; ++a) rows[index_of(a)].push_back(a);
    for (const PairsOfPatch& patch : patch_)
      for (const PairOfPatch& pair : patch.pair) {
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

  /// Returns the place of a pair's block in the matrix.
  int place_of(const PairOfPatch& pair) const {
    const auto [a, b] = is_free(pair.first) ? std::pair(pair.first, pair.second)
                                            : std::pair(pair.second, pair.first);
    const auto row = pattern_.column.begin() + pattern_.first[index_of(a)];
    const auto block = std::lower_bound(row, row + pattern_.blocks_of_row(a), b);
    return pattern_.place[static_cast<std::size_t>(block - pattern_.column.begin())];
  }

  void count_patches() {
    patches_of_.resize(index_of(pattern_.stored));
    share_of_.resize(index_of(pattern_.stored), -1);
    for (const PairsOfPatch& patch : patch_)
      for (const PairOfPatch& pair : patch.pair) ++patches_of_[index_of(pair.place)];
  }

  bool is_shared(const PairOfPatch& pair) const { return patches_of_[index_of(pair.place)] > 1; }

  /// Sorts a patch's pairs: first those of this patch alone, then those that other patches have
  /// too. Within each part they are sorted by their number of blocks, so that a processor predicts
  /// where sums end.
  void sort_pairs(int p) {
    std::ranges::sort(patch_[index_of(p)].pair, {}, [&](const PairOfPatch& a) {
      return std::tuple(is_shared(a), a.straight - a.begin, a.end - a.begin, a.first, a.second);
    });
  }

  /// Adds the pairs of a patch. Shares of a block follow each other in the order of the patches.
  void add_patch(const PairsOfPatch& patch) {
    int own = 0;
    for (const PairOfPatch& pair : patch.pair) {
      own += !is_shared(pair);
      place_.push_back(is_shared(pair) ? next_share(pair.place) : pair.place);
      first_turned_.push_back(first_slot_.back() + static_cast<int>(pair.straight - pair.begin));
      first_slot_.push_back(first_slot_.back() + static_cast<int>(pair.end - pair.begin));
      for (std::size_t i = pair.begin; i < pair.end; ++i) slot_.push_back(patch.slot[i]);
    }
    first_shared_.push_back(first_pair_.back() + own);
    first_pair_.push_back(static_cast<int>(place_.size()));
  }

  int next_share(int place) {
    int& share = share_of_[index_of(place)];
    if (share < 0) {
      share = first_share_.back();
      shared_place_.push_back(place);
      first_share_.push_back(share + patches_of_[index_of(place)]);
    }
    return share++;
  }
};

}  // namespace

template <class B>
BlockPattern<B> block_pattern(const Model<B>& model, const Items& rows) {
  return PatternBuilder<B>(model, rows).finish();
}

template <class B>
RowMatrix motion_of_free(const Model<B>& model) {
  const auto inverse_mass = on_host(model.inverse_mass);
  const Transfer<B>& place = model.followers.place;
  const auto target = on_host(place.target);
  const auto source = on_host(place.source);
  const auto weight = on_host(place.weight);
  std::vector<std::vector<std::pair<int, double>>> rows(index_of(model.vertices));
  for (int a = 0; a < model.vertices; ++a)
    if (inverse_mass(a) > 0) rows[index_of(a)] = {{a, 1.0}};
  for (int i = 0; i < place.rows; ++i) {
    auto& row = rows[index_of(target(i))];
    for (int c = 0; c < 4; ++c)
      if (weight(i, c) != 0 && inverse_mass(source(i, c)) > 0)
        row.emplace_back(source(i, c), static_cast<double>(weight(i, c)));
    std::ranges::sort(row);
  }
  return matrix_of_rows(rows, model.vertices);
}

#define PLICA_INSTANTIATE(Real, Exec)                                            \
  template BlockPattern<Backend<Real, Exec>> block_pattern<Backend<Real, Exec>>( \
      const Model<Backend<Real, Exec>>&, const Items&);                          \
  template RowMatrix motion_of_free<Backend<Real, Exec>>(const Model<Backend<Real, Exec>>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
