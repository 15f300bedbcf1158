// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "element_packs.hpp"

namespace plica::bench {

/// Every element adds to its vertices with atomic instructions: the least data, and sums in whatever order the threads
/// come.
template <class B, class Material>
class Atomic {
  using Real = typename B::Real;
  using Packs = ElementPacks<B>;

  struct Scatter {
    Packs packs;
    Vectors<B> u, f;
    KOKKOS_INLINE_FUNCTION void operator()(int q) const {
      Vec3<typename Packs::T> corner[4];
      packs.template forces<Material>(q, u, corner);
      for (int l = 0; l < B::lanes; ++l)
        for (int c = 0; c < 4; ++c)
          for (int k = 0; k < 3; ++k) Kokkos::atomic_add(&f(packs.corner(q, c, l), k), lane(corner[c][k], l));
    }
  };

  Packs packs_;

 public:
  static constexpr const char* name = "atomic";

  Atomic(const TetMesh& mesh, const std::vector<double>& constants) : packs_(mesh, constants, mesh_order(mesh)) {}

  void operator()(const typename B::Exec& exec, const Vectors<B>& u, const Vectors<B>& f) const {
    Kokkos::deep_copy(exec, f, 0);
    launch<B>(exec, "bench::scatter", packs_.packs, Scatter{packs_, u, f});
  }

  /// Per tetrahedron, when a vertex is fetched once: corners, shape; u in, f cleared, in and out.
  static double bytes_per_tet(double vertices_per_tet) {
    const double s = sizeof(Real);
    return 16 + 10 * s + vertices_per_tet * 12 * s;
  }
};

}  // namespace plica::bench
