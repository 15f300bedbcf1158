// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/solver/set_up/initial_velocity.hpp>
#include <plica/drivers/solver/set_up/selection.hpp>

namespace plica {

std::vector<Point> initial_velocity(const InitialOptions& o, const TetMesh& mesh, const Point& middle) {
  std::vector<Point> velocity;
  for (const Point& x : mesh.vertices) {
    Point& v = velocity.emplace_back(o.velocity + o.angular_velocity.cross(x - middle));
    if (!o.twist) continue;
    const Point along = o.twist->to - o.twist->from, from = x - o.twist->from;
    const double part = from.dot(along) / along.squaredNorm();
    v += part * o.twist->angular_velocity * along.normalized().cross(from);
  }
  for (std::size_t i = 0; i < o.parts.size(); ++i)
    for (int a : select_vertices(mesh, o.parts[i].where, {"body.initial.parts." + std::to_string(i), 0}))
      velocity[static_cast<std::size_t>(a)] += o.parts[i].velocity;
  return velocity;
}

}  // namespace plica
