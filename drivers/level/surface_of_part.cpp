// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/core/row_ranges.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/contact/build_surface.hpp>
#include <plica/drivers/level/surface_of_part.hpp>

namespace plica {

SurfacePart surface_of_part(const TriangleSurface& surface, const TetMesh& mesh,
                            const LevelPart& level) {
  const RankPart& part = level.part;
  const std::vector<int> at = vertices_at(surface.vertices, mesh);
  if (at.empty())
    throw InputError(
        "body.surface has points that are at no vertex of level 0, which needs one process; "
        "expected body.surface: boundary, or none");
  std::vector<char> has(part.vertex.size(), 0);
  std::fill(has.begin() + part.first_owned, has.begin() + part.last_owned, 1);
  for (const int v : level.share_vertex) has[index_of(v)] = 1;
  SurfacePart made;
  for (std::size_t p = 0; p < at.size(); ++p) {
    const auto found = std::ranges::lower_bound(part.vertex, at[p]);
    if (found == part.vertex.end() || *found != at[p]) continue;
    const int v = static_cast<int>(found - part.vertex.begin());
    const bool is_owned = part.owns(v);
    if (!has[index_of(v)]) continue;
    if (is_owned) made.owned.push_back(static_cast<int>(made.points.size()));
    if (!level.nodal) made.counted.push_back(is_owned ? 1 : 0);
    made.points.push_back(static_cast<int>(p));
    made.surface.vertices.push_back(surface.vertices[p]);
    const int beside = std::max(0, v - 1);  // read with the weight 0
    made.embedding.vertices.push_back({beside, beside, beside, v});
    made.embedding.weights.push_back({0, 0, 0, 1});
  }
  return made;
}

template <class B>
EmbeddedSurface<B> build_surface_part(const SurfacePart& points) {
  EmbeddedSurface<B> own = build_surface<B>(points.surface, points.embedding);
  own.number = to_device<Indices<B>>("surface.number", points.points);
  if (!points.counted.empty())
    own.counted = to_device<Indices<B>>("surface.counted", points.counted);
  return own;
}

#define PLICA_INSTANTIATE(Real, Exec)                                                    \
  template EmbeddedSurface<Backend<Real, Exec>> build_surface_part<Backend<Real, Exec>>( \
      const SurfacePart&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
