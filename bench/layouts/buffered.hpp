// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "element_packs.hpp"

namespace plica::bench {

/// Every element's four corner forces into a buffer as large as the mesh; then every vertex gathers its own from it. Two
/// passes without conflicts, and the same bits for any number of threads.
template <class B, class Material>
class Buffered {
  using Real = typename B::Real;
  using Packs = ElementPacks<B>;
  using Buffer = Kokkos::View<Real* [4][3][B::lanes], Kokkos::LayoutRight, typename B::Memory>;

  struct Elements {
    Packs packs;
    Vectors<B> u;
    Buffer buffer;
    KOKKOS_INLINE_FUNCTION void operator()(int q) const {
      Vec3<typename Packs::T> corner[4];
      packs.template forces<Material>(q, u, corner);
      for (int c = 0; c < 4; ++c)
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < B::lanes; ++l) buffer(q, c, k, l) = lane(corner[c][k], l);
    }
  };
  struct Gather {
    Indices<B> first, slot;
    Buffer buffer;
    Vectors<B> f;
    KOKKOS_INLINE_FUNCTION void operator()(int a) const {
      Vec3<Real> sum;
      for (int i = first(a); i < first(a + 1); ++i)
        for (int k = 0; k < 3; ++k) sum[k] += buffer.data()[slot(i) + k * B::lanes];
      for (int k = 0; k < 3; ++k) f(a, k) = sum[k];
    }
  };

  int vertices_;
  Packs packs_;
  Indices<B> first_, slot_;
  Buffer buffer_;

 public:
  static constexpr const char* name = "buffered";

  Buffered(const TetMesh& mesh, const std::vector<double>& constants)
      : vertices_(static_cast<int>(mesh.vertices.size())),
        packs_(mesh, constants, mesh_order(mesh)),
        buffer_("bench::buffer", packs_.packs) {
    VertexElements elements(mesh);
    for (int& i : elements.entry) i = (i / 4 / B::lanes * 4 + i % 4) * 3 * B::lanes + i / 4 % B::lanes;
    first_ = to_device<Indices<B>>("bench.first", elements.first);
    slot_ = to_device<Indices<B>>("bench.slot", elements.entry);
  }

  void operator()(const typename B::Exec& exec, const Vectors<B>& u, const Vectors<B>& f) const {
    launch<B>(exec, "bench::elements", packs_.packs, Elements{packs_, u, buffer_});
    launch<B>(exec, "bench::gather", vertices_, Gather{first_, slot_, buffer_, f});
  }

  /// Moved when a vertex is fetched once, per tetrahedron: corners, shape, buffer out and in, slots; u and f.
  static double bytes_per_tet(double vertices_per_tet) {
    const double s = sizeof(Real);
    return 16 + 10 * s + 24 * s + 16 + vertices_per_tet * (6 * s + 4);
  }
};

}  // namespace plica::bench
