// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/kernels/implicit/system_kernels.hpp>
#include <plica/kernels/reduce.hpp>

// The vector work of preconditioned conjugate gradients, fused so that every vector is read once per step of the iteration
// (Saad, Iterative Methods for Sparse Linear Systems, alg. 9.1). Scalars stay on the device: scalar(0) = p.q; scalar(1) and
// scalar(2) = r.z of this and the last iteration, in turns: `last` says which is the older.
namespace plica {

template <class B>
struct CgVectors {
  Vectors<B> x, r;  ///< the caller's
  Vectors<B> z, p, q;
  Blocks<B> preconditioner;
  Kokkos::View<double*, typename B::Memory> scalar;

  CgVectors() = default;
  explicit CgVectors(int n)
      : z("plica::cg.z", n),
        p("plica::cg.p", n),
        q("plica::cg.q", n),
        preconditioner("plica::cg.preconditioner", n),
        scalar("plica::cg.scalar", 3) {}

  KOKKOS_INLINE_FUNCTION double precondition(int a) const {  // z = D r at one vertex, and r.z
    const auto& d = preconditioner;
    const typename B::Real r0 = r(a, 0), r1 = r(a, 1), r2 = r(a, 2);
    z(a, 0) = d(a, 0) * r0 + d(a, 3) * r1 + d(a, 4) * r2;
    z(a, 1) = d(a, 3) * r0 + d(a, 1) * r1 + d(a, 5) * r2;
    z(a, 2) = d(a, 4) * r0 + d(a, 5) * r1 + d(a, 2) * r2;
    return static_cast<double>(r0 * z(a, 0) + r1 * z(a, 1) + r2 * z(a, 2));
  }
};

/// x = 0, z = D r, p = z; r.z
template <class B>
struct CgStart {
  CgVectors<B> c;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    const double rz = c.precondition(a);
    for (int k = 0; k < 3; ++k) c.x(a, k) = 0, c.p(a, k) = c.z(a, k);
    return {{rz}};
  }
};

template <class B>
struct CgCurvature {
  CgVectors<B> c;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += static_cast<double>(c.p(a, k) * c.q(a, k));
    return {{sum}};
  }
};

/// x += alpha p, r -= alpha q, z = D r; r.z. Directions of no positive curvature are not followed: alpha = 0.
template <class B>
struct CgAdvance {
  CgVectors<B> c;
  int last;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int a) const {
    using Real = typename B::Real;
    const double pq = c.scalar(0);
    const Real alpha = static_cast<Real>(pq > 0 ? c.scalar(last) / pq : 0.0);
    for (int k = 0; k < 3; ++k) c.x(a, k) += alpha * c.p(a, k), c.r(a, k) -= alpha * c.q(a, k);
    return {{c.precondition(a)}};
  }
};

/// p = z + (r.z / last r.z) p
template <class B>
struct CgDirection {
  CgVectors<B> c;
  int last;
  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    using Real = typename B::Real;
    const Real beta = static_cast<Real>(c.scalar(last) > 0 ? c.scalar(3 - last) / c.scalar(last) : 0.0);
    for (int k = 0; k < 3; ++k) c.p(a, k) = c.z(a, k) + beta * c.p(a, k);
  }
};

}  // namespace plica
