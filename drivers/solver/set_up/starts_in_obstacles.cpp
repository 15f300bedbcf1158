// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/solver/courses.hpp>
#include <plica/drivers/solver/set_up/initial_state.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>
#include <plica/drivers/solver/turning.hpp>
#include <plica/kernels/boundary_conditions.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/mesh_quality.hpp>

namespace plica {

namespace {

constexpr double bearable_depth = 0.5;  // of an edge

/// The deepest of some places in a solid, and how many are in it.
struct Deepest {
  std::size_t place = 0, inside = 0;
  double depth = 0;  ///< [m]
};

/// A sampled surface is looked at when it has been sampled.
Deepest deepest_in(const ObstacleOptions& options, const std::vector<Point>& places) {
  Deepest found;
  std::vector<PathKnot> knots;
  const Path path = make_path(options.motion, knots);
  ObstaclePose pose{.displacement = path_at(path, knots.data(), 0).displacement, .speed = {}, .time = 0, .turn = {}};
  visit_shape(options.shape, [&](auto shape, const auto& its) {
    if constexpr (requires { shape.template shape<double>(its); }) {
      const auto gap = shape.template shape<double>(its);
      if (options.turn) pose.turn = Turning(*options.turn, turned_about(options)).at(0);
      ObstaclePlace<Backend<double, Kokkos::DefaultHostExecutionSpace>> start;
      start.pose = pose;
      for (std::size_t i = 0; i < places.size(); ++i) {
        const double depth = -gap(start.local(vec3<double>(places[i]))).distance;
        if (depth > 0) ++found.inside;
        if (depth > found.depth) found.depth = depth, found.place = i;
      }
    }
  });
  return found;
}

bool contains(const std::array<Point, 4>& corners, const Point& x) {
  for (int k = 0; k < 3; ++k) {  // most are beside it
    const auto [least, most] = std::ranges::minmax({corners[0][k], corners[1][k], corners[2][k], corners[3][k]});
    if (x[k] < least || x[k] > most) return false;
  }
  return std::ranges::all_of(barycentric(x, corners), [](double weight) { return weight >= 0; });
}

/// Whether a solid of which the body's surface touches nothing is inside the body: its middle is. Not looked at where it turns about
/// another point.
bool is_inside(const ObstacleOptions& options, const Body& body) {
  if (options.turn && options.turn->about) return false;
  std::vector<PathKnot> knots;
  const Path path = make_path(options.motion, knots);
  const Vec3<double> moved = path_at(path, knots.data(), 0).displacement;
  const Point middle = turned_about(options) + Point(moved[0], moved[1], moved[2]), x = middle - placement_of(body);
  if (deepest_in(options, {middle}).inside == 0) return false;  // a bowl, a plane
  const TetMesh& mesh = body.levels.front();
  return std::ranges::any_of(mesh.tets, [&](const auto& tet) {
    const auto at = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(tet[k])]; };
    return contains({at(0), at(1), at(2), at(3)}, x);
  });
}

}  // namespace

std::vector<std::string> starts_in_obstacles(const Problem& problem) {
  std::vector<std::string> sentences;
  const std::vector<ObstacleOptions>& obstacles = problem.contact.obstacles;
  if (obstacles.empty() || !problem.body.surface || starts_deformed(problem.body.initial)) return sentences;
  const std::vector<Point> places = places_at_start(problem.body);
  const double edge = mean_edge_length(problem.body.levels.front());
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const Deepest found = deepest_in(obstacles[i], places);
    const std::string path = "contact.obstacles." + std::to_string(i);
    if (found.inside == places.size())
      throw InputError(path + " contains the whole body at the start; expected a body outside");
    if (found.inside == 0 && is_inside(obstacles[i], problem.body))
      throw InputError(path + " is inside the body at the start, where contact does not find it; expected it outside");
    if (!(found.depth > bearable_depth * edge)) continue;
    const Point& x = places[found.place];
    sentences.push_back(text(path, ": the body starts inside it, ", number(found.depth, 3), " m deep at [",
                             number(x[0], 4), ", ", number(x[1], 4), ", ", number(x[2], 4), "] m, ",
                             number(found.depth / edge, 2),
                             " of a mean edge: it is thrown out; expected a body outside"));
  }
  return sentences;
}

}  // namespace plica
