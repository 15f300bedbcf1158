// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/drivers/level/solver_level.hpp>
#include <plica/drivers/linear/block_pattern.hpp>
#include <plica/drivers/linear/multigrid.hpp>
#include <plica/kernels/linear/krylov.hpp>
#include <plica/kernels/linear/system_kernels.hpp>

namespace plica {

/// The system A of an implicit stage on one level: its product without a matrix or by an assembled
/// one, and its vertex blocks. With nodal elements the product is without a matrix; the matrix,
/// from which coarser levels of a preconditioner follow, is that of linear ones.
template <class B>
class StageSystem {
 public:
  using Exec = typename B::Exec;

  StageSystem(const Level<B>& level, bool assembled);

  /// A of a level at `state`, where its forces have just been linearised; they stay as they are
  /// until the next. Projected elements are assembled, also where the rest is not.
  void prepare(const SolverLevel<B>& level, const State<B>& state, const ImplicitWeights& weights,
               bool positive);
  /// The same system again, with the elements' tangents projected.
  void project() { prepare(*forces_, State<B>(state_), ImplicitWeights(weights_), true); }
  /// q = A p
  void product(const Exec& exec, const Vectors<B>& p, const Vectors<B>& q) const;
  /// The same, p.q, and the step that follows from it.
  void product(const Exec& exec, const Vectors<B>& p, const Vectors<B>& q, const BlockSums<B>& sums,
               const Doubles<B>& curvature, const CgStep<B>& then) const;
  /// q = A w of a whole space
  void products(const Exec& exec, const SolutionSpace<B>& space) const;
  /// The inverses of its vertex blocks; 0 where the motion is given.
  const Blocks<B>& inverse_diagonal() const { return inverse_diagonal_; }
  /// A itself, assembled if it is not.
  const BlockMatrix<B>& matrix(const Exec& exec);
  /// Fits a preconditioner to that matrix.
  void fit(const Exec& exec, Preconditioner<B>& preconditioner);
  /// For a preconditioner of nodal elements whose model has rows in float; else none.
  const CycleProduct<B>* cycle_product(std::string_view material);
  /// Its pattern alone; with nodal elements that of linear ones.
  const BlockMatrix<B>& pattern();
  /// Whether a product is by the matrix and nothing else.
  bool by_matrix_alone() const { return by_matrix() && forces_->is_all_in_matrix(); }
  int rows() const { return level_->model.vertices; }
  std::size_t bytes() const;

 private:
  bool nodal_, assembled_, ready_ = false;  ///< the matrix is that of this stage
  BlockPattern<B> pattern_;
  Blocks9<B> shares_;
  /// inverses; the latter of nodal elements without cycle_product_
  Blocks<B> inverse_diagonal_, blocks_of_matrix_;
  std::unique_ptr<CycleProduct<B>> cycle_product_;
  const Level<B>* level_ = nullptr;
  const SolverLevel<B>* forces_ = nullptr;
  State<B> state_;
  ImplicitWeights weights_;
  bool positive_ = false;

  InvertBlocks<B> inverting(const Blocks<B>& blocks) const;
  void invert_blocks(const Exec& exec, const Blocks<B>& blocks) const;
  void invert_blocks_of_matrix(const Exec& exec, const Blocks<B>& blocks);
  void add_contact_blocks(const Exec& exec, bool beside, const Blocks<B>& blocks) const;
  bool has_products() const { return level_->model.float_rows.slices > 0; }
  bool by_matrix() const { return !nodal_ && (assembled_ || positive_); }
};

}  // namespace plica
