// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/contact/build_surface.hpp>
#include <plica/drivers/run/diagnose.hpp>
#include <plica/drivers/run/material_points.hpp>
#include <plica/kernels/transfer/transfer.hpp>
#include <plica/meshes/embedding.hpp>

namespace plica {

template <class B>
MaterialPoints<B>::MaterialPoints(const TetMesh& mesh, const std::vector<Point>& points)
    : gathered_("material_points", static_cast<int>(points.size())) {
  const Embedding embedding = embed(points, mesh, Outside::clamp);
  transfer_ = build_transfer<B>("material_points", embedding, {});
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<Point, 4> corners;
    for (std::size_t c = 0; c < 4; ++c)
      corners[c] = mesh.vertices[static_cast<std::size_t>(embedding.vertices[i][c])];
    rest_.push_back(weighted(embedding.weights[i], corners));
  }
}

template <class B>
auto MaterialPoints<B>::sample(const Exec& exec, const Vectors<B>& displacement,
                               const Vectors<B>& velocity) const -> Motion {
  map_fields<B, MapState>(exec, "plica::material_points", transfer_, {displacement, velocity}, {},
                          {}, gathered_, {});
  return {to_host<B>(exec, gathered_.u), to_host<B>(exec, gathered_.v)};
}

#define PLICA_INSTANTIATE(Real, Exec) template class MaterialPoints<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
