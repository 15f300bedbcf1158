// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/launch.hpp>
#include <plica/core/patches.hpp>
#include <plica/kernels/elastic/stress_fields.hpp>
#include <plica/kernels/elastic/viscous_history.hpp>
#include <plica/kernels/materials/material.hpp>

namespace plica {

/// Stress and strain of every tetrahedron, F = I + grad u. It is for output, one element at a time.
template <class B, class Material>
struct ElasticStress {
  using Real = typename B::Real;
  using Policy = Kokkos::TeamPolicy<typename B::Exec>;
  static constexpr int lanes = B::lanes;
  Patches<B> patches;
  Vectors<B> u;
  StressFields<B> fields;
  Scalars<B> relaxed;  ///< relaxed stress; see ViscousHistory

  KOKKOS_INLINE_FUNCTION void operator()(const typename Policy::member_type& team) const {
    const int p = league_rank(team), first = patches.first_pack(p) * lanes,
              last = patches.first_pack(p + 1) * lanes;
    Kokkos::parallel_for(Kokkos::TeamThreadRange(team, first, last), [&](int slot) {
      if (const int tet = patches.element(slot); tet >= 0)
        element(p, slot / lanes, slot % lanes, tet);
    });
  }

  KOKKOS_INLINE_FUNCTION void element(int patch, int pack, int lane, int tet) const {
    int vertex[4];
    for (int c = 0; c < 4; ++c)
      vertex[c] = patches.vertex(patches.first_vertex(patch) + patches.corner(pack, c, lane));
    Mat3<Real> F = Mat3<Real>::identity();
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k)
          F[r][k] += (u(vertex[c + 1], r) - u(vertex[0], r)) * patches.shape(pack, 3 * c + k, lane);
    const int slot = pack * lanes + lane;
    Mat3<Real> sigma = cauchy_stress<Material>(
        F, load_constants<Material, Real>(patches.constants, patch, patches.fibres, slot));
    if (relaxed.extent(0) > 0)
      sigma = sigma - pushed_forward(F, load_symmetric<B, Real>(relaxed, slot));
    fields.von_mises(tet) = von_mises(sigma);
    fields.J(tet) = determinant(F);
    if (fields.tensors.extent(0) > 0) store_tensors<B>(fields.tensors, tet, sigma, F);
  }
};

template <class B, class Material>
void elastic_stress(const typename B::Exec& exec, const Patches<B>& patches, const Vectors<B>& u,
                    const StressFields<B>& fields, const Scalars<B>& relaxed) {
  if (patches.count == 0) return;
  launch("plica::elastic_stress",
         Kokkos::TeamPolicy<typename B::Exec>(exec, patches.count, team_size<B>(128)),
         ElasticStress<B, Material>{patches, u, fields, relaxed});
}

}  // namespace plica
