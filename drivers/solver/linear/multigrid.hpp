// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/sparse_rows.hpp>
#include <plica/drivers/solver/linear/galerkin_map.hpp>
#include <plica/drivers/solver/linear/preconditioner.hpp>
#include <plica/kernels/linear/dense_inverse.hpp>
#include <plica/kernels/reduce.hpp>
#include <vector>

namespace plica {

/// One symmetric V-cycle over the body's meshes, in float: Galerkin matrices P^T A P, Chebyshev polynomials before and after
/// (kernels/linear/chebyshev.hpp), the dense inverse of the coarsest level. With no coarser level it is the polynomial alone.
/// Nothing in it waits for the device.
template <class B>
class Multigrid final : public Preconditioner<B> {
 public:
  using Exec = typename B::Exec;
  using F = Backend<float, Exec>;

  /// @param A          its pattern counts
  /// @param transfers  [i]: level i + 1's vertices to level i's, finest first
  /// @param degree     of the polynomials, >= 1
  Multigrid(const BlockMatrix<B>& A, const std::vector<RowMatrix>& transfers, int degree);

  void fit(const Exec& exec, const BlockMatrix<B>& A, const Blocks<B>& inverse_diagonal) override;
  void apply(const Exec& exec, const Vectors<B>& r, const Vectors<B>& z) const override;
  std::size_t bytes() const override;
  void persist(StateArchive<B>& archive) override;
  void refit(const Exec& exec) override;

 private:
  using Scalar = Kokkos::View<double*, typename B::Memory>;
  struct Grid {
    BlockMatrix<F> A;
    Blocks<F> inverse_diagonal;
    Vectors<F> x, r, d, e;
    Scalar largest;
    SparseRows<F> up, down;  ///< P from the next coarser level, and its transpose; none on the coarsest
    GalerkinMap<F> map;      ///< from the next finer level's matrix; none on the finest
  };
  std::vector<Grid> grids_;
  int degree_;
  DenseInverse<F> coarsest_;
  BlockSums<F> sums_;
  Scalar square_;

  void fit_grid(const Exec& exec, const Grid& grid) const;
  void invert_coarsest(const Exec& exec) const;
  void cycle(const Exec& exec, std::size_t level) const;
  void step(const Exec& exec, const Grid& grid, const Vectors<F>& d, const Vectors<F>& next, int k, bool correcting,
            bool last) const;
};

}  // namespace plica
