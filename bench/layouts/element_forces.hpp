// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "element_packs.hpp"

// Three ways for an element to add its forces to its vertices.
namespace plica::bench {

/// Every element adds to its vertices with atomic instructions: the least data, and sums in
/// whatever order the threads come.
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
          for (int k = 0; k < 3; ++k)
            Kokkos::atomic_add(&f(packs.corner(q, c, l), k), lane(corner[c][k], l));
    }
  };

  Packs packs_;

 public:
  static constexpr const char* name = "atomic";

  Atomic(const TetMesh& mesh, const std::vector<double>& constants)
      : packs_(mesh, constants, mesh_order(mesh)) {}

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

/// Elements of one colour share no vertex: they add to the vertices directly, one launch per
/// colour. The same bits for any number of threads, as a vertex meets the colours in their order.
template <class B, class Material>
class Coloured {
  using Real = typename B::Real;
  using Packs = ElementPacks<B>;

  struct Scatter {
    Packs packs;
    Vectors<B> u, f;
    int first;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      const int q = first + i;
      Vec3<typename Packs::T> corner[4];
      packs.template forces<Material>(q, u, corner);
      for (int l = 0; l < B::lanes; ++l) {
        if (!(packs.shape(q, 9, l) > 0)) break;  // only padding follows
        for (int c = 0; c < 4; ++c)
          for (int k = 0; k < 3; ++k) f(packs.corner(q, c, l), k) += lane(corner[c][k], l);
      }
    }
  };

  Packs packs_;
  std::vector<int> first_{0};  // pack of each colour

 public:
  static constexpr const char* name = "coloured";

  Coloured(const TetMesh& mesh, const std::vector<double>& constants) {
    std::vector<std::vector<int>> colours;
    std::vector<std::uint64_t> taken(mesh.vertices.size(), 0);  // colours at each vertex
    for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
      std::uint64_t near = 0;
      for (int v : mesh.tets[e]) near |= taken[static_cast<std::size_t>(v)];
      std::size_t colour = 0;
      while ((near >> colour) & 1U) ++colour;
      for (int v : mesh.tets[e]) taken[static_cast<std::size_t>(v)] |= std::uint64_t{1} << colour;
      if (colour >= colours.size()) colours.resize(colour + 1);
      colours[colour].push_back(static_cast<int>(e));
    }
    std::vector<int> order;
    for (const auto& colour : colours) {
      order.insert(order.end(), colour.begin(), colour.end());
      while (order.size() % B::lanes != 0) order.push_back(-1);
      first_.push_back(static_cast<int>(order.size() / B::lanes));
    }
    packs_ = Packs(mesh, constants, order);
  }

  void operator()(const typename B::Exec& exec, const Vectors<B>& u, const Vectors<B>& f) const {
    Kokkos::deep_copy(exec, f, 0);
    for (std::size_t c = 0; c + 1 < first_.size(); ++c)
      launch<B>(exec, "bench::scatter", first_[c + 1] - first_[c],
                Scatter{packs_, u, f, first_[c]});
  }

  /// Per tetrahedron: corners, shape; u in, f in and out for each of its own corners, as no two of
  /// a colour share one.
  static double bytes_per_tet(double) {
    const double s = sizeof(Real);
    return 16 + 10 * s + 12 * s + 24 * s;
  }
};

/// Every element's four corner forces into a buffer as large as the mesh; then every vertex gathers
/// its own from it. Two passes without conflicts, and the same bits for any number of threads.
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
    for (int& i : elements.entry)
      i = (i / 4 / B::lanes * 4 + i % 4) * 3 * B::lanes + i / 4 % B::lanes;
    first_ = to_device<Indices<B>>("bench.first", elements.first);
    slot_ = to_device<Indices<B>>("bench.slot", elements.entry);
  }

  void operator()(const typename B::Exec& exec, const Vectors<B>& u, const Vectors<B>& f) const {
    launch<B>(exec, "bench::elements", packs_.packs, Elements{packs_, u, buffer_});
    launch<B>(exec, "bench::gather", vertices_, Gather{first_, slot_, buffer_, f});
  }

  /// Moved when a vertex is fetched once, per tetrahedron: corners, shape, buffer out and in,
  /// slots; u and f.
  static double bytes_per_tet(double vertices_per_tet) {
    const double s = sizeof(Real);
    return 16 + 10 * s + 24 * s + 16 + vertices_per_tet * (6 * s + 4);
  }
};

}  // namespace plica::bench
