// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/material.hpp>
#include <plica/kernels/patch_kernel.hpp>

namespace plica {

/// How much of the stiffness of a patch's elements counts: 1, and its part that damps over a time.
template <class B>
struct TangentScale {
  using Real = typename B::Real;
  Scalars<B> damping;  ///< [patches] s, or empty
  Real over = 0;       ///< [1/s]
  KOKKOS_INLINE_FUNCTION Real operator()(int patch) const {
    return damping.extent(0) > 0 ? 1 + over * damping(patch) : Real(1);
  }
};

/// Minus the tangent stiffness times a direction, (-K(u) p)_a = -V (dP/dF : grad p) grad N_a: the change of the internal
/// force [N] for a change p of the displacement [m], matrix-free.
template <class B, class Material>
struct ElasticTangent {
  static constexpr int fields = 2;
  Vectors<B> field[2];   ///< u, p
  Scalars<B> constants;  ///< of the patches
  TangentScale<B> scale;
  Scalars<B> fibres = {};  ///< likewise, or empty

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[2], const ElementShape<T>& shape, Vec3<T> (&corner)[4],
                                         int patch, int pack) const {
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    const auto c = load_constants<Material, T>(constants, patch, fibres, pack * B::lanes);
    stress_to_corners(T(scale(patch)) * Material::stress_change(F, G[1], c), shape, corner);
  }
};

/// Column `direction` of every vertex's own 3x3 block of K(u): the force at a vertex for its own unit displacement.
template <class B, class Material>
struct ElasticDiagonal {
  static constexpr int fields = 1;
  Vectors<B> field[1];
  Scalars<B> constants;  ///< of the patches
  int direction;
  TangentScale<B> scale;
  Scalars<B> fibres = {};  ///< likewise, or empty

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const ElementShape<T>& shape, Vec3<T> (&corner)[4],
                                         int patch, int pack) const {
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    const T weight = T(scale(patch)) * shape.volume;
    const auto constant = load_constants<Material, T>(constants, patch, fibres, pack * B::lanes);
    for (int c = 0; c < 4; ++c) {
      const Vec3<T> g =
          c > 0 ? shape.gradient[c - 1] : T(-1) * (shape.gradient[0] + shape.gradient[1] + shape.gradient[2]);
      Mat3<T> dF;
      for (int r = 0; r < 3; ++r) dF[r] = r == direction ? g : Vec3<T>{};
      corner[c] = weight * (Material::stress_change(F, dF, constant) * g);
    }
  }
};

template <class B, class Material>
void elastic_tangent(const typename B::Exec& exec, const Patches<B>& patches, const Vectors<B>& u, const Vectors<B>& p,
                     double over, const Vectors<B>& partial) {
  launch_patches<B>(
      exec, "plica::elastic_tangent", patches,
      ElasticTangent<B, Material>{
          {u, p}, patches.constants, {patches.damping, static_cast<typename B::Real>(over)}, patches.fibres},
      partial);
}

template <class B, class Material>
void elastic_diagonal(const typename B::Exec& exec, const Patches<B>& patches, const Vectors<B>& u, int direction,
                      double over, const Vectors<B>& partial) {
  launch_patches<B>(
      exec, "plica::elastic_diagonal", patches,
      ElasticDiagonal<B, Material>{
          {u}, patches.constants, direction, {patches.damping, static_cast<typename B::Real>(over)}, patches.fibres},
      partial);
}

}  // namespace plica
