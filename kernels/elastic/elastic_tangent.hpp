// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/patch_kernel.hpp>

namespace plica {

/// Minus the tangent stiffness times a direction, (-K(u) p)_a = -V (dP/dF : grad p) grad N_a: the change of the internal
/// force [N] for a change p of the displacement [m], matrix-free.
template <class B, class Material>
struct ElasticTangent {
  static constexpr int fields = 2;
  Vectors<B> field[2];  ///< u, p

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[2], const ElementShape<T>& shape, Vec3<T> (&corner)[4], int,
                                         int) const {
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    stress_to_corners(Material::stress_change(F, G[1], shape.lame), shape, corner);
  }
};

/// Column `direction` of every vertex's own 3x3 block of K(u): the force at a vertex for its own unit displacement.
template <class B, class Material>
struct ElasticDiagonal {
  static constexpr int fields = 1;
  Vectors<B> field[1];
  int direction;

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const ElementShape<T>& shape, Vec3<T> (&corner)[4], int,
                                         int) const {
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    for (int c = 0; c < 4; ++c) {
      const Vec3<T> g =
          c > 0 ? shape.gradient[c - 1] : T(-1) * (shape.gradient[0] + shape.gradient[1] + shape.gradient[2]);
      Mat3<T> dF;
      for (int r = 0; r < 3; ++r) dF[r] = r == direction ? g : Vec3<T>{};
      corner[c] = shape.volume * (Material::stress_change(F, dF, shape.lame) * g);
    }
  }
};

template <class B, class Material>
void elastic_tangent(const typename B::Exec& exec, const Patches<B>& patches, const Vectors<B>& u, const Vectors<B>& p,
                     const Vectors<B>& partial) {
  launch_patches<B>(exec, "plica::elastic_tangent", patches, ElasticTangent<B, Material>{{u, p}}, partial);
}

template <class B, class Material>
void elastic_diagonal(const typename B::Exec& exec, const Patches<B>& patches, const Vectors<B>& u, int direction,
                      const Vectors<B>& partial) {
  launch_patches<B>(exec, "plica::elastic_diagonal", patches, ElasticDiagonal<B, Material>{{u}, direction}, partial);
}

}  // namespace plica
