// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/elastic/nodal_rows.hpp>
#include <plica/kernels/elastic/viscous_history.hpp>
#include <plica/kernels/materials/isochoric.hpp>
#include <plica/kernels/patch_kernel.hpp>

namespace plica {

/// Updates the memory at `slot` to the stress at F. S = F^-1 P of the law without a stiffness of
/// the volume. It is finite for any F, as the law is, with 1/J continued as in volume_ratio.hpp.
template <class B, class Material, class T>
KOKKOS_INLINE_FUNCTION void remember_stress(const ViscousHistory<B>& stress, const Mat3<T>& F,
                                            const typename Material::template Constants<T>& c,
                                            int slot) {
  const int count = 6 * (1 + stress.terms);
  const Mat3<T> H = cofactor(F);
  const VolumeRatio<T> v(dot(F[0], H[0]));
  const SymMat3<T> S = six_of(v.slope() * (transpose(H) * Material::stress(F, c)));
  const SymMat3<T> before = load_symmetric<B, T>(stress.memory, slot, 0, count);
  store_symmetric<B>(S, stress.memory, slot, 0, count);
  const int first_step = stress.region(slot / B::lanes) * stress.terms * 2;
  for (int i = 0; i < stress.terms; ++i) {
    const T keep(stress.step(first_step + 2 * i)), gain(stress.step(first_step + 2 * i + 1));
    SymMat3<T> h = load_symmetric<B, T>(stress.memory, slot, 6 * (1 + i), count);
    for (int k = 0; k < 6; ++k) h.a[k] = keep * h.a[k] + gain * (S.a[k] - before.a[k]);
    store_symmetric<B>(h, stress.memory, slot, 6 * (1 + i), count);
  }
}

/// Updates the memory of linear elements: a team takes a patch, a thread a pack.
template <class B, class Material>
struct RememberElements {
  using Real = typename B::Real;
  using Policy = Kokkos::TeamPolicy<typename B::Exec>;
  using T = typename PackOf<Real, B::lanes>::type;
  Patches<B> patches;
  ViscousHistory<B> stress;
  Vectors<B> field[1];
  Scalars<B> constants;

  static KOKKOS_FUNCTION constexpr std::size_t scratch_bytes() {
    return Patches<B>::vertex_capacity * patch_stride<B> * sizeof(Real);
  }
  KOKKOS_INLINE_FUNCTION void operator()(const typename Policy::member_type& team) const {
    const int p = league_rank(team);
    Real* const local = team_scratch<Real>(team, 0, scratch_bytes() / sizeof(Real));
    load_patch<B>(team, patches, p, field, local);
    Kokkos::parallel_for(
        Kokkos::TeamThreadRange(team, patches.first_pack(p), patches.first_pack(p + 1)),
        [&](int pack) { element(p, pack, local); });
  }
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void element(int p, int pack, const Real* local) const {
    ElementShape<T> shape;
    Mat3<T> G[1];
    load_pack<B, 1>(patches, pack, local, shape, G);
    const int slot = pack * B::lanes;
    remember_stress<B, Material>(stress, Mat3<T>::identity() + G[0],
                                 load_constants<Material, T>(constants, p, patches.fibres, slot),
                                 slot);
  }
};

template <class B, class Material>
void remember_elements(const typename B::Exec& exec, const LevelData<B>& level, const Vectors<B>& u,
                       const Scalars<B>& constants) {
  using Kernel = RememberElements<B, Material>;
  const Patches<B>& patches = level.model.patches;
  if (patches.count == 0) return;
  typename Kernel::Policy policy(exec, patches.count, team_size<B>(128));
  launch("plica::remember_elements",
         policy.set_scratch_size(0, Kokkos::PerTeam(Kernel::scratch_bytes() + 64)),
         Kernel{patches, level.stress, {u}, constants});
}

/// Updates the memory of nodal elements.
template <class B, class Material>
struct RememberDomains {
  using T = RowPack<B>;
  NodalRows<B> rows;
  NodalWork<B> work;
  ViscousHistory<B> stress;
  Scalars<B> constants;
  PLICA_FLATTEN KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const RowsAt<B> at(item);
    Vec3<T> own[1];
    Mat3<T> G[1];
    row_gradients<B, 1>(rows, work.near, at, own, G);
    remember_stress<B, Material>(
        stress, Mat3<T>::identity() + G[0],
        load_constants<Material, T>(constants, rows.region(at.slice), rows.fibres, at.slot),
        at.slot);
  }
};

template <class B, class Material>
void remember_domains(const typename B::Exec& exec, const LevelData<B>& level, const Vectors<B>& u,
                      const Scalars<B>& constants) {
  const NodalRows<B>& rows = level.model.rows;
  lay_out<B>(exec, level, {u});
  for_rows<B>(exec, "plica::remember_domains", rows,
              RememberDomains<B, Material>{rows, level.nodal, level.stress, constants});
}

}  // namespace plica
