// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/dense.hpp>
#include <plica/drivers/solver/linear/multigrid.hpp>
#include <plica/kernels/linear/chebyshev.hpp>
#include <plica/kernels/linear/dense_inverse.hpp>
#include <plica/kernels/linear/vertex_blocks.hpp>
#include <plica/kernels/transfer.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

namespace {

constexpr int power_iterations = 12;
constexpr double power_margin = 1.1;  // what so few fall short by, at most

/// The part of a direction that Chebyshev's next one keeps.
float keep_of(int k) { return static_cast<float>(2 * k - 1) / static_cast<float>(2 * k + 3); }

/// A^-1 in place, 0 in empty rows. False where A is not positive definite.
bool invert_on_host(int n, double* A) {
  const auto diagonal = [&](int i) -> double& { return A[static_cast<std::ptrdiff_t>(i) * (n + 1)]; };
  std::vector<int> empty;
  for (int i = 0; i < n; ++i)
    if (diagonal(i) == 0) empty.push_back(i);
  for (const int i : empty) diagonal(i) = 1;
  if (!dense::invert(n, A)) return false;
  for (const int i : empty) diagonal(i) = 0;
  return true;
}

}  // namespace

template <class B>
PackedRows<B> packed_rows(const HostPattern& A) {
  std::vector<int> first{0};
  for (std::size_t a = 0; a + 1 < A.first.size(); ++a)
    first.push_back(first.back() + (A.first[a + 1] - A.first[a] + 1) / 2);
  return {to_device<Indices<B>>("packed.first", first),
          zeros<decltype(PackedRows<B>::pair)>("plica::packed.pair", static_cast<std::size_t>(first.back())),
          zeros<Scalars<B>>("plica::packed.scale", A.first.size() - 1)};
}

template <class B>
Multigrid<B>::Multigrid(const BlockMatrix<B>& A, const std::vector<RowMatrix>& transfers, int degree)
    : grids_(transfers.size() + 1),
      degree_(degree),
      sums_(A.rows),
      square_(zeros<Doubles<B>>("plica::multigrid.square", 1)) {
  HostPattern pattern = host_pattern(A);
  for (std::size_t i = 0; i < grids_.size(); ++i) {
    Grid& grid = grids_[i];
    if (i == 0) {
      grid.A = {A.rows, A.first, A.column, A.diagonal, zeros<Blocks9<F>>("plica::multigrid.value", A.value.extent(0))};
    } else {
      CoarseMatrix<F> coarse = coarse_matrix<F>(pattern, transfers[i - 1]);
      grid.A = coarse.matrix, grid.map = coarse.map, pattern = std::move(coarse.pattern);
    }
    const int n = grid.A.rows;
    grid.x = zeros<Vectors<F>>("plica::multigrid.x", n), grid.r = zeros<Vectors<F>>("plica::multigrid.r", n);
    if (i > 0 && i + 1 == grids_.size()) {
      coarsest_ = DenseInverse<F>(n);
      continue;
    }
    grid.inverse_diagonal = zeros<Blocks<F>>("plica::multigrid.diagonal", n);
    grid.packed = packed_rows<F>(pattern);
    grid.d = zeros<Vectors<F>>("plica::multigrid.d", n + 1), grid.e = zeros<Vectors<F>>("plica::multigrid.e", n + 1);
    grid.largest = zeros<Doubles<B>>("plica::multigrid.largest", 1);
    if (i + 1 == grids_.size()) continue;
    grid.up = sparse_rows<F>("multigrid.up", transfers[i]);
    grid.down = sparse_rows<F>("multigrid.down", RowMatrix(transfers[i].transpose()));
  }
}

template <class B>
void Multigrid<B>::fit(const Exec& exec, const BlockMatrix<B>& A, const Blocks<B>& inverse_diagonal) {
  const Grid& finest = grids_.front();
  convert(exec, "plica::multigrid_values", A.value, finest.A.value);
  convert(exec, "plica::multigrid_values", inverse_diagonal, finest.inverse_diagonal);
  refit(exec);
}

/// All levels follow from the finest one's matrix and blocks.
template <class B>
void Multigrid<B>::refit(const Exec& exec) {
  fit_smoother(exec, grids_.front());
  for (std::size_t i = 1; i < grids_.size(); ++i) {
    const Grid& grid = grids_[i];
    update_vertices<F>(exec, "plica::galerkin", grid.map.blocks(),
                       GalerkinProduct<F>{grid.map, grids_[i - 1].A, grid.A});
    if (!coarser_than(i)) return invert_coarsest(exec);
    update_vertices<F>(exec, "plica::invert_diagonal", grid.A.rows, InvertDiagonal<F>{grid.A, grid.inverse_diagonal});
    fit_smoother(exec, grid);
  }
}

/// The packed matrix, and the largest eigenvalue of D^-1 A, by a few power iterations.
template <class B>
void Multigrid<B>::fit_smoother(const Exec& exec, const Grid& grid) const {
  const int n = grid.A.rows;
  update_vertices<F>(exec, "plica::pack_scales", n, ScaleOfVertex<F>{grid.A, grid.packed.scale});
  update_vertices<F>(exec, "plica::pack_rows", n, PackRow<F>{grid.A, grid.packed});
  update_vertices<F>(exec, "plica::power_start", n, PowerStart<F>{grid.r});
  for (int i = 0;; ++i) {
    reduce<F, 1>(exec, "plica::power_size", n, PowerSize<F>{grid.inverse_diagonal, grid.r, grid.x}, sums_, square_);
    if (i == power_iterations) break;
    update_vertices<F>(exec, "plica::power_product", n, PowerProduct<F>{grid.A, square_, grid.x, grid.r});
  }
  update_vertices<F>(exec, "plica::power_bound", 1, PowerBound<F>{square_, grid.largest, power_margin});
}

