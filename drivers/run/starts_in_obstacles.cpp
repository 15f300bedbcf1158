// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/body/initial_state.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/signed_distance.hpp>
#include <utility>

namespace plica {

namespace {

constexpr double bearable_depth = 0.5;  // part of an edge

/// The deepest of some places in a solid, and how many of them are in it.
struct Deepest {
  std::size_t place = 0, inside = 0;
  double depth = 0;                                          ///< depth of the deepest place [m]
  double nearest = std::numeric_limits<double>::infinity();  ///< least distance of a place [m]
};

/// Returns whether an obstacle grasps the body from the start: such an anchor may be inside it.
bool holds_at_start(const ObstacleOptions& options, const Deepest& found) {
  if (!options.grasp || !(found.nearest <= grasp_reach(*options.grasp))) return false;
  return options.grasp->from.empty() || options.grasp->from.front() <= 0;
}

/// Finds the deepest place in an obstacle. A sampled surface is examined when it has been sampled.
Deepest deepest_in(const ObstacleOptions& options, const std::vector<Point>& places) {
  Deepest found;
  visit_shape(options.shape, [&](auto shape, const auto& its) {
    if constexpr (requires { shape.template shape<double>(its); }) {
      const auto gap = shape.template shape<double>(its);
      const ObstaclePose start = pose_at_start(options);
      for (std::size_t i = 0; i < places.size(); ++i) {
        const double depth = -gap(start.local(vec3<double>(places[i]))).distance;
        if (depth > 0) ++found.inside;
        if (depth > found.depth) found.depth = depth, found.place = i;
        found.nearest = std::min(found.nearest, -depth);
      }
    }
  });
  return found;
}

/// Returns places of a solid at the start: its middle, both ends of a long one, the corners of a
/// box. If the solid is inside a body, all of them are. None for a shape that does not contain its
/// middle: a bowl, a plane.
std::vector<Point> marks_of(const ObstacleOptions& options) {
  std::vector<Point> marks;
  visit_shape(options.shape, [&](auto shape, const auto& its) {
    if constexpr (requires { shape.template shape<double>(its); }) {
      const auto gap = shape.template shape<double>(its);
      std::vector<Vec3<double>> places = {vec3<double>(shape.origin(its))};
      if (!(gap(places.front()).distance < 0)) return;
      if constexpr (requires { its.to; })
        places.insert(places.end(), {vec3<double>(its.from), vec3<double>(its.to)});
      if constexpr (requires { gap.axes; })
        for (const double x : {-1.0, 1.0})
          for (const double y : {-1.0, 1.0})
            for (const double z : {-1.0, 1.0})
              places.push_back(gap.centre + x * gap.half[0] * gap.axes[0] +
                               y * gap.half[1] * gap.axes[1] + z * gap.half[2] * gap.axes[2]);
      const ObstaclePose pose = pose_at_start(options);
      for (Vec3<double> at : places) {
        if (pose.turn.turned) at = pose.turn.centre + pose.turn.rotation * (at - pose.turn.centre);
        at += pose.displacement;
        marks.emplace_back(at[0], at[1], at[2]);
      }
    }
  });
  return marks;
}

/// The body where it starts. A closed surface says what is inside it, since contact acts on the
/// surface, and lattices reach beyond it. Else the tetrahedra of level 0 say it.
class StartingBody {
 public:
  explicit StartingBody(const Body& body)
      : mesh_(body.levels.front()), surface_(*body.surface), shift_(placement_of(body)) {
    const Box skin = bounding_box(surface_.vertices), cells = bounding_box(mesh_.vertices);
    around_ = {skin.min.cwiseMin(cells.min), skin.max.cwiseMax(cells.max)};
  }

  /// Returns whether a solid is inside the body, given that the surface does not touch it. One that
  /// turns about another point than its origin is not examined: false.
  bool contains(const ObstacleOptions& options) {
    if (options.turn && options.turn->about) return false;
    std::vector<Point> marks = marks_of(options);
    for (Point& x : marks) x -= shift_;
    if (marks.empty() || !std::ranges::all_of(marks, [&](const Point& x) { return is_near(x); }))
      return false;
    look_at_surface();
    return std::ranges::all_of(
        marks, [&](const Point& x) { return distance_ ? (*distance_)(x) < 0 : is_in_mesh(x); });
  }

 private:
  const TetMesh& mesh_;
  const TriangleSurface& surface_;
  Point shift_;
  Box around_;
  bool looked_ = false;                     // look_at_surface() was called: something is near
  std::optional<SignedDistance> distance_;  // only for a closed surface

  bool is_near(const Point& x) const {
    return (x.array() >= around_.min.array()).all() && (x.array() <= around_.max.array()).all();
  }
  void look_at_surface() {
    if (std::exchange(looked_, true)) return;
    SurfaceReport edges;
    count_edges(surface_, edges);
    if (edges.closed() && enclosed_volume(surface_) > 0) distance_.emplace(surface_);
  }
  bool is_in_mesh(const Point& x) const {
    return std::ranges::any_of(mesh_.tets, [&](const auto& tet) {
      const auto at = [&](std::size_t k) {
        return mesh_.vertices[static_cast<std::size_t>(tet[k])];
      };
      return is_in_tetrahedron({at(0), at(1), at(2), at(3)}, x);
    });
  }
};

}  // namespace

std::vector<std::string> starts_in_obstacles(const Problem& problem) {
  std::vector<std::string> sentences;
  const std::vector<ObstacleOptions>& obstacles = problem.contact.obstacles;
  if (obstacles.empty() || !problem.body.surface || starts_deformed(problem.body.initial))
    return sentences;
  const std::vector<Point> places = places_at_start(problem.body);
  const double edge = mean_edge_length(problem.body.levels.front());
  StartingBody body(problem.body);
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const Deepest found = deepest_in(obstacles[i], places);
    const std::string path = "contact.obstacles." + std::to_string(i);
    if (found.inside == places.size())
      throw InputError(path + " contains the whole body at the start; expected a body outside");
    if (found.inside == 0 && !holds_at_start(obstacles[i], found) && body.contains(obstacles[i]))
      throw InputError(
          path +
          " is inside the body at the start, where contact does not find it; expected it outside");
    if (!(found.depth > bearable_depth * edge) || holds_at_start(obstacles[i], found)) continue;
    const Point& x = places[found.place];
    sentences.push_back(text(path, ": the body starts inside it, ", number(found.depth, 3),
                             " m deep at [", number(x[0], 4), ", ", number(x[1], 4), ", ",
                             number(x[2], 4), "] m, ", number(found.depth / edge, 2),
                             " of a mean edge: it is thrown out; expected a body outside"));
  }
  return sentences;
}

}  // namespace plica
