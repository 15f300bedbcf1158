// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/drivers/solver/linear/krylov.hpp>
#include <plica/drivers/solver/spaces/sparse_rows.hpp>
#include <plica/kernels/explicit/updates.hpp>

namespace plica {

template <class B>
Krylov<B>::Krylov(int vertices)
    : z_("plica::cg.z", vertices),
      p_("plica::cg.p", vertices),
      q_("plica::cg.q", vertices),
      scalars_("plica::cg.scalars", cg::count),
      sums_(vertices) {}

template <class B>
void Krylov<B>::advance(const Exec& exec, const StageSystem<B>& system, const Preconditioner<B>* preconditioner,
                        double tolerance, const Vectors<B>& r, const Vectors<B>& x) const {
  const int n = system.rows();
  const Blocks<B>& D = system.inverse_diagonal();
  if (preconditioner) {
    preconditioner->apply(exec, r, z_);
    reduce<B, 1>(exec, "plica::cg_product", n, CgDot<B>{r, z_}, sums_, slot(cg::product));
  }
  update_vertices<B>(exec, "plica::cg_turn", 1, CgTurn<B>{scalars_, preconditioner ? cg::product : cg::square});
  update_vertices<B>(exec, "plica::cg_direction", n, CgDirection<B>{scalars_, z_, p_});
  system.product(exec, p_, q_);
  reduce<B, 1>(exec, "plica::cg_curvature", n, CgDot<B>{p_, q_}, sums_, slot(cg::curvature));
  update_vertices<B>(exec, "plica::cg_step", 1, CgStep<B>{scalars_});
  reduce<B, 1>(exec, "plica::cg_advance", n, CgAdvance<B>{scalars_, {D, r, z_}, x, p_, q_}, sums_, slot(cg::square));
  update_vertices<B>(exec, "plica::cg_judge", 1, CgJudge<B>{scalars_, tolerance});
}

template <class B>
void Krylov<B>::begin(const Exec& exec, const StageSystem<B>& system, const LastSolutions<B>* last, double tolerance,
                      const Vectors<B>& r, const Vectors<B>& x) const {
  const CgSquare<B> square{system.inverse_diagonal(), r, z_};
  reduce<B, 1>(exec, "plica::cg_zero", system.rows(), CgZero<B>{square, x}, sums_, slot(cg::square));
  update_vertices<B>(exec, "plica::cg_begin", 1, CgBegin<B>{scalars_});
  if (!last || !last->any()) return;
  last->start(exec, system, sums_, r, x);
  reduce<B, 1>(exec, "plica::cg_square", system.rows(), square, sums_, slot(cg::square));
  update_vertices<B>(exec, "plica::cg_guess", 1, CgGuess<B>{scalars_, tolerance});
}

template <class B>
KrylovOutcome Krylov<B>::solve(const Exec& exec, const StageSystem<B>& system, const Preconditioner<B>* preconditioner,
                               const LastSolutions<B>* last, const ImplicitOptions& options, const Vectors<B>& r,
                               const Vectors<B>& x) const {
  const auto host = Kokkos::create_mirror_view(Kokkos::HostSpace(), scalars_);
  const auto look = [&] {
    Kokkos::deep_copy(exec, host, scalars_);
    exec.fence("plica::cg");
  };
  const bool fixed = options.iterations > 0;
  const int most = fixed ? options.iterations : options.max_iterations;
  const double tolerance = fixed ? -1.0 : options.relative_residual;
  begin(exec, system, last, tolerance, r, x);
  for (int i = 0; i < most; ++i) {
    if (!fixed && i % watch == 0) {
      look();
      if (host(cg::stopped) != cg::running) break;
    }
    advance(exec, system, preconditioner, tolerance, r, x);
  }
  look();
  KrylovOutcome out;
  out.iterations = static_cast<int>(host(cg::iterations));
  out.indefinite = host(cg::stopped) == cg::indefinite;
  out.converged = host(cg::stopped) == cg::converged || (fixed && host(cg::stopped) == cg::running);
  out.relative_residual = host(cg::right_side) > 0 ? std::sqrt(host(cg::square) / host(cg::right_side)) : 0;
  if (host(cg::square) > 0) out.decades = 0.5 * std::log10(host(cg::start) / host(cg::square));
  if (host(cg::stopped) == cg::not_finite) {  // which must show in the state, for whoever checks it
    if (out.iterations == 0) Kokkos::deep_copy(exec, x, r);
    out.relative_residual = std::numeric_limits<double>::infinity();
  }
  return out;
}

template <class B>
std::size_t Krylov<B>::bytes() const {
  return bytes_of_views(z_, p_, q_, scalars_, sums_.view());
}

#define PLICA_INSTANTIATE(Real, Exec) template class Krylov<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
