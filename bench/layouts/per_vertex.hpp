// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "element_packs.hpp"

namespace plica::bench {

/// Every vertex evaluates all its elements, in packs, and keeps only its own corner of them:
/// nothing is stored between, each element is evaluated four times. The same bits for any number of
/// threads.
template <class B, class Material>
class PerVertex {
  using Real = typename B::Real;
  using Packs = ElementPacks<B>;
  using T = typename Packs::T;
  static constexpr int lanes = B::lanes;

  struct Vertices {
    Indices<B> first, entry;  // 4 * element + corner
    Kokkos::View<int* [4], Kokkos::LayoutRight, typename B::Memory> corner;
    // one element after the other
    Kokkos::View<Real* [10], Kokkos::LayoutRight, typename B::Memory> shape;
    Scalars<B> constants;
    Vectors<B> u, f;

    KOKKOS_INLINE_FUNCTION void operator()(int a) const {
      Vec3<T> sum;
      for (int i = first(a); i < first(a + 1); i += lanes) {
        ElementShape<T> s;
        Vec3<T> x[4], own;
        for (int l = 0; l < lanes && i + l < first(a + 1); ++l) load(entry(i + l), l, s, x, own);
        sum -= s.volume * (Material::stress(Packs::deformation(x, s),
                                            load_constants<Material, T>(constants, 0)) *
                           own);
      }
      for (int k = 0; k < 3; ++k) {
        Real total = 0;
        for (int l = 0; l < lanes; ++l) total += lane(sum[k], l);
        f(a, k) = total;
      }
    }
    /// Lane l: element shape, displacements, and the gradient of the vertex's own corner. Lanes
    /// left out have volume 0.
    KOKKOS_INLINE_FUNCTION void load(int at, int l, ElementShape<T>& s, Vec3<T> (&x)[4],
                                     Vec3<T>& own) const {
      const int e = at / 4, c = at % 4;
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) set_lane(s.gradient[j][k], l, shape(e, 3 * j + k));
      set_lane(s.volume, l, shape(e, 9));
      for (int j = 0; j < 4; ++j)
        for (int k = 0; k < 3; ++k) set_lane(x[j][k], l, u(corner(e, j), k));
      for (int k = 0; k < 3; ++k)
        set_lane(
            own[k], l,
            c > 0 ? shape(e, 3 * (c - 1) + k) : -(shape(e, k) + shape(e, 3 + k) + shape(e, 6 + k)));
    }
  };

  int vertices_;
  Vertices kernel_;

 public:
  static constexpr const char* name = "per_vertex";

  PerVertex(const TetMesh& mesh, const std::vector<double>& constants)
      : vertices_(static_cast<int>(mesh.vertices.size())) {
    const Packs packs(mesh, constants, mesh_order(mesh));
    const VertexElements elements(mesh);
    kernel_.first = to_device<Indices<B>>("bench.first", elements.first);
    kernel_.entry = to_device<Indices<B>>("bench.entry", elements.entry);
    kernel_.corner = decltype(kernel_.corner)("bench::corner", mesh.tets.size());
    kernel_.shape = decltype(kernel_.shape)("bench::shape", mesh.tets.size());
    const auto corner = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), packs.corner);
    const auto shape = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), packs.shape);
    const auto to_corner = Kokkos::create_mirror_view(kernel_.corner);
    const auto to_shape = Kokkos::create_mirror_view(kernel_.shape);
    for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
      for (std::size_t c = 0; c < 4; ++c) to_corner(e, c) = corner(e / lanes, c, e % lanes);
      for (std::size_t k = 0; k < 10; ++k) to_shape(e, k) = shape(e / lanes, k, e % lanes);
    }
    Kokkos::deep_copy(kernel_.corner, to_corner);
    Kokkos::deep_copy(kernel_.shape, to_shape);
    kernel_.constants = packs.constants;
  }

  void operator()(const typename B::Exec& exec, const Vectors<B>& u, const Vectors<B>& f) const {
    Vertices kernel = kernel_;
    kernel.u = u, kernel.f = f;
    launch<B>(exec, "bench::vertices", vertices_, kernel);
  }

  /// Per tetrahedron, when a vertex's elements stay near for its neighbours: corners, shape, lists;
  /// u and f.
  static double bytes_per_tet(double vertices_per_tet) {
    const double s = sizeof(Real);
    return 16 + 10 * s + 16 + vertices_per_tet * (6 * s + 4);
  }
};

}  // namespace plica::bench
