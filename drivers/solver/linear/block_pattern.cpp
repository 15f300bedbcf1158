// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <plica/drivers/solver/linear/block_pattern.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/kernels/elastic/elastic_blocks.hpp>
#include <utility>

namespace plica {

namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// One block of one element: the pair of vertices it is for, first <= second, and whether it is for them turned round.
struct ElementPair {
  int first, second, turned, slot;
  auto operator<=>(const ElementPair&) const = default;
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
    for (int p = 0; p < model.patches.count; ++p) add_patch(p);
    make_rows();
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
  std::vector<std::array<int, 2>> pair_;  // of patch pairs, patch by patch
  std::vector<int> first_pair_{0}, first_slot_{0}, first_turned_, upper_, lower_;
  std::vector<std::uint16_t> slot_;
  std::vector<int> first_, column_, diagonal_, first_share_{0}, shared_upper_, shared_lower_;

  void add_patch(int p) {
    std::vector<ElementPair> blocks;
    for (int q = first_pack_(p); q < first_pack_(p + 1); ++q)
      for (int l = 0; l < B::lanes; ++l)
        if (element_(q * B::lanes + l) >= 0) add_element(p, q, l, blocks);
    std::sort(blocks.begin(), blocks.end());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const ElementPair& b = blocks[i];
      if (i == 0 || b.first != blocks[i - 1].first || b.second != blocks[i - 1].second) {
        pair_.push_back({b.first, b.second});
        if (pair_.size() > 1) first_slot_.push_back(static_cast<int>(slot_.size()));
        first_turned_.push_back(static_cast<int>(slot_.size()));
      }
      slot_.push_back(static_cast<std::uint16_t>(b.slot));
      if (b.turned == 0) first_turned_.back() = static_cast<int>(slot_.size());
    }
    first_pair_.push_back(static_cast<int>(pair_.size()));
  }

  void add_element(int patch, int pack, int lane, std::vector<ElementPair>& blocks) const {
    const int e = (pack - first_pack_(patch)) * B::lanes + lane;
    for (int p = 0; p < 4; ++p)
      for (int q = p; q < 4; ++q) {
        const int a = vertex_(first_vertex_(patch) + corner_(pack, p, lane));
        const int b = vertex_(first_vertex_(patch) + corner_(pack, q, lane));
        if (!(inverse_mass_(a) > 0) || !(inverse_mass_(b) > 0)) continue;
        blocks.push_back({std::min(a, b), std::max(a, b), a > b ? 1 : 0, 10 * e + element_block(p, q)});
      }
  }

  void make_rows() {
    first_slot_.push_back(static_cast<int>(slot_.size()));
    std::vector<std::vector<int>> rows(at(vertices_));
    for (int a = 0; a < vertices_; ++a) rows[at(a)].push_back(a);
    for (const auto& [a, b] : pair_)
      if (a != b) rows[at(a)].push_back(b), rows[at(b)].push_back(a);
    first_.push_back(0);
    for (int a = 0; a < vertices_; ++a) {
      std::vector<int>& row = rows[at(a)];
      std::sort(row.begin(), row.end());
      row.erase(std::unique(row.begin(), row.end()), row.end());
      diagonal_.push_back(first_.back() + static_cast<int>(std::lower_bound(row.begin(), row.end(), a) - row.begin()));
      column_.insert(column_.end(), row.begin(), row.end());
      first_.push_back(static_cast<int>(column_.size()));
    }
  }

  int place_of(int a, int b) const {
    const auto row = column_.begin() + first_[at(a)];
    return static_cast<int>(std::lower_bound(row, column_.begin() + first_[at(a + 1)], b) - column_.begin());
  }

  void place_pairs() {
    std::vector<std::vector<int>> patch_pairs(column_.size());  // of the block (i, j), i <= j
    for (std::size_t s = 0; s < pair_.size(); ++s)
      patch_pairs[at(place_of(pair_[s][0], pair_[s][1]))].push_back(static_cast<int>(s));
    upper_.resize(pair_.size()), lower_.resize(pair_.size());
    int shares = 0;
    for (int a = 0; a < vertices_; ++a)
      for (int upper = diagonal_[at(a)]; upper < first_[at(a + 1)]; ++upper) {
        const std::vector<int>& from = patch_pairs[at(upper)];
        const int lower = place_of(column_[at(upper)], a);
        if (from.size() == 1) upper_[at(from[0])] = upper, lower_[at(from[0])] = lower;
        if (from.size() == 1) continue;
        for (const int s : from) upper_[at(s)] = shares++, lower_[at(s)] = -1;
        shared_upper_.push_back(upper), shared_lower_.push_back(lower);  // a vertex without pairs: its mass alone
        first_share_.push_back(shares);
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
