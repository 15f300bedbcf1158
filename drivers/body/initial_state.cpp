// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/text.hpp>
#include <plica/drivers/body/initial_state.hpp>
#include <plica/drivers/body/selection.hpp>
#include <random>

namespace plica {

bool starts_deformed(const InitialOptions& o) {
  return o.random.has_value() || o.stretch != Point::Ones();
}

std::vector<Point> initial_displacement(const InitialOptions& o, const TetMesh& mesh,
                                        const Box& box) {
  std::mt19937_64 random(static_cast<std::uint64_t>(o.random.value_or(0)));
  // not a distribution of the standard library: these differ from one library to the next
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const Point middle = 0.5 * (box.min + box.max);
  std::vector<Point> u;
  for (const Point& x : mesh.vertices) {
    Point to = middle + o.stretch.cwiseProduct(x - middle);
    if (o.random)
      for (int k = 0; k < 3; ++k) to[k] = box.min[k] + uniform() * (box.max[k] - box.min[k]);
    u.push_back(to - x);
  }
  return u;
}

std::string inverted_at_start(const TetMesh& mesh, const std::vector<Point>& u) {
  const auto volume = [&](const std::array<int, 4>& t, double moved) {
    const auto at = [&](std::size_t k) {
      const auto v = static_cast<std::size_t>(t[k]);
      return Point(mesh.vertices[v] + moved * u[v]);
    };
    return tet_volume(at(0), at(1), at(2), at(3));
  };
  int count = 0, worst = -1;
  double least = 0;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const double J = volume(mesh.tets[e], 1) / volume(mesh.tets[e], 0);
    if (J > 0) continue;
    ++count;
    if (worst < 0 || J < least) worst = static_cast<int>(e), least = J;
  }
  if (count == 0) return {};
  return text(count, " of ", mesh.tets.size(),
              " elements of level 0 start flat or inside out (element ", worst,
              " with J = ", number(least, 3), ")");
}

std::vector<Point> initial_velocity(const InitialOptions& o, const TetMesh& mesh,
                                    const Point& middle) {
  std::vector<Point> velocity;
  for (const Point& x : mesh.vertices) {
    Point& v = velocity.emplace_back(o.velocity + o.angular_velocity.cross(x - middle));
    if (!o.twist) continue;
    const Point along = o.twist->to - o.twist->from, from = x - o.twist->from;
    const double part = from.dot(along) / along.squaredNorm();
    v += part * o.twist->angular_velocity * along.normalized().cross(from);
  }
  for (std::size_t i = 0; i < o.parts.size(); ++i) {
    const std::vector<int> part =
        select_vertices(mesh, o.parts[i].where, {"body.initial.parts." + std::to_string(i), 0});
    std::vector<Point> points;
    for (const int a : part) points.push_back(mesh.vertices[static_cast<std::size_t>(a)]);
    const Box box = bounding_box(points);
    for (const int a : part) {
      const Point arm = mesh.vertices[static_cast<std::size_t>(a)] - 0.5 * (box.min + box.max);
      velocity[static_cast<std::size_t>(a)] +=
          o.parts[i].velocity + o.parts[i].angular_velocity.cross(arm);
    }
  }
  return velocity;
}

Point placement_of(const Body& body) {
  if (!body.initial.position) return Point::Zero();
  const Box box = bounding_box(body.levels.front().vertices);
  return *body.initial.position - (box.min + box.max) / 2;
}

std::vector<Point> places_at_start(const Body& body) {
  if (!body.surface) return {};
  const Point shift = placement_of(body);
  std::vector<Point> places = body.surface->vertices;
  for (Point& place : places) place += shift;
  return places;
}

}  // namespace plica
