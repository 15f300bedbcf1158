// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <plica/drivers/run/obstacles_inside.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/embedding.hpp>

namespace plica {

namespace {

/// Returns whether an obstacle's origin is inside it.
bool contains_its_origin(const ObstacleOptions& options) {
  bool inside = false;
  visit_shape(options.shape, [&](auto shape, const auto& its) {
    if constexpr (requires { shape.template shape<double>(its); })
      inside = shape.template shape<double>(its)(vec3<double>(shape.origin(its))).distance < 0;
  });
  return inside;
}

}  // namespace

template <class B>
std::vector<int> obstacles_inside(const Simulation<B>& simulation, const Problem& problem,
                                  const std::vector<double>& depths) {
  std::vector<int> candidates, inside;
  for (std::size_t o = 0; o < depths.size(); ++o)
    if (depths[o] == 0 && contains_its_origin(problem.contact.obstacles[o]))
      candidates.push_back(static_cast<int>(o));
  if (candidates.empty()) return inside;
  const std::vector<Point> x = simulation.positions();
  const std::vector<std::array<int, 4>>& tets = simulation.mesh().tets;
  const Box around = bounding_box(x);
  for (const int o : candidates) {
    const Point origin = simulation.obstacle_origin(o);
    if ((origin.array() < around.min.array()).any() || (origin.array() > around.max.array()).any())
      continue;
    if (std::ranges::any_of(tets, [&](const std::array<int, 4>& t) {
          const auto at = [&](std::size_t k) { return x[static_cast<std::size_t>(t[k])]; };
          return is_in_tetrahedron({at(0), at(1), at(2), at(3)}, origin);
        }))
      inside.push_back(o);
  }
  return inside;
}

#define PLICA_INSTANTIATE(Real, Exec)                                                \
  template std::vector<int> obstacles_inside(const Simulation<Backend<Real, Exec>>&, \
                                             const Problem&, const std::vector<double>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
