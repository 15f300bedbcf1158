// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/archive.hpp>
#include <plica/core/matrices.hpp>
#include <plica/drivers/linear/cycle_product.hpp>
#include <plica/drivers/linear/multigrid_parts.hpp>
#include <plica/drivers/linear/shared_finest.hpp>
#include <plica/kernels/linear/chebyshev.hpp>
#include <plica/kernels/linear/dense_inverse.hpp>
#include <plica/kernels/reduce.hpp>
#include <string>
#include <vector>

namespace plica {

/// Preconditioner z = C r, with a symmetric positive definite C near the inverse of a matrix.
/// Vertices whose motion is given get 0.
template <class B>
class Preconditioner {
 public:
  using Exec = typename B::Exec;
  virtual ~Preconditioner() = default;
  /// Fits the preconditioner to a matrix.
  /// `inverse_diagonal`: inverses of the matrix's vertex blocks, 0 where the motion is given.
  virtual void fit(const Exec& exec, const BlockMatrix<B>& A,
                   const Blocks<B>& inverse_diagonal) = 0;
  virtual void apply(const Exec& exec, const Vectors<B>& r, const Vectors<B>& z) const = 0;
  /// Names its arrays and what it was fitted to; after a restore call refit().
  virtual void name_fields(Archive<B>& archive) = 0;
  virtual void refit(const Exec& exec) = 0;
};

/// Preconditioner of one symmetric V-cycle over the body's meshes, in float.
/// It has Galerkin matrices P^T A P, Chebyshev polynomials before and after the coarser level
/// (kernels/linear/chebyshev.hpp), and the dense inverse of the coarsest level. With no coarser
/// level it is the polynomial alone.
///
///   level 0   relax  residual                                        prolongate  relax
///                        \\                                           /
///   level 1               restrict  relax  residual      prolongate  relax
///                                             \\           /
///   level 2                                    restrict  solve
///
/// Where the finest level's matrix is not stored, its polynomial uses products with the present
/// system. Coarser levels are made from a matrix near that of the finest level, at the time of the
/// fit.
///
/// The polynomial updates the residual, so that the residual costs no product of its own. The
/// polynomial reads copies of the matrices in 16 bits a number. All vectors of a cycle are in the
/// order of the slots of these copies (kernels/linear/packed_rows.hpp). On one process nothing in a
/// cycle waits for the device; a fit waits once a level. On several ranks each smooths its rows of
/// the finest level, and coarser levels are whole on each (shared_finest.hpp).
template <class B>
class Multigrid final : public Preconditioner<B> {
 public:
  using Exec = typename B::Exec;
  using F = Backend<float, Exec>;

  /// @param A          matrix whose pattern is used
  /// @param transfers  [i]: from level i + 1's vertices to level i's, finest first
  /// @param degree     degree of the polynomials, >= 2
  /// @param finest     products with the finest level's matrix, where A is only near it; must
  ///                   outlive the cycle; null: products with A
  /// @param part       this rank's part of the finest level, of which A is; transfers are of all of
  ///                   it. Null: one process has all of it
  Multigrid(const BlockMatrix<B>& A, const std::vector<RowMatrix>& transfers, int degree,
            const CycleProduct<B>* finest = nullptr, const RankLevel<B>* part = nullptr);

  void fit(const Exec& exec, const BlockMatrix<B>& A, const Blocks<B>& inverse_diagonal) override;
  void apply(const Exec& exec, const Vectors<B>& r, const Vectors<B>& z) const override;
  void name_fields(Archive<B>& archive) override;
  void refit(const Exec& exec) override;

 private:
  struct Grid {
    BlockMatrix<F> A;
    Blocks<F> inverse_diagonal;
    Chebyshev<F> smoother;   ///< empty on the coarsest level, as are d, e, up and down
    Fours<F> d, e;           ///< directions that rows gather, alternately read and written
    SparseRows<F> up, down;  ///< P from the next coarser level, and its transpose, by slots
    GalerkinMap<F> map;      ///< map from the next finer level's matrix; empty on the finest
  };
  std::vector<Grid> grids_;
  int degree_;
  const CycleProduct<B>* finest_;            ///< null: products with the matrix that is stored
  std::unique_ptr<SharedFinest<F>> shared_;  ///< null: one process has all of the finest level
  Vectors<F> p_;                             ///< argument of finest_'s products
  /// bound of the eigenvalues of D^-1 A on the finest level until the next fit; only with finest_
  double largest_ = 0;
  DenseInverse<F> coarsest_;
  Vectors<F> coarsest_r_;
  Fours<F> coarsest_x_;
  Vectors<F> lanczos_[4];  ///< [most vertices of a level][3] work space
  /// work space for sums on the finest level, and on coarser ones
  BlockSums<F> sums_, coarse_sums_;
  Doubles<B> scalars_;

  bool coarser_than(std::size_t level) const { return level + 1 < grids_.size(); }
  bool by_products(const Grid& grid) const { return finest_ && &grid == &grids_.front(); }
  bool is_shared(const Grid& grid) const { return shared_ && &grid == &grids_.front(); }
  SlotOrder order_of(const Grid& grid, const HostPattern& stored, const RankLevel<B>* part) const;
  void share(const RankLevel<B>& part, const HostPattern& A,
             const std::vector<RowMatrix>& transfers, const SlotOrder& order,
             const std::optional<RowsByRank>& by_rank);
  void fit_smoother(const Exec& exec, const Grid& grid) const;
  double largest_eigenvalue(const Exec& exec, const Grid& grid) const;
  void invert_coarsest(const Exec& exec) const;
  void restrict_residual(const Exec& exec, std::size_t level, const Fours<F>& left) const;
  Fours<F> cycle(const Exec& exec, std::size_t level) const;
  void multiply(const Exec& exec, const Fours<F>& d) const;
  Fours<F> relax(const Exec& exec, const Grid& grid, int first, int last, Leaves leaves) const;
};

}  // namespace plica
