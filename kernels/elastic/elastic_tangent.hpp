// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/elastic/damping_stress.hpp>
#include <plica/kernels/patch_kernel.hpp>

namespace plica {

/// Product of minus the tangent stiffness with a direction: (-K(u) p)_a = -V (dP/dF : grad p) grad
/// N_a. It is the change of the internal force [N] for a change p of the displacement [m],
/// matrix-free. Damped: with -D(u) p.
template <class B, class Material, bool Damped = false>
struct ElasticTangent {
  static constexpr int fields = 2;
  Vectors<B> field[2];   ///< u, p
  Scalars<B> constants;  ///< [patches] constants of the material
  DampingRate<B> rate;
  Scalars<B> fibres = {};  ///< directions of each element's fibres, or empty

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[2], const ElementShape<T>& shape,
                                         Vec3<T> (&corner)[4], int patch, int pack) const {
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    const auto c = load_constants<Material, T>(constants, patch, fibres, pack * B::lanes);
    Mat3<T> dP = Material::stress_change(F, G[1], c);
    if constexpr (Damped) dP = dP + T(rate(patch)) * DampingTangent<Material, T>{F, c}(G[1]);
    stress_to_corners(dP, shape, corner);
  }
};

/// Column `direction` of every vertex's own 3x3 block of K(u): the force at a vertex for its own
/// unit displacement. Damped: with the column of D(u).
template <class B, class Material, bool Damped>
struct ElasticDiagonal {
  static constexpr int fields = 1;
  Vectors<B> field[1];
  Scalars<B> constants;  ///< [patches] constants of the material
  int direction;
  DampingRate<B> rate;
  Scalars<B> fibres = {};  ///< directions of each element's fibres, or empty

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const ElementShape<T>& shape,
                                         Vec3<T> (&corner)[4], int patch, int pack) const {
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    const auto c = load_constants<Material, T>(constants, patch, fibres, pack * B::lanes);
    for (int a = 0; a < 4; ++a) {
      const Vec3<T> g = a > 0 ? shape.gradient[a - 1]
                              : T(-1) * (shape.gradient[0] + shape.gradient[1] + shape.gradient[2]);
      Mat3<T> dF;
      for (int r = 0; r < 3; ++r) dF[r] = r == direction ? g : Vec3<T>{};
      Mat3<T> dP = Material::stress_change(F, dF, c);
      if constexpr (Damped) dP = dP + T(rate(patch)) * DampingTangent<Material, T>{F, c}(dF);
      corner[a] = shape.volume * (dP * g);
    }
  }
};

template <class B, class Material>
void elastic_tangent(const typename B::Exec& exec, const Patches<B>& patches, const Vectors<B>& u,
                     const Vectors<B>& p, double damping_scale, const Vectors<B>& partial) {
  const DampingRate<B> rate{patches.damping, static_cast<typename B::Real>(damping_scale)};
  by_case(rate.counts(), [&]<bool damped>(std::bool_constant<damped>) {
    launch_patches<B>(
        exec, "plica::elastic_tangent", patches,
        ElasticTangent<B, Material, damped>{{u, p}, patches.constants, rate, patches.fibres},
        partial);
  });
}

template <class B, class Material>
void elastic_diagonal(const typename B::Exec& exec, const Patches<B>& patches, const Vectors<B>& u,
                      int direction, double damping_scale, const Vectors<B>& partial) {
  const DampingRate<B> rate{patches.damping, static_cast<typename B::Real>(damping_scale)};
  by_case(rate.counts(), [&]<bool damped>(std::bool_constant<damped>) {
    launch_patches<B>(exec, "plica::elastic_diagonal", patches,
                      ElasticDiagonal<B, Material, damped>{
                          {u}, patches.constants, direction, rate, patches.fibres},
                      partial);
  });
}

}  // namespace plica
