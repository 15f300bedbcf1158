// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/drivers/linear/krylov.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

template <class B>
LastSolutions<B>::LastSolutions(int vertices) {
  for (auto& w : space_.w) w = zeros<Vectors<B>>("plica::last_solutions.w", vertices);
  for (auto& q : space_.q) q = zeros<Vectors<B>>("plica::last_solutions.q", vertices);
  space_.products = zeros<Doubles<B>>("plica::last_solutions.products", SolutionSpace<B>::sums);
}

template <class B>
void LastSolutions<B>::start(const Exec& exec, const StageSystem<B>& system,
                             const BlockSums<B>& sums, const Vectors<B>& r,
                             const Vectors<B>& x) const {
  if (!any()) return;
  const int n = system.rows();
  constexpr double least = 1e4 * Kokkos::Experimental::epsilon_v<typename B::Real>;
  system.products(exec, space_);
  reduce<B, SolutionSpace<B>::sums>(exec, "plica::space_sums", system.items(),
                                    SpaceSums<B>{space_, r}, sums, space_.products,
                                    SpaceWeights<B>{space_.products, least});
  update_vertices<B>(exec, "plica::space_guess", n, SpaceGuess<B>{space_, r, x});
}

template <class B>
void LastSolutions<B>::add(const Exec& exec, const Vectors<B>& x) {
  copy(exec, space_.w[count_++ % SolutionSpace<B>::size], x);
}

template <class B>
void LastSolutions<B>::name_fields(Archive<B>& archive) {
  archive.number(count_);
  for (const auto& w : space_.w) archive.field("a last solution", w, RowItems::vertices);
  archive.owns(space_.q, space_.products);
}

template <class B>
Krylov<B>::Krylov(int vertices, Ranks* ranks)
    : z_(zeros<Vectors<B>>("plica::cg.z", vertices)),
      p_(zeros<Vectors<B>>("plica::cg.p", vertices)),
      q_(zeros<Vectors<B>>("plica::cg.q", vertices)),
      scalars_(zeros<Doubles<B>>("plica::cg.scalars", cg::count)),
      sums_(vertices, ranks) {}

template <class B>
void Krylov<B>::advance(const Exec& exec, const StageSystem<B>& system,
                        const Preconditioner<B>* preconditioner, const Vectors<B>& r,
                        const Vectors<B>& x) const {
  const int n = system.rows();
  const Blocks<B>& D = system.inverse_diagonal();
  const int product = preconditioner ? cg::product : cg::square;
  if (preconditioner) {
    preconditioner->apply(exec, r, z_);
    system.hold(exec, z_);
    reduce<B, 1>(exec, "plica::cg_product", system.items(), Dot<B>{r, z_}, sums_, slot(product));
  }
  update_vertices<B>(exec, "plica::cg_direction", n, CgDirection<B>{scalars_, product, z_, p_});
  system.product(exec, p_, q_, sums_, slot(cg::curvature), CgStep<B>{scalars_, product});
  reduce<B, 1>(exec, "plica::cg_advance", system.items(),
               CgAdvance<B>{scalars_, {D, r, z_}, x, p_, q_}, sums_, slot(cg::square),
               CgJudge<B>{scalars_});
}

template <class B>
void Krylov<B>::begin(const Exec& exec, const StageSystem<B>& system, const LastSolutions<B>* last,
                      double tolerance, const Vectors<B>& r, const Vectors<B>& x) const {
  const CgSquare<B> square{system.inverse_diagonal(), r, z_};
  update_vertices<B>(exec, "plica::cg_tolerance", 1, CgTolerance<B>{scalars_, tolerance});
  reduce<B, 1>(exec, "plica::cg_zero", system.items(), CgZero<B>{square, x}, sums_,
               slot(cg::square), CgBegin<B>{scalars_});
  if (!last || !last->any()) return;
  last->start(exec, system, sums_, r, x);
  reduce<B, 1>(exec, "plica::cg_square", system.items(), square, sums_, slot(cg::square),
               CgGuess<B>{scalars_});
}

template <class B>
KrylovOutcome Krylov<B>::solve(const Exec& exec, const StageSystem<B>& system,
                               const Preconditioner<B>* preconditioner,
                               const LastSolutions<B>* last, const ImplicitOptions& options,
                               const Vectors<B>& r, const Vectors<B>& x) const {
  std::vector<double> scalar;
  const auto look = [&] { scalar = host_values(exec, scalars_); };
  const bool fixed = options.iterations > 0;
  const int most = fixed ? options.iterations : options.max_iterations;
  const double tolerance = fixed ? -1.0 : options.relative_residual;
  begin(exec, system, last, tolerance, r, x);
  for (int i = 0; i < most; ++i) {
    if (!fixed && i % watch == 0) {
      look();
      if (scalar[cg::stopped] != cg::running) break;
    }
    advance(exec, system, preconditioner, r, x);
  }
  look();
  KrylovOutcome out;
  out.iterations = static_cast<int>(scalar[cg::iterations]);
  out.indefinite = scalar[cg::stopped] == cg::indefinite;
  out.converged =
      scalar[cg::stopped] == cg::converged || (fixed && scalar[cg::stopped] == cg::running);
  out.relative_residual =
      scalar[cg::right_side] > 0 ? std::sqrt(scalar[cg::square] / scalar[cg::right_side]) : 0;
  if (scalar[cg::square] > 0)
    out.decades = 0.5 * std::log10(scalar[cg::start] / scalar[cg::square]);
  // A solve that is not finite must show in the state, so that checks find it.
  if (scalar[cg::stopped] == cg::not_finite) {
    if (out.iterations == 0) copy(exec, x, r);
    out.relative_residual = std::numeric_limits<double>::infinity();
  }
  return out;
}

#define PLICA_INSTANTIATE(Real, Exec)                \
  template class LastSolutions<Backend<Real, Exec>>; \
  template class Krylov<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
