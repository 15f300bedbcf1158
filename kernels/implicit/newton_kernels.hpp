// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/core/small.hpp>

// Vertex kernels of implicit Euler. The unknown is the change dv of the end velocity v* at which the forces were linearised:
//   A dv = M (v0 - v*) + h (f* - c M v*) - h K* (u0 + h v* - u*),   A = (1 + h c) M + h^2 K* + contact blocks
// In the first iteration u* = u0 and v* = v0, which leaves -h^2 K* v0 of the last term; later u* = u0 + h v* and nothing. Rows of vertices whose motion is given are zero in the
// preconditioner, which keeps every search direction zero there.
namespace plica {

template <class B>
using Blocks = Kokkos::View<typename B::Real* [6], Kokkos::LayoutRight, typename B::Memory>;

/// b, with the copies of -K* v0 in `partial` where it is the first iteration
template <class B>
struct NewtonRightSide {
  using Real = typename B::Real;
  Model<B> model;
  Vectors<B> v0, v, f, partial, b;
  Real h, damping;
  bool first;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Real m = model.mass(a);
    Vec3<Real> sum;
    if (first)
      for (int s = model.patches.first_copy(a); s < model.patches.first_copy(a + 1); ++s)
        for (int k = 0; k < 3; ++k) sum[k] += partial(model.patches.copy(s), k);
    for (int k = 0; k < 3; ++k)
      b(a, k) = model.inverse_mass(a) > 0
                    ? m * (v0(a, k) - v(a, k)) + h * (f(a, k) - damping * m * v(a, k)) + h * h * sum[k]
                    : Real(0);
  }
};

/// q = (1 + h c) M p - h^2 * (sum of the copies of -K p)
template <class B>
struct NewtonProduct {
  using Real = typename B::Real;
  Patches<B> patches;
  Scalars<B> mass;
  Vectors<B> p, partial, q;
  Real inertia, h2;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    Vec3<Real> sum;
    for (int s = patches.first_copy(a); s < patches.first_copy(a + 1); ++s)
      for (int k = 0; k < 3; ++k) sum[k] += partial(patches.copy(s), k);
    for (int k = 0; k < 3; ++k) q(a, k) = inertia * mass(a) * p(a, k) - h2 * sum[k];
  }
};

/// Vertex blocks of A: (1 + h c) m on the diagonal, plus h^2 times column `direction` of the stiffness' own block.
template <class B>
struct DiagonalColumn {
  using Real = typename B::Real;
  Patches<B> patches;
  Scalars<B> mass;
  Vectors<B> partial;
  Blocks<B> diagonal;
  Real inertia, h2;
  int direction;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    Vec3<Real> sum;
    for (int s = patches.first_copy(a); s < patches.first_copy(a + 1); ++s)
      for (int k = 0; k < 3; ++k) sum[k] += partial(patches.copy(s), k);
    diagonal(a, direction) = inertia * mass(a) + h2 * sum[direction];
    if (direction > 0) diagonal(a, 3) = direction == 1 ? h2 * sum[0] : diagonal(a, 3);
    if (direction == 2) diagonal(a, 4) = h2 * sum[0], diagonal(a, 5) = h2 * sum[1];
  }
};

/// q += scale * block p, and diagonal += scale * block, with symmetric vertex blocks that are not from elements.
template <class B>
struct AddBlockProduct {
  using Real = typename B::Real;
  Blocks<B> block;
  Vectors<B> p, q;
  Real scale;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Real x = scale * p(a, 0), y = scale * p(a, 1), z = scale * p(a, 2);
    q(a, 0) += block(a, 0) * x + block(a, 3) * y + block(a, 4) * z;
    q(a, 1) += block(a, 3) * x + block(a, 1) * y + block(a, 5) * z;
    q(a, 2) += block(a, 4) * x + block(a, 5) * y + block(a, 2) * z;
  }
};

template <class B>
struct AddBlocks {
  using Real = typename B::Real;
  Blocks<B> block, diagonal;
  Real scale;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 6; ++k) diagonal(a, k) += scale * block(a, k);
  }
};

/// Inverts the vertex blocks in place. A block that is not positive definite (a material that softens) gives way to its mass.
template <class B>
struct InvertBlocks {
  using Real = typename B::Real;
  Model<B> model;
  Blocks<B> d;
  Real inertia;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    const Real xx = d(a, 0), yy = d(a, 1), zz = d(a, 2), xy = d(a, 3), xz = d(a, 4), yz = d(a, 5);
    const Real cx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - yy * xz;
    const Real det = xx * cx + xy * cxy + xz * cxz;
    if (!(model.inverse_mass(a) > 0)) {
      for (int k = 0; k < 6; ++k) d(a, k) = 0;
    } else if (xx > 0 && xx * yy - xy * xy > 0 && det > 0) {
      const Real s = 1 / det;
      d(a, 0) = s * cx, d(a, 1) = s * (xx * zz - xz * xz), d(a, 2) = s * (xx * yy - xy * xy);
      d(a, 3) = s * cxy, d(a, 4) = s * cxz, d(a, 5) = s * (xy * xz - xx * yz);
    } else {
      for (int k = 0; k < 6; ++k) d(a, k) = k < 3 ? 1 / (inertia * model.mass(a)) : Real(0);
    }
  }
};

/// The end of an iteration: v* += dv, u* = u0 + h v*; given motions keep their velocity (dv is zero there).
template <class B>
struct NewtonUpdate {
  using Real = typename B::Real;
  Vectors<B> u0, dv, u, v;
  Real h;

  KOKKOS_INLINE_FUNCTION void operator()(int a) const {
    for (int k = 0; k < 3; ++k) {
      v(a, k) += dv(a, k);
      u(a, k) = u0(a, k) + h * v(a, k);
    }
  }
};

}  // namespace plica