/// On the device by the sweep operator; where the host shares its memory by Cholesky's method, which is many times faster there,
/// if the matrix is positive definite but for empty rows.
template <class B>
void Multigrid<B>::invert_coarsest(const Exec& exec) const {
  const int n = coarsest_.size;
  update_vertices<F>(exec, "plica::to_dense", n / 3, ToDense<F>{grids_.back().A, coarsest_});
  if constexpr (B::on_host) {
    exec.fence("plica::to_dense");
    if (invert_on_host(n, coarsest_.matrix.data()))
      return update_vertices<F>(exec, "plica::pack_inverse", n, PackInverse<F>{coarsest_, 1});
    update_vertices<F>(exec, "plica::to_dense", n / 3, ToDense<F>{grids_.back().A, coarsest_});
  }
  for (int pivot = 0; pivot < n; ++pivot) {
    update_vertices<F>(exec, "plica::pivot_row", n, TakePivotRow<F>{coarsest_, pivot});
    update_vertices<F>(exec, "plica::sweep", n, SweepRow<F>{coarsest_, pivot});
  }
  update_vertices<F>(exec, "plica::pack_inverse", n, PackInverse<F>{coarsest_, -1});
}

/// x near A^-1 r, from r alone; r is lost.
template <class B>
void Multigrid<B>::cycle(const Exec& exec, std::size_t level) const {
  const Grid& grid = grids_[level];
  if (level > 0 && !coarser_than(level))
    return update_vertices<F>(exec, "plica::coarsest", ApplyDense<F>::items(coarsest_.size),
                              ApplyDense<F>{coarsest_, grid.r, grid.x});
  relax_from_zero(exec, grid, coarser_than(level));  // x, and the residual in r
  if (!coarser_than(level)) return;
  const Grid& coarse = grids_[level + 1];
  update_vertices<F>(exec, "plica::restrict_residual", coarse.A.rows, MultiplyRows<F>{grid.down, grid.r, coarse.r});
  cycle(exec, level + 1);
  update_vertices<F>(exec, "plica::prolongate", grid.A.rows,
                     ChebyshevCorrection<F>{grid.packed.scale, grid.up, coarse.x, grid.d});
  relax_from_correction(exec, grid);
}

/// x = the polynomial's answer to r, starting from x = 0. Leaves the residual in r where asked to; else the last step, which
/// would only update the residual, is left out.
template <class B>
void Multigrid<B>::relax_from_zero(const Exec& exec, const Grid& grid, bool leaves_residual) const {
  update_vertices<F>(exec, "plica::chebyshev_start", grid.A.rows,
                     ChebyshevStart<F>{grid.packed.scale, grid.inverse_diagonal, grid.largest, grid.r, grid.d, grid.x});
  Vectors<F> d = grid.d, next = grid.e;
  const int steps = leaves_residual ? degree_ : degree_ - 1;
  for (int k = 1; k <= steps; ++k, std::swap(d, next))
    chebyshev_step(exec, grid, d, next, k, keep_of(k), !leaves_residual && k == steps);
}

/// x += the correction in d, r -= A d, and the polynomial's answer to that residual.
template <class B>
void Multigrid<B>::relax_from_correction(const Exec& exec, const Grid& grid) const {
  Vectors<F> d = grid.d, next = grid.e;
  for (int k = 0; k < degree_; ++k, std::swap(d, next))
    chebyshev_step(exec, grid, d, next, k, k == 0 ? 0.0F : keep_of(k), k + 1 == degree_);
}

/// Step k: x += d, r -= A d, and the next direction, which keeps a part of d. The last adds that to x as well.
template <class B>
void Multigrid<B>::chebyshev_step(const Exec& exec, const Grid& grid, const Vectors<F>& d, const Vectors<F>& next,
                                  int k, float keep, bool last) const {
  const auto gain = static_cast<float>(8 * k + 4) / static_cast<float>(2 * k + 3);
  update_vertices<F>(
      exec, "plica::chebyshev", grid.A.rows,
      ChebyshevStep<F>{grid.packed, grid.inverse_diagonal, grid.largest, d, grid.r, grid.x, next, keep, gain, last});
}

template <class B>
void Multigrid<B>::apply(const Exec& exec, const Vectors<B>& r, const Vectors<B>& z) const {
  const Grid& finest = grids_.front();
  convert(exec, "plica::multigrid_in", r, finest.r);
  cycle(exec, 0);
  convert(exec, "plica::multigrid_out", finest.x, z);
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
    total += bytes_of_views(grid.A.value, grid.packed.first, grid.packed.pair, grid.packed.scale, grid.inverse_diagonal,
                            grid.x, grid.r, grid.d, grid.e, grid.largest) +
             bytes_of_rows(grid.up) + bytes_of_rows(grid.down) +
             bytes_of_views(grid.map.first, grid.map.fine, grid.map.weight, grid.map.upper, grid.map.lower) +
             (&grid == &grids_.front() ? 0 : bytes_of_views(grid.A.first, grid.A.column, grid.A.diagonal));
  return total;
}

#define PLICA_INSTANTIATE(Real, Exec) template class Multigrid<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)
#define PLICA_PACKED_ROWS(Exec) \
  template PackedRows<Backend<float, Exec>> packed_rows<Backend<float, Exec>>(const HostPattern& A);
PLICA_FOR_EACH_SPACE(PLICA_PACKED_ROWS)

}  // namespace plica
