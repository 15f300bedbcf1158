// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/contact/gap.hpp>

namespace plica {

/// The solid below a plane through `point` with unit normal `normal`.
struct Plane {
  static constexpr const char* name = "plane";
  static constexpr const char* summary = "the half-space below a plane: point, normal";
  template <class Real>
  struct Shape {
    Vec3<Real> point, normal;
    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const { return {dot(normal, x - point), normal}; }
  };
};

}  // namespace plica
