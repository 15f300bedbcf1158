// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/shared_fields.hpp>
#include <plica/drivers/level/shared_product.hpp>
#include <plica/drivers/linear/multigrid_parts.hpp>
#include <plica/kernels/halo.hpp>
#include <string>
#include <vector>

// The finest level of a V-cycle, where several ranks share it. Each rank smooths its own rows.
// Coarser levels are whole on each rank:
//
//   finest level    rank 0: own rows of A         rank 1: own rows of A
//                        | restricts to its coarse vertices |
//   next level      coarse vertices of rank 0 | of rank 1         each rank receives all of them
//
// Every number is summed by one rank, in the order in which one process sums it.
namespace plica {

/// Product P^T A P with the rows of A that each rank owns.
template <class B>
class SharedGalerkin {
 public:
  using Exec = typename B::Exec;
  /// All ranks call this.
  SharedGalerkin(Ranks& ranks, const RankPart& part, const HostPattern& A, const RowMatrix& P,
                 const RowsByRank& coarse);
  /// Returns the pattern of the whole matrix, and the matrix, with all values 0.
  const HostPattern& pattern() const { return pattern_; }
  /// Computes the whole matrix on each rank.
  void operator()(const Exec& exec, const BlockMatrix<B>& A, const BlockMatrix<B>& coarse) const;
  template <class Archive>
  void name_fields(Archive& archive) const {
    archive.owns(right_, left_, between_, half_.all(), place_);
  }

 private:
  HostPattern pattern_;
  BlockTerms<B> right_, left_;
  Blocks9<B> between_;  ///< rows of A P that this rank makes, then those that it receives
  std::unique_ptr<Halo<B>> halo_;
  RowsOfAll<B> half_;  ///< stored blocks of the whole matrix, by rank
  Indices<B> place_;   ///< [stored blocks] place of each in half_

  void gather_pattern(Ranks& ranks, const std::vector<int>& first, const std::vector<int>& column,
                      const RowsByRank& coarse);
};

/// Restriction to a whole level from one that ranks share.
template <class B>
class SharedRestriction {
 public:
  using Exec = typename B::Exec;
  /// All ranks call this.
  /// @param fine    slots of this rank's vertices
  /// @param vertex  vertex of the next level in each of its slots; -1: none
  SharedRestriction(Ranks& ranks, const RankPart& part, const RowsByRank& coarse,
                    const SlotOrder& fine, const std::vector<int>& vertex);
  /// Sets r = P^T of the residual.
  template <class To>
  void operator()(const Exec& exec, const Fours<B>& residual, const To& r) const;
  template <class Archive>
  void name_fields(Archive& archive) const {
    archive.owns(down_, own_, read_, restricted_.all(), place_);
  }

 private:
  SparseRows<B> down_;  ///< rows that this rank makes
  Indices<B> own_;      ///< own slots among those that they read
  int before_ = 0;      ///< slots of ranks below among these
  Fours<B> read_;
  std::unique_ptr<Halo<B>> halo_;
  RowsOfAll<B> restricted_;
  Indices<B> place_;  ///< [slots of the next level] place in restricted_
};

/// Messages that ranks exchange of the finest level of a V-cycle.
template <class B>
struct SharedFinest {
  Items items{0};                          ///< vertices, and which of them this rank owns
  Indices<B> number;                       ///< numbers in the whole mesh
  RowNumbers blocks = {};                  ///< numbers of the stored blocks of A
  std::unique_ptr<Halo<B>> vertices = {};  ///< values of vertices
  std::unique_ptr<Halo<B>> slots = {};     ///< values by slots, of four numbers or one
  std::unique_ptr<SharedGalerkin<B>> galerkin = {};
  std::unique_ptr<SharedRestriction<B>> restriction = {};
};

/// Returns an order of a rank's vertices in which each window of slices has own vertices alone, as
/// on one process. Others have slots without a row.
/// @param plain  true: each vertex has the slot of its number
SlotOrder slot_order(const HostPattern& A, int height, const RankPart& part, bool plain);

/// Returns the exchange of values by slots.
HaloRows rows_by_slots(HaloRows vertices, const RankPart& part, const SlotOrder& order);

/// Returns the numbers of a rank's stored blocks among those of the whole matrix. All ranks call
/// this.
/// @param given  per local vertex, nonzero: it has no row of its own
RowNumbers numbers_of_blocks(Ranks& ranks, const RankPart& part, const std::vector<char>& given,
                             const HostPattern& A);

}  // namespace plica
