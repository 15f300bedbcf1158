// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>
#include <plica/kernels/contact/penalty.hpp>

namespace plica {

/// Surface points that are attached to another body: each by a spring and a damper to one place on one of its triangles.
template <class B>
struct AttachedPoints {
  using Real = typename B::Real;
  static constexpr int none = -1, beside = -2;
  /// [points] which one holds it; beside: another point is held at a triangle of it, so that it touches nothing either; none; empty: no
  /// attachments at all
  Indices<B> attachment;
  Indices<B> triangle;                                      ///< [points]
  Vectors<B> weight;                                        ///< [points][3] of its corners
  Kokkos::View<PenaltyLaw<Real>*, typename B::Memory> law;  ///< [attachments] stiffness and damping, in all directions

  KOKKOS_INLINE_FUNCTION bool ties(int p) const { return attachment.extent(0) > 0 && attachment(p) != none; }
  KOKKOS_INLINE_FUNCTION bool holds(int p) const { return attachment.extent(0) > 0 && attachment(p) >= 0; }
};

}  // namespace plica
