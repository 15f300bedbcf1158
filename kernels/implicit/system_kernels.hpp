// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/implicit_weights.hpp>
#include <plica/core/model.hpp>
#include <plica/core/small.hpp>

// Vertex kernels of the system of an implicit stage, A = (1 + b c) M + a K* + contact blocks; see ImplicitWeights. Rows of
// vertices whose motion is given are zero in the preconditioner, which keeps every search direction zero there.
namespace plica {

template <class B>
using Blocks = Kokkos::View<typename B::Real* [6], Kokkos::LayoutRight, typename B::Memory>;

/// q = (1 + b c) M p - a * (sum of the copies of -K p)
template <class B>
struct SystemProduct {
  using Real = typename B::Real;
  Model<B> model;
  Vectors<B> p, partial, q;
  Real a, b;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const Patches<B>& patches = model.patches;
    Vec3<Real> sum;
    for (int s = patches.first_copy(i); s < patches.first_copy(i + 1); ++s)
      for (int k = 0; k < 3; ++k) sum[k] += partial(patches.copy(s), k);
    const Real inertia = (1 + b * model.damping(i)) * model.mass(i);
    for (int k = 0; k < 3; ++k) q(i, k) = inertia * p(i, k) - a * sum[k];
  }
};

/// Vertex blocks of A: (1 + b c) m on the diagonal, plus a times column `direction` of the stiffness' own block.
template <class B>
struct DiagonalColumn {
  using Real = typename B::Real;
  Model<B> model;
  Vectors<B> partial;
  Blocks<B> diagonal;
  Real a, b;
  int direction;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const Patches<B>& patches = model.patches;
    Vec3<Real> sum;
    for (int s = patches.first_copy(i); s < patches.first_copy(i + 1); ++s)
      for (int k = 0; k < 3; ++k) sum[k] += partial(patches.copy(s), k);
    diagonal(i, direction) = (1 + b * model.damping(i)) * model.mass(i) + a * sum[direction];
    if (direction > 0) diagonal(i, 3) = direction == 1 ? a * sum[0] : diagonal(i, 3);
    if (direction == 2) diagonal(i, 4) = a * sum[0], diagonal(i, 5) = a * sum[1];
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
  Real b;

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
      for (int k = 0; k < 6; ++k) d(a, k) = k < 3 ? 1 / ((1 + b * model.damping(a)) * model.mass(a)) : Real(0);
    }
  }
};

}  // namespace plica
