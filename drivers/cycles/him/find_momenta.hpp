// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/kernels/halo.hpp>
#include <plica/kernels/him/momentum_of.hpp>
#include <plica/kernels/vectors.hpp>

// Symbols of cmake/docs/explanation/him.md: A is the argument A(p, v), which sets v = A p; p are
// the momenta.
namespace plica {

/// Solves A p = v for p by conjugate gradients preconditioned by the mass, to 1e-6 of v. Waits.
/// It takes about sqrt(inertia added) iterations at most.
template <class B>
void momentum_of(const typename B::Exec& exec, const LevelData<B>& level,
                 const std::function<void(const Vectors<B>& p, const Vectors<B>& v)>& A,
                 const Vectors<B>& v, const Vectors<B>& p) {
  using Real = typename B::Real;
  constexpr int most_iterations = 300;
  constexpr double tolerance = 1e-6;
  const Model<B>& model = level.model;
  const Items owned = vertices_of<B>(level);
  const auto size = static_cast<std::size_t>(model.vertices);
  const auto r = zeros<Vectors<B>>("plica::momentum.r", size),
             s = zeros<Vectors<B>>("plica::momentum.s", size),
             As = zeros<Vectors<B>>("plica::momentum.As", size);
  const BlockSums<B> blocks(model.vertices, ranks_of<B>(level));
  const auto sum = zeros<Doubles<B>>("plica::momentum.sum", 1);
  const auto read = [&](const auto& term) {
    reduce<B, 1>(exec, "plica::momentum", owned, term, blocks, sum);
    return host_values(exec, sum)[0];
  };
  weigh<B>(exec, "plica::momentum", model, 1, v, 0, v, p);
  const double whole = read(StartResidual<B>{model, v, As, r});  // v.m v, since As is 0
  A(p, As);
  double square = read(StartResidual<B>{model, v, As, r});
  double beta = 0;
  const double enough = tolerance * tolerance * whole;
  for (int i = 0; i < most_iterations && square > enough; ++i) {
    weigh<B>(exec, "plica::momentum", model, 1, r, static_cast<Real>(beta), s, s);
    A(s, As);
    const double alpha = square / read(Dot<B>{s, As});
    const double next = read(MoveAlong<B>{model, s, As, p, r, static_cast<Real>(alpha)});
    beta = next / square, square = next;
  }
}

}  // namespace plica
