// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/matrices.hpp>
#include <plica/core/state_archive.hpp>
#include <plica/drivers/linear/cycle_product.hpp>
#include <plica/drivers/linear/host_pattern.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <plica/kernels/linear/chebyshev.hpp>
#include <plica/kernels/linear/dense_inverse.hpp>
#include <plica/kernels/reduce.hpp>
#include <string>
#include <vector>

namespace plica {

/// z = C r with a symmetric positive definite C near the inverse of a matrix. Vertices whose motion
/// is given get 0.
template <class B>
class Preconditioner {
 public:
  using Exec = typename B::Exec;
  virtual ~Preconditioner() = default;
  /// Fits it to a matrix. `inverse_diagonal`: its vertex blocks' inverses, 0 where the motion is
  /// given.
  virtual void fit(const Exec& exec, const BlockMatrix<B>& A,
                   const Blocks<B>& inverse_diagonal) = 0;
  virtual void apply(const Exec& exec, const Vectors<B>& r, const Vectors<B>& z) const = 0;
  virtual std::size_t bytes() const = 0;
  /// Names what it has been fitted to; where that has been restored, refit() makes the rest of it.
  virtual void persist(StateArchive<B>& archive) = 0;
  virtual void refit(const Exec& exec) = 0;
};

template <class B>
struct CoarseMatrix {
  HostPattern pattern;
  BlockMatrix<B> matrix;  ///< P^T A P, its values zero
  GalerkinMap<B> map;
};

/// Which vertex stands in which slot of packed rows, and the other way round: in windows of slices
/// the longest rows first, so that little is filled up.
struct SlotOrder {
  std::vector<int> vertex;  ///< [slots] -1: none
  std::vector<int> slot;    ///< [vertices]
};
SlotOrder slot_order(const HostPattern& A, int height);
/// Every vertex in the slot of its number.
SlotOrder plain_order(int vertices);

/// Room for a matrix of that pattern, packed, in the order slot_order(A, height); for float.
template <class B>
PackedRows<B> packed_rows(const HostPattern& A, const SlotOrder& order);
/// The rows and columns of a matrix, by slots.
RowMatrix by_slots(const RowMatrix& P, const SlotOrder& rows, const SlotOrder& columns);

/// The pattern of P^T A P, own blocks always in it, and how its blocks follow from A's.
template <class B>
CoarseMatrix<B> coarse_matrix(const HostPattern& A, const RowMatrix& P);

/// One symmetric V-cycle over the body's meshes, in float: Galerkin matrices P^T A P, Chebyshev
/// polynomials before and after (kernels/linear/chebyshev.hpp), the dense inverse of the coarsest
/// level. With no coarser level it is the polynomial alone.
///
///   level 0   relax  residual                                        prolongate  relax
///                        \\                                           /
///   level 1               restrict  relax  residual      prolongate  relax
///                                             \\           /
///   level 2                                    restrict  solve
///
/// Where the finest level's matrix is not stored, its polynomial takes that of each moment by
/// products; coarser levels follow from one that is near it, as it was when the cycle was fitted.
///
/// The polynomial carries the residual along, so that it costs no product of its own. It reads
/// copies of the matrices in 16 bits a number, and all vectors of a cycle are by the slots of these
/// (kernels/linear/packed_rows.hpp). Nothing in a cycle waits for the device; a fit waits once a
/// level.
template <class B>
class Multigrid final : public Preconditioner<B> {
 public:
  using Exec = typename B::Exec;
  using F = Backend<float, Exec>;

  /// @param A          its pattern counts
  /// @param transfers  [i]: level i + 1's vertices to level i's, finest first
  /// @param degree     of the polynomials, >= 2
  /// @param finest     of the finest level's matrix, where A is only near it; it outlives the cycle
  Multigrid(const BlockMatrix<B>& A, const std::vector<RowMatrix>& transfers, int degree,
            const CycleProduct<B>* finest = nullptr);

  void fit(const Exec& exec, const BlockMatrix<B>& A, const Blocks<B>& inverse_diagonal) override;
  void apply(const Exec& exec, const Vectors<B>& r, const Vectors<B>& z) const override;
  std::size_t bytes() const override;
  void persist(StateArchive<B>& archive) override;
  void refit(const Exec& exec) override;

 private:
  struct Grid {
    BlockMatrix<F> A;
    Blocks<F> inverse_diagonal;
    Chebyshev<F> smoother;   ///< none on the coarsest, and none of these three
    Fours<F> d, e;           ///< what rows gather, in turns
    SparseRows<F> up, down;  ///< P from the next coarser level, and its transpose, by slots
    GalerkinMap<F> map;      ///< from the next finer level's matrix; none on the finest
  };
  std::vector<Grid> grids_;
  int degree_;
  const CycleProduct<B>* finest_;  ///< none: by the matrix that is stored
  Vectors<F> p_;                   ///< of its products
  double largest_ = 0;             ///< eigenvalue of D^-1 A on the finest level, since the fit
  DenseInverse<F> coarsest_;
  Vectors<F> coarsest_r_;
  Fours<F> coarsest_x_;
  Vectors<F> lanczos_[4];  ///< of the finest level's size
  BlockSums<F> sums_;
  Doubles<B> scalars_;

  bool coarser_than(std::size_t level) const { return level + 1 < grids_.size(); }
  bool by_products(const Grid& grid) const { return finest_ && &grid == &grids_.front(); }
  void fit_smoother(const Exec& exec, const Grid& grid) const;
  double largest_eigenvalue(const Exec& exec, const Grid& grid) const;
  void invert_coarsest(const Exec& exec) const;
  Fours<F> cycle(const Exec& exec, std::size_t level) const;
  void multiply(const Exec& exec, const Fours<F>& d) const;
  Fours<F> relax(const Exec& exec, const Grid& grid, int first, int last, Leaves leaves) const;
};

}  // namespace plica
