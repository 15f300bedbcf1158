// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/elastic/build_patches.hpp>
#include <plica/kernels/elastic/elastic_force.hpp>
#include <plica/kernels/elastic/gather_forces.hpp>

#include "element_packs.hpp"

namespace plica::bench {

/// The library's own: patches whose element forces stay in the nearest memory, and a gather of what
/// neighbouring patches have for a vertex. The same bits for any number of threads.
template <class B, class Material>
class Patched {
  using Real = typename B::Real;
  Model<B> model_;
  ElementFlags<B> flags_;
  Vectors<B> partial_;

 public:
  static constexpr const char* name = "patches";

  Patched(const TetMesh& mesh, const std::vector<double>& constants) {
    model_.vertices = static_cast<int>(mesh.vertices.size());
    model_.patches = build_patches<B>(mesh, {constants});
    model_.shares = model_.patches.shares;
    model_.mass = Scalars<B>("bench::mass", mesh.vertices.size());
    if (!Material::allows_inversion) flags_ = make_element_flags<B>(model_.patches.count);
    partial_ = Vectors<B>("bench::partial", model_.patches.vertex.extent(0));
  }

  void operator()(const typename B::Exec& exec, const Vectors<B>& u, const Vectors<B>& f) const {
    elastic_force<B, Material>(exec, model_.patches, State<B>(u, {}), flags_, 1, partial_);
    gather_forces<B>(exec, model_, partial_, {}, f);
  }

  /// Per tetrahedron: corners and slots of 2 bytes, shape; per patch vertex (a bit over two per
  /// vertex) its number, u, the sum out and in, the copy list; f and mass.
  double bytes_per_tet(double vertices_per_tet) const {
    const double s = sizeof(Real),
                 copies = static_cast<double>(partial_.extent(0)) / model_.vertices;
    const double padding = model_.patches.packs * B::lanes * vertices_per_tet / model_.vertices;
    return padding * (8 + 10 * s) + 8 + vertices_per_tet * (copies * (12 + 9 * s) + 4 + 4 * s);
  }
};

}  // namespace plica::bench
