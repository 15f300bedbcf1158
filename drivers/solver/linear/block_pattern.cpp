// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/solver/linear/block_pattern.hpp>
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
    BlockMatrix<B>& A = made.matrix;
    A.rows = vertices_;
    A.first = to_device<Indices<B>>("matrix.first", first_);
    A.column = to_device<Indices<B>>("matrix.column", column_);
    A.diagonal = to_device<Indices<B>>("matrix.diagonal", diagonal_);
    A.value = zeros<Blocks9<B>>("plica::matrix.value", column_.size() + 1);
    PatchPairs<B>& P = made.pairs;
    P.shares = first_share_.back();
    P.first_pair = to_device<Indices<B>>("pairs.first_pair", first_pair_);
    P.first_shared = to_device<Indices<B>>("pairs.first_shared", first_shared_);
    P.first_slot = to_device<Indices<B>>("pairs.first_slot", first_slot_);
    P.first_turned = to_device<Indices<B>>("pairs.first_turned", first_turned_);
    P.slot = to_device<decltype(P.slot)>("pairs.slot", slot_);
    P.upper = to_device<Indices<B>>("pairs.upper", upper_);
    P.lower = to_device<Indices<B>>("pairs.lower", lower_);
    P.first_share = to_device<Indices<B>>("pairs.first_share", first_share_);
    P.shared_upper = to_device<Indices<B>>("pairs.shared_upper", shared_upper_);
    P.shared_lower = to_device<Indices<B>>("pairs.shared_lower", shared_lower_);
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
  std::vector<int> patches_of_;     // [blocks of the matrix] i < j: how many have the pair
  std::vector<int> first_pair_{0}, first_shared_, first_slot_{0}, first_turned_, upper_, lower_;
  std::vector<std::uint16_t> slot_;
  std::vector<int> first_, column_, diagonal_, first_share_{0}, shared_upper_, shared_lower_;

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
    first_.push_back(0);
    for (int a = 0; a < vertices_; ++a) {
      std::vector<int>& row = rows[index_of(a)];
      std::sort(row.begin(), row.end());
      row.erase(std::unique(row.begin(), row.end()), row.end());
      diagonal_.push_back(first_.back() + static_cast<int>(std::lower_bound(row.begin(), row.end(), a) - row.begin()));
      column_.insert(column_.end(), row.begin(), row.end());
      first_.push_back(static_cast<int>(column_.size()));
    }
  }

  /// Of block (a, b) in the matrix; -1 where row a is empty.
  int place_of(int a, int b) const {
    if (!is_free(a)) return -1;
    const auto row = column_.begin() + first_[index_of(a)];
    return static_cast<int>(std::lower_bound(row, column_.begin() + first_[index_of(a + 1)], b) - column_.begin());
  }
  /// Of one of the two blocks of a pair.
  int place_of(const PairOfPatch& pair) const {
    return is_free(pair.first) ? place_of(pair.first, pair.second) : place_of(pair.second, pair.first);
  }

  void count_patches() {
    patches_of_.resize(column_.size());
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
    std::vector<int> first_share(column_.size(), -1);
    upper_.resize(pair_.size()), lower_.resize(pair_.size());
    for (std::size_t s = 0; s < pair_.size(); ++s) {
      const PairOfPatch& pair = pair_[s];
      const int block = place_of(pair), upper = place_of(pair.first, pair.second);
      const int lower = place_of(pair.second, pair.first);
      if (patches_of_[index_of(block)] == 1) {
        upper_[s] = upper, lower_[s] = lower;
        continue;
      }
      int& share = first_share[index_of(block)];
      if (share < 0) {
        share = first_share_.back();
        shared_upper_.push_back(upper), shared_lower_.push_back(lower);
        first_share_.push_back(share + patches_of_[index_of(block)]);
      }
      upper_[s] = share++, lower_[s] = -1;
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
