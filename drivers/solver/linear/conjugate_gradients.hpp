// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <limits>
#include <plica/drivers/solver/linear/linear_solver.hpp>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/implicit/conjugate_gradients.hpp>

namespace plica {

/// Preconditioned conjugate gradients for A x = r with r in `c.r` on entry; x is left in `c.x`. product(p, q): q = A p. The
/// residual is taken in the preconditioner's norm sqrt(r . D r). `fixed` > 0: exactly so many iterations; else until the
/// relative residual or `most` iterations.
template <class B, class Product>
SolveOutcome conjugate_gradients(const typename B::Exec& exec, const CgVectors<B>& c, const BlockSums<B>& blocks, int n,
                                 double tolerance, int fixed, int most, const Product& product) {
  const auto scalars = Kokkos::create_mirror_view(Kokkos::HostSpace(), c.scalar);
  const auto slot = [&](int k) { return Kokkos::View<double*, typename B::Memory>(c.scalar.data() + k, 1); };
  const auto read = [&] {
    Kokkos::deep_copy(exec, scalars, c.scalar);
    exec.fence("plica::cg");
  };
  reduce<B, 1>(exec, "plica::cg_start", n, CgStart<B>{c}, blocks, slot(2));
  read();
  const double first = scalars(2);
  SolveOutcome out;
  out.converged = first == 0;
  if (!std::isfinite(first)) {  // forces that are not finite must show in the state, for whoever checks it
    Kokkos::deep_copy(exec, c.x, c.r);
    out.relative_residual = std::numeric_limits<double>::infinity();
    return out;
  }
  int last = 2;
  while (!out.converged && out.iterations < (fixed > 0 ? fixed : most)) {
    product(c.p, c.q);
    reduce<B, 1>(exec, "plica::cg_curvature", n, CgCurvature<B>{c}, blocks, slot(0));
    reduce<B, 1>(exec, "plica::cg_advance", n, CgAdvance<B>{c, last}, blocks, slot(3 - last));
    read();
    out.indefinite = !(scalars(0) > 0);
    if (out.indefinite) break;
    ++out.iterations;
    out.relative_residual = std::sqrt(scalars(3 - last) / first);  // not a number stays so, and is no convergence
    if (fixed == 0 && out.relative_residual <= tolerance) out.converged = true;
    if (!out.converged) update_vertices<B>(exec, "plica::cg_direction", n, CgDirection<B>{c, last});
    last = 3 - last;
  }
  if (fixed > 0) out.converged = !out.indefinite && std::isfinite(out.relative_residual);
  return out;
}

/// Conjugate gradients without a matrix, preconditioned by the vertices' own 3x3 blocks.
template <class B>
class ConjugateGradients final : public LinearSolver<B> {
 public:
  using Exec = typename B::Exec;

  ConjugateGradients(int vertices, const ImplicitOptions& options)
      : options_(options), cg_(vertices), blocks_(vertices) {}

  void prepare(const Exec& exec, const Level<B>& level, const LevelForces<B>& forces, const State<B>& state,
               const ImplicitWeights& weights, bool) override {
    level_ = &level, forces_ = &forces, state_ = state, weights_ = weights;
    forces.diagonal(level, state, weights, cg_.preconditioner);
    update_vertices<B>(exec, "plica::invert_blocks", level.model.vertices,
                       InvertBlocks<B>{level.model, cg_.preconditioner, static_cast<typename B::Real>(weights.b)});
  }
  SolveOutcome solve(const Exec& exec, const Vectors<B>& r, const Vectors<B>& x) override {
    CgVectors<B> c = cg_;
    c.r = r, c.x = x;
    return conjugate_gradients<B>(
        exec, c, blocks_, level_->model.vertices, options_.relative_residual, options_.iterations,
        options_.max_iterations,
        [&](const Vectors<B>& p, const Vectors<B>& q) { forces_->product(*level_, state_, p, weights_, q); });
  }
  std::size_t bytes() const override { return (9 + 6) * sizeof(typename B::Real) * cg_.p.extent(0); }

 private:
  ImplicitOptions options_;
  CgVectors<B> cg_;
  BlockSums<B> blocks_;
  const Level<B>* level_ = nullptr;
  const LevelForces<B>* forces_ = nullptr;
  State<B> state_;
  ImplicitWeights weights_;
};

}  // namespace plica
