// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/element_flags.hpp>
#include <plica/kernels/patch_kernel.hpp>

namespace plica {

/// Internal force f_a = -V P(F) grad N_a of linear tetrahedra, F = I + grad u [N].
template <class B, class Material, bool Watched>
struct ElasticForce {
  static constexpr int fields = 1;
  Vectors<B> field[1];
  ElementFlags<B> flags;  ///< where Watched: raised by det F <= 0
  int evaluation;

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const ElementShape<T>& shape, Vec3<T> (&corner)[4],
                                         int patch, int pack) const {
    const Mat3<T> F = Mat3<T>::identity() + G[0];
    stress_to_corners(Material::stress(F, shape.lame), shape, corner);
    if constexpr (Watched) {
      const T J = determinant(F);
      for (int l = 0; l < LaneOf<T>::count; ++l)
        if (!(lane(J, l) > 0)) flags.raise(patch, evaluation, pack * LaneOf<T>::count + l, lane(J, l));
    }
  }
};

/// With empty flags nobody watches for inverted elements.
template <class B, class Material>
void elastic_force(const typename B::Exec& exec, const Patches<B>& patches, const Vectors<B>& u,
                   const ElementFlags<B>& flags, int evaluation, const Vectors<B>& partial) {
  if (flags.evaluation.extent(0) > 0)
    launch_patches<B>(exec, "plica::elastic_force", patches, ElasticForce<B, Material, true>{{u}, flags, evaluation},
                      partial);
  else
    launch_patches<B>(exec, "plica::elastic_force", patches, ElasticForce<B, Material, false>{{u}, flags, evaluation},
                      partial);
}

}  // namespace plica
