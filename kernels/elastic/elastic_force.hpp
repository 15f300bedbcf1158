// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/element_flags.hpp>
#include <plica/core/model.hpp>
#include <plica/kernels/patch_kernel.hpp>

namespace plica {

/// Internal force f_a = -V P(F) grad N_a of linear tetrahedra, F = I + grad u [N].
template <class B, class Material>
struct ElasticForce {
  static constexpr int fields = 1;
  Vectors<B> field[1];
  ElementFlags<B> flags;  ///< empty where the material survives inversion
  int evaluation;

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const ElementShape<T>& shape, Vec3<T> (&corner)[4],
                                         int patch, int pack) const {
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    stress_to_corners(Material::stress(F, shape.lame), shape, corner);
    if constexpr (!Material::survives_inversion) {
      const T J = determinant(F);
      for (int l = 0; l < LaneOf<T>::count; ++l)
        if (!(lane(J, l) > 0)) flags.raise(patch, evaluation, pack * LaneOf<T>::count + l, lane(J, l));
    }
  }
};

/// The same with the damping force -damping K(u) v of a patch.
template <class B, class Material>
struct DampedElasticForce {
  static constexpr int fields = 2;
  Vectors<B> field[2];  ///< u, v
  ElasticForce<B, Material> elastic;
  Scalars<B> damping;  ///< [patches] s

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[2], const ElementShape<T>& shape, Vec3<T> (&corner)[4],
                                         int patch, int pack) const {
    const Mat3<T> displacement[1] = {G[0]}, F = Mat3<T>::identity() + G[0];
    elastic(displacement, shape, corner, patch, pack);
    Vec3<T> drag[4];
    stress_to_corners(T(damping(patch)) * Material::stress_change(F, G[1], shape.lame), shape, drag);
    for (int c = 0; c < 4; ++c) corner[c] += drag[c];
  }
};

template <class B, class Material>
void damped_elastic_force(const typename B::Exec& exec, const Patches<B>& patches, const State<B>& state,
                          const ElementFlags<B>& flags, int evaluation, const Vectors<B>& partial) {
  launch_patches<B>(
      exec, "plica::damped_elastic_force", patches,
      DampedElasticForce<B, Material>{{state.u, state.v}, {{state.u}, flags, evaluation}, patches.damping}, partial);
}

template <class B, class Material>
void elastic_force(const typename B::Exec& exec, const Patches<B>& patches, const Vectors<B>& u,
                   const ElementFlags<B>& flags, int evaluation, const Vectors<B>& partial) {
  launch_patches<B>(exec, "plica::elastic_force", patches, ElasticForce<B, Material>{{u}, flags, evaluation}, partial);
}

}  // namespace plica
