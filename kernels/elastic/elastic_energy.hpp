// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/materials/material.hpp>
#include <plica/kernels/patch_kernel.hpp>

namespace plica {

/// Elastic energy [J], as a vertex field that adds up to it. The x component has a quarter of each
/// element's energy per corner. The energy is summed in the same order as the force.
template <class B, class Material>
struct ElasticEnergy {
  static constexpr int fields = 1;
  Vectors<B> field[1];
  Scalars<B> constants;  ///< [patches] constants of the material
  Scalars<B> fibres;     ///< directions of each element's fibres, or empty

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const ElementShape<T>& shape,
                                         Vec3<T> (&corner)[4], int patch, int pack) const {
    const auto c = load_constants<Material, T>(constants, patch, fibres, pack * B::lanes);
    const T quarter = T(0.25f) * shape.volume * Material::energy(Mat3<T>::identity() + G[0], c);
    for (Vec3<T>& at : corner) at = {quarter, T(0), T(0)};
  }
};

template <class B, class Material>
void elastic_energy(const typename B::Exec& exec, const Patches<B>& patches, const Vectors<B>& u,
                    const Vectors<B>& partial) {
  launch_patches<B>(exec, "plica::elastic_energy", patches,
                    ElasticEnergy<B, Material>{{u}, patches.constants, patches.fibres}, partial);
}

}  // namespace plica
