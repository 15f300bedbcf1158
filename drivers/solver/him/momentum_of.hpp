// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/core/level.hpp>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/him/leapfrog.hpp>
#include <plica/kernels/him/momentum_of.hpp>

namespace plica {

/// p with A p = v, by conjugate gradients preconditioned by the mass, to 1e-12 of v (1e-6 in float): at most sqrt(inertia added)
/// iterations or so. Waits.
template <class B>
void momentum_of(const typename B::Exec& exec, const Model<B>& model,
                 const std::function<void(const Vectors<B>& p, const Vectors<B>& v)>& A, const Vectors<B>& v,
                 const Vectors<B>& p) {
  using Real = typename B::Real;
  constexpr int most_iterations = 300;
  constexpr double tolerance = sizeof(Real) == 8 ? 1e-12 : 1e-6;
  const int n = model.vertices;
  const auto size = static_cast<std::size_t>(n);
  const Vectors<B> r("plica::momentum.r", size), s("plica::momentum.s", size), As("plica::momentum.As", size);
  const BlockSums<B> blocks(n);
  const Kokkos::View<double*, typename B::Memory> sum("plica::momentum.sum", 1);
  const auto read = [&](const auto& term) {
    reduce<B, 1>(exec, "plica::momentum", n, term, blocks, sum);
    exec.fence("plica::momentum");
    return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), sum)(0);
  };
  update_vertices<B>(exec, "plica::momentum", n, PlainMomentum<B>{model, v, p});
  const double whole = read(StartResidual<B>{model, v, As, r});  // As is still 0
  A(p, As);
  double square = read(StartResidual<B>{model, v, As, r});
  Kokkos::deep_copy(exec, s, Real(0));
  double beta = 0;
  const double enough = tolerance * tolerance * whole;
  for (int i = 0; i < most_iterations && square > enough; ++i) {
    update_vertices<B>(exec, "plica::momentum", n, NextDirection<B>{model, r, s, static_cast<Real>(beta)});
    A(s, As);
    const double alpha = square / read(DotFree<B>{model, s, As});
    const double next = read(MoveAlong<B>{model, s, As, p, r, static_cast<Real>(alpha)});
    beta = next / square, square = next;
  }
}

}  // namespace plica
