// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <limits>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/implicit/conjugate_gradients.hpp>

namespace plica {

struct CgOutcome {
  int iterations = 0;
  double relative_residual = 0;  ///< |r|/|b| in the preconditioner's norm sqrt(r . D r)
  bool converged = false;
  double right_side = 0;    ///< |b| in that norm
  bool indefinite = false;  ///< met a direction without positive curvature and stopped there
};

/// Preconditioned conjugate gradients for A x = r with r in `c.r` on entry; x is left in `c.x`. product(p, q): q = A p.
/// `fixed` > 0: exactly so many iterations; else until the relative residual or `most` iterations.
template <class B, class Product>
CgOutcome conjugate_gradients(const typename B::Exec& exec, const CgVectors<B>& c, const BlockSums<B>& blocks, int n,
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
  CgOutcome out;
  out.right_side = std::sqrt(first);
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

}  // namespace plica
