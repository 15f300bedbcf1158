// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level_data.hpp>
#include <plica/core/model.hpp>
#include <plica/kernels/elastic/damping_stress.hpp>
#include <plica/kernels/patch_kernel.hpp>

namespace plica {

/// Internal force f_a = -V P(F) grad N_a of linear tetrahedra, F = I + grad u [N].
template <class B, class Material, bool Watched>
struct ElasticForce {
  static constexpr int fields = 1;
  Vectors<B> field[1];
  Scalars<B> constants;   ///< [patches] constants of the material
  ElementFlags<B> flags;  ///< raised by det F <= 0, where Watched
  Changing<B, int> evaluation;
  Scalars<B> fibres = {};  ///< directions of each element's fibres, or empty

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const ElementShape<T>& shape,
                                         Vec3<T> (&corner)[4], int patch, int pack) const {
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    stress_to_corners(
        Material::stress(F, load_constants<Material, T>(constants, patch, fibres, pack * B::lanes)),
        shape, corner);
    if constexpr (Watched) {
      const T J = determinant(F);
      if (!all_positive(J)) raise(J, patch, pack);
    }
  }

  template <class T>
  PLICA_SELDOM KOKKOS_FUNCTION void raise(const T& J, int patch, int pack) const {
    for (int l = 0; l < LaneOf<T>::count; ++l)
      if (!(lane(J, l) > 0))
        flags.raise(patch, *evaluation, pack * LaneOf<T>::count + l, lane(J, l));
  }
};

/// Internal force of linear tetrahedra with the damping force -D(u) v [N].
template <class B, class Material, bool Watched>
struct DampedElasticForce {
  static constexpr int fields = 2;
  Vectors<B> field[2];  ///< u, v
  ElasticForce<B, Material, Watched> elastic;
  Scalars<B> damping;  ///< [patches] s

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[2], const ElementShape<T>& shape,
                                         Vec3<T> (&corner)[4], int patch, int pack) const {
    const Mat3<T> displacement[1] = {G[0]}, F = Mat3<T>::identity() + G[0];
    elastic(displacement, shape, corner, patch, pack);
    Vec3<T> drag[4];
    const auto constants =
        load_constants<Material, T>(elastic.constants, patch, elastic.fibres, pack * B::lanes);
    stress_to_corners(T(damping(patch)) * DampingTangent<Material, T>{F, constants}(G[1]), shape,
                      drag);
    for (int c = 0; c < 4; ++c) corner[c] += drag[c];
  }
};

/// Computes the internal force, with damping where the patches have it. Without flags, nothing
/// watches for inverted elements.
template <class B, class Material>
void elastic_force(const typename B::Exec& exec, const Patches<B>& patches, const State<B>& state,
                   const ElementFlags<B>& flags, int evaluation, const Vectors<B>& partial) {
  by_case(flags.evaluation.extent(0) > 0, [&]<bool watched>(std::bool_constant<watched>) {
    const ElasticForce<B, Material, watched> elastic{
        {state.u}, patches.constants, flags, evaluation, patches.fibres};
    if (patches.damping.extent(0) > 0)
      launch_patches<B>(
          exec, "plica::damped_elastic_force", patches,
          DampedElasticForce<B, Material, watched>{{state.u, state.v}, elastic, patches.damping},
          partial);
    else
      launch_patches<B>(exec, "plica::elastic_force", patches, elastic, partial);
  });
}

}  // namespace plica
