// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/drivers/level/level.hpp>
#include <plica/drivers/linear/block_pattern.hpp>
#include <plica/drivers/linear/multigrid.hpp>
#include <plica/kernels/halo.hpp>
#include <plica/kernels/linear/krylov.hpp>
#include <plica/kernels/linear/system_kernels.hpp>

namespace plica {

/// System A of an implicit stage on one level: its product and its vertex blocks.
/// The product uses an assembled matrix, or none. With nodal elements it uses none; the matrix,
/// from which coarser levels of a preconditioner are made, is then that of linear elements.
/// Right sides and arguments of products are held, see hold(); kernels/linear/hold_system.hpp.
template <class B>
class StageSystem {
 public:
  using Exec = typename B::Exec;

  /// @param assembled  whether products of linear elements use the matrix
  /// @param kept       whether products without it use tangents that linear elements keep, where
  ///                   they are projected; else a matrix is assembled for these
  StageSystem(const LevelData<B>& level, bool assembled, bool kept = false);

  /// Sets A to the system of a level at `state`, where its forces have just been linearised.
  /// State and forces must not change until the next call. `projected`: with projected tangents.
  void prepare(const Level<B>& level, const State<B>& state, const ImplicitWeights& weights,
               bool projected);
  /// Sets A to the system of the last prepare() with the elements' tangents projected.
  void project() { prepare(*forces_, State<B>(state_), ImplicitWeights(weights_), true); }
  /// Takes out of a vector what is along the directions that hold sliding vertices.
  void hold(const Exec& exec, const Vectors<B>& x) const;
  /// Sets q = A p. On several ranks q is that of owned vertices, and p is received elsewhere.
  void product(const Exec& exec, const Vectors<B>& p, const Vectors<B>& q) const;
  /// Sets q = A p, sums p.q into `curvature`, and runs `then`, the step that follows from it.
  void product(const Exec& exec, const Vectors<B>& p, const Vectors<B>& q, const BlockSums<B>& sums,
               const Doubles<B>& curvature, const CgStep<B>& then) const;
  /// Sets q = A w for all vectors of a space, which are known at all vertices of this process.
  void products(const Exec& exec, const SolutionSpace<B>& space) const;
  /// Returns the inverses of the vertex blocks of A; 0 where the motion is given.
  const Blocks<B>& inverse_diagonal() const { return inverse_diagonal_; }
  /// Returns the matrix of A, which is assembled if it is not yet.
  const BlockMatrix<B>& matrix(const Exec& exec);
  /// Fits a preconditioner to matrix().
  void fit(const Exec& exec, Preconditioner<B>& preconditioner);
  /// Returns products in float for a preconditioner of nodal elements.
  /// Null where the model has no rows in float.
  const CycleProduct<B>* cycle_product(std::string_view material);
  /// Returns the matrix of A, of which only the pattern is valid; with nodal elements that of
  /// linear ones.
  const BlockMatrix<B>& pattern();
  /// Returns true where a product needs the matrix and nothing else.
  bool by_matrix_alone() const { return by_matrix() && forces_->is_all_in_matrix(); }
  /// Returns true where the matrix is T^T A T of the free vertices, since others follow them. It
  /// has no columns for vertices whose motion is given.
  bool composes() const { return level_->model.followers.any(); }
  int rows() const { return level_->model.vertices; }
  /// Returns the rows, of which sums are taken over those that this rank owns.
  Items items() const { return vertices_of<B>(*level_); }
  /// Returns the part that this rank has of the level; null: one process has all of it.
  const RankLevel<B>* ranks() const { return level_->ranks.get(); }
  /// Returns whether projected tangents are read from where the level keeps them.
  bool reads_kept() const { return nodal_ || (kept_ && !assembled_); }
  void name_fields(Archive<B>& archive) const {
    archive.owns(pattern_, shares_, inverse_diagonal_, blocks_of_matrix_);
    archive.owns(composed_.matrix, composed_.map);
    if (ranks()) archive.owns(ranks()->around_owned);
    if (cycle_product_) cycle_product_->name_fields(archive);
  }

 private:
  bool nodal_, assembled_, kept_, ready_ = false;  ///< ready_: the matrix is that of this stage
  BlockPattern<B> pattern_;
  CoarseMatrix<B> composed_;  ///< matrix of the free vertices; empty where none follow others
  Blocks9<B> shares_;
  /// inverses of vertex blocks: of A; of the matrix, for nodal elements without cycle_product_
  Blocks<B> inverse_diagonal_, blocks_of_matrix_;
  std::unique_ptr<CycleProduct<B>> cycle_product_;
  const LevelData<B>* level_ = nullptr;
  const Level<B>* forces_ = nullptr;
  State<B> state_;
  ImplicitWeights weights_;
  bool positive_ = false;

  const BlockMatrix<B>& stored() const;
  InvertBlocks<B> inverting(const Blocks<B>& blocks) const;
  void invert_blocks(const Exec& exec, const Blocks<B>& blocks) const;
  void invert_blocks_of_matrix(const Exec& exec, const Blocks<B>& blocks);
  void add_contact_blocks(const Exec& exec, bool beside, const Blocks<B>& blocks) const;
  // one of several ranks may have no row
  static bool is_nodal(const LevelData<B>& level) {
    return level.model.rows.slices > 0 || (level.ranks && level.ranks->slots);
  }
  bool has_products() const { return level_->model.float_rows.slices > 0 || level_->float_ranks; }
  bool by_matrix() const { return !nodal_ && (assembled_ || (positive_ && !kept_)); }
};

}  // namespace plica
