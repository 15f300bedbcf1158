// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/solver/linear/multigrid.hpp>
#include <plica/drivers/solver/spaces/sparse_rows.hpp>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/linear/chebyshev.hpp>
#include <plica/kernels/linear/galerkin_product.hpp>
#include <plica/kernels/transfer/multiply_rows.hpp>

namespace plica {

namespace {

constexpr int power_iterations = 12;
constexpr double power_margin = 1.1;  // what so few fall short by, at most

}  // namespace

template <class B>
Multigrid<B>::Multigrid(const BlockMatrix<B>& A, const std::vector<RowMatrix>& transfers, int degree)
    : grids_(transfers.size() + 1), degree_(degree), sums_(A.rows), square_("plica::multigrid.square", 1) {
  HostPattern pattern = host_pattern(A);
  for (std::size_t i = 0; i < grids_.size(); ++i) {
    Grid& grid = grids_[i];
    if (i == 0) {
      grid.A = {A.rows, A.first, A.column, A.diagonal, Blocks9<F>("plica::multigrid.value", A.value.extent(0))};
    } else {
      CoarseMatrix<F> coarse = coarse_matrix<F>(pattern, transfers[i - 1]);
      grid.A = coarse.matrix, grid.map = coarse.map, pattern = std::move(coarse.pattern);
    }
    const int n = grid.A.rows;
    grid.x = Vectors<F>("plica::multigrid.x", n), grid.r = Vectors<F>("plica::multigrid.r", n);
    if (i > 0 && i + 1 == grids_.size()) {
      coarsest_ = DenseInverse<F>(n);
      continue;
    }
    grid.inverse_diagonal = Blocks<F>("plica::multigrid.diagonal", n);
    grid.d = Vectors<F>("plica::multigrid.d", n), grid.e = Vectors<F>("plica::multigrid.e", n);
    grid.largest = Scalar("plica::multigrid.largest", 1);
    if (i + 1 == grids_.size()) continue;
    grid.up = sparse_rows<F>("multigrid.up", transfers[i]);
    grid.down = sparse_rows<F>("multigrid.down", RowMatrix(transfers[i].transpose()));
  }
}

template <class B>
void Multigrid<B>::fit(const Exec& exec, const BlockMatrix<B>& A, const Blocks<B>& inverse_diagonal) {
  const Grid& finest = grids_.front();
  update_vertices<F>(exec, "plica::multigrid_values", A.blocks(), ConvertBlocks<F, B>{A.value, finest.A.value});
  Kokkos::deep_copy(exec, finest.inverse_diagonal, inverse_diagonal);
  refit(exec);
}

/// All levels follow from the finest one's matrix and blocks.
template <class B>
void Multigrid<B>::refit(const Exec& exec) {
  fit_grid(exec, grids_.front());
  for (std::size_t i = 1; i < grids_.size(); ++i) {
    const Grid& grid = grids_[i];
    update_vertices<F>(exec, "plica::galerkin", grid.map.blocks(),
                       GalerkinProduct<F>{grid.map, grids_[i - 1].A, grid.A});
    if (i + 1 == grids_.size()) return invert_coarsest(exec);
    update_vertices<F>(exec, "plica::invert_diagonal", grid.A.rows, InvertDiagonal<F>{grid.A, grid.inverse_diagonal});
    fit_grid(exec, grid);
  }
}

template <class B>
void Multigrid<B>::fit_grid(const Exec& exec, const Grid& grid) const {
  const int n = grid.A.rows;
  update_vertices<F>(exec, "plica::power_start", n, PowerStart<F>{grid.r});
  for (int i = 0;; ++i) {
    reduce<F, 1>(exec, "plica::power_size", n, PowerSize<F>{grid.inverse_diagonal, grid.r, grid.x}, sums_, square_);
    if (i == power_iterations) break;
    update_vertices<F>(exec, "plica::power_product", n, PowerProduct<F>{grid.A, square_, grid.x, grid.r});
  }
  update_vertices<F>(exec, "plica::power_bound", 1, PowerBound<F>{square_, grid.largest, power_margin});
}

template <class B>
void Multigrid<B>::invert_coarsest(const Exec& exec) const {
  const int n = coarsest_.size;
  update_vertices<F>(exec, "plica::to_dense", n / 3, ToDense<F>{grids_.back().A, coarsest_});
  for (int pivot = 0; pivot < n; ++pivot) {
    update_vertices<F>(exec, "plica::pivot_row", n, TakePivotRow<F>{coarsest_, pivot});
    update_vertices<F>(exec, "plica::sweep", n, SweepRow<F>{coarsest_, pivot});
  }
  update_vertices<F>(exec, "plica::pack_inverse", n, PackInverse<F>{coarsest_});
}

/// Step k of the polynomial; its first after a correction takes that for its direction.
template <class B>
void Multigrid<B>::step(const Exec& exec, const Grid& grid, const Vectors<F>& d, const Vectors<F>& next, int k,
                        bool correcting, bool last) const {
  const auto keep = static_cast<float>(2 * k - 1) / static_cast<float>(2 * k + 3);
  const auto gain = static_cast<float>(8 * k + 4) / static_cast<float>(2 * k + 3);
  update_vertices<F>(exec, "plica::chebyshev", grid.A.rows,
                     ChebyshevStep<F>{grid.A, grid.inverse_diagonal, grid.largest, d, grid.r, grid.x, next,
                                      correcting ? 0.0F : keep, gain, last});
}

template <class B>
void Multigrid<B>::cycle(const Exec& exec, std::size_t level) const {
  const Grid& grid = grids_[level];
  const int n = grid.A.rows;
  if (level > 0 && level + 1 == grids_.size())
    return update_vertices<F>(exec, "plica::coarsest", ApplyDense<F>::items(coarsest_.size),
                              ApplyDense<F>{coarsest_, grid.r, grid.x});
  update_vertices<F>(exec, "plica::chebyshev_start", n,
                     ChebyshevStart<F>{grid.inverse_diagonal, grid.largest, grid.r, grid.d, grid.x});
  Vectors<F> d = grid.d, e = grid.e;
  const bool alone = level + 1 == grids_.size();
  for (int k = 1; k <= (alone ? degree_ - 1 : degree_); ++k, std::swap(d, e))
    step(exec, grid, d, e, k, false, alone && k + 1 == degree_);
  if (alone) return;
  const Grid& coarse = grids_[level + 1];
  update_vertices<F>(exec, "plica::restrict_residual", coarse.A.rows, MultiplyRows<F>{grid.down, grid.r, coarse.r});
  cycle(exec, level + 1);
  update_vertices<F>(exec, "plica::prolong", n, MultiplyRows<F>{grid.up, coarse.x, d});
  for (int k = 0; k < degree_; ++k, std::swap(d, e)) step(exec, grid, d, e, k, k == 0, k + 1 == degree_);
}

template <class B>
void Multigrid<B>::apply(const Exec& exec, const Vectors<B>& r, const Vectors<B>& z) const {
  const Grid& finest = grids_.front();
  update_vertices<F>(exec, "plica::multigrid_in", finest.A.rows, ConvertVectors<F, B>{r, finest.r});
  cycle(exec, 0);
  update_vertices<B>(exec, "plica::multigrid_out", finest.A.rows, ConvertVectors<B, F>{finest.x, z});
}

template <class B>
void Multigrid<B>::persist(StateArchive<B>& archive) {
  archive.field("the preconditioner's matrix", grids_.front().A.value);
  archive.field("the preconditioner's diagonal", grids_.front().inverse_diagonal);
}

template <class B>
std::size_t Multigrid<B>::bytes() const {
  std::size_t total = bytes_of_views(coarsest_.matrix, coarsest_.row, coarsest_.inverse);
  for (const Grid& grid : grids_)
    total += bytes_of_views(grid.A.value, grid.inverse_diagonal, grid.x, grid.r, grid.d, grid.e, grid.largest) +
             bytes_of_rows(grid.up) + bytes_of_rows(grid.down) +
             bytes_of_views(grid.map.first, grid.map.fine, grid.map.weight, grid.map.upper, grid.map.lower) +
             (&grid == &grids_.front() ? 0 : bytes_of_views(grid.A.first, grid.A.column, grid.A.diagonal));
  return total;
}

#define PLICA_INSTANTIATE(Real, Exec) template class Multigrid<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
