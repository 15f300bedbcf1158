// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "element_packs.hpp"

namespace plica::bench {

/// Elements of one colour share no vertex: they add to the vertices directly, one launch per colour. The same bits for any
/// number of threads, as a vertex meets the colours in their order.
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
      launch<B>(exec, "bench::scatter", first_[c + 1] - first_[c], Scatter{packs_, u, f, first_[c]});
  }

  /// Per tetrahedron: corners, shape; u in, f in and out for each of its own corners, as no two of a colour share one.
  static double bytes_per_tet(double) {
    const double s = sizeof(Real);
    return 16 + 10 * s + 12 * s + 24 * s;
  }
};

}  // namespace plica::bench
