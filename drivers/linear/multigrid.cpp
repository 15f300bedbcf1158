// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/dense.hpp>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/linear/multigrid.hpp>
#include <plica/kernels/linear/lanczos.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

namespace {

constexpr int lanczos_steps = 15;
// factor by which the largest eigenvalue may grow until the next fit, where products use the
// present system
constexpr double drift = 1.1;

/// Returns the part of a direction that the next direction of Chebyshev's polynomial keeps.
float keep_of(int k) { return static_cast<float>(2 * k - 1) / static_cast<float>(2 * k + 3); }

/// Inverts A in place; empty rows get 0. Returns false where A is not positive definite.
bool invert_on_host(int n, double* A) {
  const auto diagonal = [&](int i) -> double& {
    return A[static_cast<std::ptrdiff_t>(i) * (n + 1)];
  };
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
Multigrid<B>::Multigrid(const BlockMatrix<B>& A, const std::vector<RowMatrix>& transfers,
                        int degree, const CycleProduct<B>* finest, const RankLevel<B>* part)
    : grids_(transfers.size() + 1),
      degree_(degree),
      finest_(finest),
      shared_(part ? std::make_unique<SharedFinest<F>>() : nullptr),
      scalars_(zeros<Doubles<B>>("plica::multigrid.scalars", 2 * lanczos_steps + 1)) {
  // on several ranks a coarser level, which is whole, may have more rows than a part of the finest
  const int most =
      transfers.empty() ? A.rows : std::max(A.rows, static_cast<int>(transfers.front().cols()));
  for (auto& x : lanczos_) x = zeros<Vectors<F>>("plica::multigrid.lanczos", most);
  sums_ = BlockSums<F>(A.rows, part ? part->ranks : nullptr), coarse_sums_ = BlockSums<F>(most);
  std::optional<RowsByRank> by_rank;  // rows of the first coarser level
  if (part && !transfers.empty())
    by_rank.emplace(*part->ranks, part->part, RowMatrix(transfers.front().transpose()));
  HostPattern pattern = host_pattern(A);
  SlotOrder finer;
  for (std::size_t i = 0; i < grids_.size(); ++i) {
    Grid& grid = grids_[i];
    if (i == 0) {
      grid.A = {A.rows,   A.first,
                A.column, A.diagonal,
                A.place,  zeros<Blocks9<F>>("plica::multigrid.value", A.value.extent(0))};
    } else if (i == 1 && shared_) {
      pattern = shared_->galerkin->pattern();
      grid.A = block_matrix<F>("multigrid", pattern);
    } else {
      CoarseMatrix<F> coarse = coarse_matrix<F>(pattern, transfers[i - 1]);
      grid.A = coarse.matrix, grid.map = coarse.map, pattern = std::move(coarse.pattern);
    }
    const int n = grid.A.rows;
    const bool coarsest = i > 0 && i + 1 == grids_.size();
    const HostPattern none = HostPattern::empty(n);
    const HostPattern& stored = by_products(grid) ? none : pattern;
    SlotOrder order = coarsest ? plain_order(n) : order_of(grid, stored, part);
    if (i == 1 && shared_) {
      const RowMatrix P = by_slots(some_rows(transfers[0], part->part.vertex), finer, order);
      grids_[0].up = sparse_rows<F>("multigrid.up", P);
      shared_->restriction = std::make_unique<SharedRestriction<F>>(*part->ranks, part->part,
                                                                    *by_rank, finer, order.vertex);
    } else if (i > 0) {
      const RowMatrix P = by_slots(transfers[i - 1], finer, order);
      grids_[i - 1].up = sparse_rows<F>("multigrid.up", P);
      grids_[i - 1].down = sparse_rows<F>("multigrid.down", RowMatrix(P.transpose()));
    }
    if (coarsest) {
      coarsest_ = DenseInverse<F>(n);
      coarsest_r_ = zeros<Vectors<F>>("plica::multigrid.coarsest_r", n);
      coarsest_x_ = zeros<Fours<F>>("plica::multigrid.coarsest_x", n);
      continue;
    }
    grid.inverse_diagonal = zeros<Blocks<F>>("plica::multigrid.diagonal", n);
    const PackedRows<F> packed = packed_rows<F>(stored, order);
    const auto vectors = [&](const char* label) {
      return zeros<SlotVectors<F>>(label, packed.slices);
    };
    grid.smoother = {packed,
                     zeros<SlotBlocks<F>>("plica::multigrid.slot_diagonal", packed.slices),
                     zeros<Doubles<F>>("plica::multigrid.largest", 1),
                     vectors("plica::multigrid.r"),
                     vectors("plica::multigrid.x"),
                     by_products(grid) ? vectors("plica::multigrid.product") : SlotVectors<F>()};
    grid.d = zeros<Fours<F>>("plica::multigrid.d", packed.slots());
    grid.e = zeros<Fours<F>>("plica::multigrid.e", packed.slots());
    if (i == 0 && part) share(*part, pattern, transfers, order, by_rank);
    finer = std::move(order);
  }
  if (finest_) p_ = zeros<Vectors<F>>("plica::multigrid.p", A.rows);
}

/// Returns the order of a level's slots.
template <class B>
SlotOrder Multigrid<B>::order_of(const Grid& grid, const HostPattern& stored,
                                 const RankLevel<B>* part) const {
  constexpr int height = PackedRows<F>::height;
  return is_shared(grid) ? slot_order(stored, height, part->part, by_products(grid))
                         : slot_order(stored, height);
}

/// Makes what the ranks exchange of the finest level.
template <class B>
void Multigrid<B>::share(const RankLevel<B>& part, const HostPattern& A,
                         const std::vector<RowMatrix>& transfers, const SlotOrder& order,
                         const std::optional<RowsByRank>& by_rank) {
  Ranks& ranks = *part.ranks;
  SharedFinest<F>& shared = *shared_;
  shared.number = part.number;
  shared.items = {A.rows(), part.part.first_owned, part.part.last_owned};
  shared.blocks = numbers_of_blocks(ranks, part.part, part.given, A);
  shared.vertices =
      std::make_unique<Halo<F>>(ranks, "vertices of a cycle", part.vertex_rows, std::vector{3});
  shared.slots = std::make_unique<Halo<F>>(ranks, "slots of a cycle",
                                           rows_by_slots(part.vertex_rows, part.part, order),
                                           std::vector{1, 4});
  if (transfers.empty()) return;
  shared.galerkin =
      std::make_unique<SharedGalerkin<F>>(ranks, part.part, A, transfers.front(), *by_rank);
}

template <class B>
void Multigrid<B>::fit(const Exec& exec, const BlockMatrix<B>& A,
                       const Blocks<B>& inverse_diagonal) {
  const Grid& finest = grids_.front();
  convert(exec, "plica::multigrid_values", A.value, finest.A.value);
  convert(exec, "plica::multigrid_values", inverse_diagonal, finest.inverse_diagonal);
  if (finest_) largest_ = drift * largest_eigenvalue(exec, finest);
  refit(exec);
}

/// Fits all levels, from the finest level's matrix and blocks.
template <class B>
void Multigrid<B>::refit(const Exec& exec) {
  fit_smoother(exec, grids_.front());
  for (std::size_t i = 1; i < grids_.size(); ++i) {
    const Grid& grid = grids_[i];
    if (i == 1 && shared_)
      (*shared_->galerkin)(exec, grids_[0].A, grid.A);
    else
      galerkin_product<F>(exec, grid.map, grids_[i - 1].A, grid.A);
    if (!coarser_than(i)) return invert_coarsest(exec);
    update_vertices<F>(exec, "plica::invert_diagonal", grid.A.rows,
                       InvertDiagonal<F>{grid.A, grid.inverse_diagonal});
    fit_smoother(exec, grid);
  }
}

/// Fills the packed matrix, and finds the largest eigenvalue of D^-1 A.
template <class B>
void Multigrid<B>::fit_smoother(const Exec& exec, const Grid& grid) const {
  const PackedRows<F>& packed = grid.smoother.A;
  if (by_products(grid)) {
    fill(exec, packed.scale, 1.0F);
    return fill(exec, grid.smoother.largest, largest_);
  }
  update_vertices<F>(exec, "plica::pack_scales", packed.slots(), ScaleOfVertex<F>{grid.A, packed});
  if (is_shared(grid)) shared_->slots->exchange(exec, packed.scale.data(), 1);
  update_vertices<F>(exec, "plica::pack_rows", packed.slots(), PackRow<F>{grid.A, packed});
  update_vertices<F>(exec, "plica::pack_diagonal", packed.slots(),
                     TakeSlotBlocks<F, Blocks<F>>{packed.vertex, grid.inverse_diagonal,
                                                  grid.smoother.inverse_diagonal});
  fill(exec, grid.smoother.largest, largest_eigenvalue(exec, grid));
}

/// Returns the largest eigenvalue of D^-1 A by a few steps of Lanczos, plus their residual.
/// 1 where nothing is free to move.
template <class B>
double Multigrid<B>::largest_eigenvalue(const Exec& exec, const Grid& grid) const {
  const bool shared = is_shared(grid);
  const Items n = shared ? shared_->items : Items(grid.A.rows);
  const BlockSums<F>& sums = &grid == &grids_.front() ? sums_ : coarse_sums_;
  const auto& [r, z, w, last] = lanczos_;
  const auto square = [&](int k) { return Doubles<B>(scalars_.data() + k, 1); };
  const auto alpha = [&](int k) { return Doubles<B>(scalars_.data() + lanczos_steps + 1 + k, 1); };
  const CgSquare<F> size{grid.inverse_diagonal, r, z};
  update_vertices<F>(exec, "plica::lanczos_start", n.n,
                     BlockLanczosStart<F>{r, shared ? shared_->number : Indices<F>()});
  reduce<F, 1>(exec, "plica::lanczos_size", n, size, sums, square(0));
  for (int k = 0; k < lanczos_steps; ++k) {
    const LanczosProduct<F> product{square(k), z, w};
    if (by_products(grid)) {
      finest_->apply(exec, z, w);
      reduce<F, 1>(exec, "plica::lanczos_product", n, product, sums, alpha(k));
    } else {
      if (shared) shared_->vertices->exchange(exec, z.data(), 3);
      reduce<F, 1>(exec, "plica::lanczos_product", n, BlockLanczosProduct<F>{grid.A, product}, sums,
                   alpha(k));
    }
    reduce<F, 1>(exec, "plica::lanczos_next", n,
                 BlockLanczosNext<F>{size, square(k), alpha(k), w, last, k == 0}, sums,
                 square(k + 1));
  }
  const std::vector<double> scalars = host_values(exec, scalars_);
  std::vector<double> diagonal, beside;
  double next = 0;
  for (int k = 0; k < lanczos_steps && scalars[index_of(k)] > 0; ++k) {
    if (k > 0) beside.push_back(next);
    diagonal.push_back(scalars[index_of(lanczos_steps + 1 + k)]);
    next = std::sqrt(scalars[index_of(k + 1)]);
    if (!(next > 1e-5 * std::abs(diagonal.back()))) break;
  }
  if (diagonal.empty()) return 1;
  const dense::RitzBound top = dense::largest_ritz_bound(diagonal, beside, next);
  return top.value + top.residual;
}

/// Inverts the coarsest level's matrix.
/// On a device the sweep operator is used. Where the host shares the memory, Cholesky's method is
/// used, which is many times faster there. It needs a matrix that is positive definite except for
/// empty rows; else the sweep operator is used there, too.
template <class B>
void Multigrid<B>::invert_coarsest(const Exec& exec) const {
  const int n = coarsest_.size;
  update_vertices<F>(exec, "plica::to_dense", n / 3, ToDense<F>{grids_.back().A, coarsest_});
  if constexpr (B::on_host) {
    fence(exec, "plica::to_dense");
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

/// Sets r of the next coarser level from the residual of a level.
template <class B>
void Multigrid<B>::restrict_residual(const Exec& exec, std::size_t level,
                                     const Fours<F>& left) const {
  const Grid& grid = grids_[level];
  const auto to = [&](const auto& r) {
    if (is_shared(grid)) return (*shared_->restriction)(exec, left, r);
    update_vertices<F>(exec, "plica::restrict_residual", grid.down.rows,
                       RestrictFours<F, std::decay_t<decltype(r)>>{grid.down, left, r});
  };
  coarser_than(level + 1) ? to(grids_[level + 1].smoother.r) : to(coarsest_r_);
}

/// Returns an approximation of A^-1 r on a level, in one V-cycle from this level down.
/// Reads r of the level's smoother, and overwrites it.
template <class B>
Fours<Backend<float, typename B::Exec>> Multigrid<B>::cycle(const Exec& exec,
                                                            std::size_t level) const {
  const Grid& grid = grids_[level];
  if (level > 0 && !coarser_than(level)) {
    update_vertices<F>(exec, "plica::coarsest", ApplyDense<F>::items(coarsest_.size),
                       ApplyDense<F>{coarsest_, coarsest_r_, coarsest_x_});
    return coarsest_x_;
  }
  const PackedRows<F>& packed = grid.smoother.A;
  update_vertices<F>(exec, "plica::chebyshev_start", packed.items(),
                     ChebyshevStart<F>{grid.smoother, grid.d});
  if (!coarser_than(level)) return relax(exec, grid, 1, degree_ - 1, Leaves::answer);
  restrict_residual(exec, level, relax(exec, grid, 1, degree_, Leaves::residual));
  update_vertices<F>(exec, "plica::prolongate", packed.slots(),
                     ChebyshevCorrection<F>{packed.scale, grid.up, cycle(exec, level + 1), grid.d});
  return relax(exec, grid, 0, degree_ - 1, Leaves::answer);
}

/// Takes steps `first` to `last` of the polynomial, from the direction in grid.d.
/// Returns what the last step leaves, which `leaves` names.
template <class B>
Fours<Backend<float, typename B::Exec>> Multigrid<B>::relax(const Exec& exec, const Grid& grid,
                                                            int first, int last,
                                                            Leaves leaves) const {
  Fours<F> d = grid.d, next = grid.e;
  for (int k = first; k <= last; ++k, std::swap(d, next)) {
    const auto gain = static_cast<float>(8 * k + 4) / static_cast<float>(2 * k + 3);
    if (by_products(grid))
      multiply(exec, d);
    else if (is_shared(grid))
      shared_->slots->exchange(exec, d.data(), 4);
    update_vertices<F>(exec, "plica::chebyshev", grid.smoother.A.items(),
                       ChebyshevStep<F>{grid.smoother, d, next, k == 0 ? 0.0F : keep_of(k), gain,
                                        k == last ? leaves : Leaves::direction});
  }
  return d;
}

/// Sets the product A d of the finest level.
template <class B>
void Multigrid<B>::multiply(const Exec& exec, const Fours<F>& d) const {
  const Chebyshev<F>& finest = grids_.front().smoother;
  update_vertices<F>(exec, "plica::multigrid_out", finest.A.slots(),
                     PutSlots<F, Vectors<F>>{finest.A.vertex, d, p_});
  finest_->apply(exec, p_, finest.product);
}

template <class B>
void Multigrid<B>::apply(const Exec& exec, const Vectors<B>& r, const Vectors<B>& z) const {
  const Chebyshev<F>& finest = grids_.front().smoother;
  if (finest_)
    update_vertices<F>(exec, "plica::pack_diagonal", finest.A.slots(),
                       TakeSlotBlocks<F, Blocks<B>>{finest.A.vertex, finest_->inverse_diagonal(),
                                                    finest.inverse_diagonal});
  update_vertices<F>(exec, "plica::multigrid_in", finest.A.slots(),
                     TakeSlots<F, Vectors<B>>{finest.A.vertex, r, finest.r});
  update_vertices<F>(exec, "plica::multigrid_out", finest.A.slots(),
                     PutSlots<F, Vectors<B>>{finest.A.vertex, cycle(exec, 0), z});
}

template <class B>
void Multigrid<B>::name_fields(Archive<B>& archive) {
  if (finest_) archive.number(largest_);
  archive.field("the preconditioner's matrix", grids_.front().A.value,
                shared_ ? &shared_->blocks : nullptr);
  archive.field("the preconditioner's diagonal", grids_.front().inverse_diagonal,
                RowItems::vertices);
  if (shared_ && shared_->galerkin)
    shared_->galerkin->name_fields(archive), shared_->restriction->name_fields(archive);
  archive.owns(grids_, p_, coarsest_.matrix, coarsest_.row, coarsest_.inverse, coarsest_r_,
               coarsest_x_, lanczos_, sums_.view(), coarse_sums_.view(), scalars_);
}

#define PLICA_INSTANTIATE(Real, Exec) template class Multigrid<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
