// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/kernels/elastic/elastic_tangent.hpp>
#include <plica/kernels/elastic/kept_tangents.hpp>
#include <plica/kernels/materials/positive_tangent.hpp>

// Projected tangents of linear elements, for systems without a matrix: computed once for a state
// and read in every product, 45 numbers an element. They are dP/dF with its negative eigenvalues
// dropped. Damping is computed in each product.
namespace plica {

/// Returns the place of number (i, j), j <= i, of a pack's kept tangents, side by side.
template <class B>
KOKKOS_INLINE_FUNCTION typename B::Real* kept_place(const Scalars<B>& tangent, int pack, int i,
                                                    int j) {
  const int k = i * (i + 1) / 2 + j;
  return tangent.data() + (static_cast<std::ptrdiff_t>(pack) * symmetric_nine + k) * B::lanes;
}

/// Computes the tangents of a displacement.
template <class B, class Material>
struct KeepElements {
  static constexpr int fields = 1;
  Vectors<B> field[1];
  Scalars<B> constants;  ///< [patches] constants of the material
  Scalars<B> fibres;     ///< directions of each element's fibres, or empty
  Scalars<B> tangent;    ///< [elements * 45], see kept_place()

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[1], const ElementShape<T>&,
                                         Vec3<T> (&corner)[4], int patch, int pack) const {
    const auto c = load_constants<Material, T>(constants, patch, fibres, pack * B::lanes);
    const typename PositiveTangent<Material>::template Of<T> projected(Mat3<T>::identity() + G[0],
                                                                       c);
    for (int i = 0; i < 9; ++i)
      for (int j = 0; j <= i; ++j)
        store_lanes(projected.C.a[i][j], kept_place<B>(tangent, pack, i, j));
    for (Vec3<T>& at : corner) at = {T(0), T(0), T(0)};
  }
};

/// Returns C : dF with the kept tangent of a pack.
template <class B, class T>
KOKKOS_INLINE_FUNCTION Mat3<T> kept_product(const Scalars<B>& tangent, int pack,
                                            const Mat3<T>& dF) {
  Mat3<T> dP;
  for (int i = 0; i < 9; ++i) {
    T sum = load_lanes<T>(kept_place<B>(tangent, pack, i, i)) * dF[i / 3][i % 3];
    for (int j = 0; j < i; ++j) {
      const T c = load_lanes<T>(kept_place<B>(tangent, pack, i, j));
      sum += c * dF[j / 3][j % 3];
      dP[j / 3][j % 3] += c * dF[i / 3][i % 3];
    }
    dP[i / 3][i % 3] = sum;
  }
  return dP;
}

/// Product of minus the kept tangents with a direction, see ElasticTangent.
template <class B, class Material, bool Damped>
struct KeptElementTangent {
  static constexpr int fields = Damped ? 2 : 1;
  Vectors<B> field[fields];  ///< p; u where Damped
  Scalars<B> tangent;        ///< [elements * 45], see kept_place()
  Scalars<B> constants;      ///< [patches] constants of the material
  DampingRate<B> rate;
  Scalars<B> fibres;  ///< directions of each element's fibres, or empty

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(const Mat3<T> (&G)[fields], const ElementShape<T>& shape,
                                         Vec3<T> (&corner)[4], int patch, int pack) const {
    Mat3<T> dP = kept_product<B>(tangent, pack, G[0]);
    if constexpr (Damped) {
      const auto c = load_constants<Material, T>(constants, patch, fibres, pack * B::lanes);
      dP = dP + T(rate(patch)) * DampingTangent<Material, T>{Mat3<T>::identity() + G[1], c}(G[0]);
    }
    stress_to_corners(dP, shape, corner);
  }
};

/// Column `direction` of every vertex's own block of the kept tangents, see ElasticDiagonal.
template <class B, class Material, bool Damped>
struct KeptElementDiagonal {
  static constexpr int fields = 1;
  Vectors<B> field[1];   ///< u
  Scalars<B> tangent;    ///< [elements * 45], see kept_place()
  Scalars<B> constants;  ///< [patches] constants of the material
  int direction;
  DampingRate<B> rate;
  Scalars<B> fibres;  ///< directions of each element's fibres, or empty

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
      Mat3<T> dP = kept_product<B>(tangent, pack, dF);
      if constexpr (Damped) dP = dP + T(rate(patch)) * DampingTangent<Material, T>{F, c}(dF);
      corner[a] = shape.volume * (dP * g);
    }
  }
};

/// Computes level.nodal.tangent of a displacement. Overwrites level.partial.
template <class B, class Material>
void keep_element_tangents(const typename B::Exec& exec, const LevelData<B>& level,
                           const Vectors<B>& u) {
  const Patches<B>& patches = level.model.patches;
  launch_patches<B>(
      exec, "plica::elastic_keep_tangents", patches,
      KeepElements<B, Material>{{u}, patches.constants, patches.fibres, level.nodal.tangent},
      level.partial);
}

template <class B, class Material>
void kept_element_tangent(const typename B::Exec& exec, const LevelData<B>& level,
                          const Vectors<B>& u, const Vectors<B>& p, double damping_scale) {
  const Patches<B>& patches = level.model.patches;
  const DampingRate<B> rate{patches.damping, static_cast<typename B::Real>(damping_scale)};
  by_case(rate.counts(), [&]<bool damped>(std::bool_constant<damped>) {
    KeptElementTangent<B, Material, damped> kernel{
        {p}, level.nodal.tangent, patches.constants, rate, patches.fibres};
    if constexpr (damped) kernel.field[1] = u;
    launch_patches<B>(exec, "plica::elastic_kept_tangent", patches, kernel, level.partial);
  });
}

template <class B, class Material>
void kept_element_diagonal(const typename B::Exec& exec, const LevelData<B>& level,
                           const Vectors<B>& u, int direction, double damping_scale) {
  const Patches<B>& patches = level.model.patches;
  const DampingRate<B> rate{patches.damping, static_cast<typename B::Real>(damping_scale)};
  by_case(rate.counts(), [&]<bool damped>(std::bool_constant<damped>) {
    launch_patches<B>(
        exec, "plica::elastic_kept_diagonal", patches,
        KeptElementDiagonal<B, Material, damped>{
            {u}, level.nodal.tangent, patches.constants, direction, rate, patches.fibres},
        level.partial);
  });
}

}  // namespace plica
