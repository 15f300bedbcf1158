// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/core/time_functions.hpp>
#include <plica/drivers/contact/contact.hpp>
#include <plica/drivers/contact/sample_distance.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/kernels/contact/find_on_faces.hpp>
#include <plica/kernels/contact/find_on_points.hpp>
#include <plica/kernels/contact/move_tool.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>
#include <type_traits>

// Only obstacles_float.cpp and obstacles_double.cpp include this header, because the kernels of all
// shapes take long to compile.
namespace plica {

/// Obstacle whose shape is known at compile time.
template <class B, class Shape>
class ObstacleOf final : public Obstacle<B> {
  using Real = typename B::Real;
  using Exec = typename B::Exec;
  Shape shape_;
  Scalars<B> storage_;  // memory that the shape points to
  Vec3<double> origin_;
  double radius_;
  ObstacleOptions options_;
  std::vector<PathKnot> knots_;
  Path path_;
  Turning turning_;
  DepthWatch<B> watch_;
  Doubles<B> tools_;  // memory of all tools with mass; empty: this one has no mass
  RigidTool tool_;    // mass and coupling; not used without mass
  int first_;         // index of this tool's first number in tools_
  Real longest_;      // longest edge of the surface [m]
  static constexpr Real face_reach = Real(0.25);  // reach of triangles over that of points

 public:
  ObstacleOf(const Shape& shape, const Scalars<B>& storage, const Point& origin, double radius,
             const ObstacleOptions& options, const DepthWatch<B>& watch, const Doubles<B>& memory,
             int number, double longest)
      : shape_(shape),
        storage_(storage),
        origin_(vec3<double>(options.centre_of_mass.value_or(origin))),
        radius_(radius),
        options_(options),
        path_(make_path(options.motion, knots_)),
        watch_(watch),
        tools_(options.mass ? memory : Doubles<B>()),
        first_(ObstacleMotion<B>::numbers * number),
        longest_(static_cast<Real>(longest)) {
    options_.shape.reset();
    set_turn(options.turn);
    if (options.mass) tool_ = rigid_tool(options);
  }

  void find(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& s, double time,
            int number, bool faces, const ContactRecords<B>& records) const override {
    const ObstacleMotion<B> at = place(time, static_cast<double>(records.span));
    const Real reach = face_reach * records.reach;
    fill(exec, records.close, 0);
    // A triangle touches nothing if all of its corners are further away than `between` [m]. This
    // holds for triangles that are stretched no more than FindOnFaces allows.
    const Real between =
        reach + FindOnFaces<B, Shape>::stretch * FindOnFaces<B, Shape>::from_corner * longest_;
    update_vertices<B>(
        exec, "plica::contact_find", surface.points,
        FindOnPoints<B, Shape>{surface, s.v, shape_, at, watch_, number, between, records});
    if (faces)
      update_vertices<B>(exec, "plica::contact_faces", records.faces,
                         FindOnFaces<B, Shape>{shape_, at, number, reach, between, records});
  }
  void grasp(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& s, double time,
             int number, double reach, const ContactRecords<B>& records) const override {
    update_vertices<B>(exec, "plica::contact_grasp", surface.points,
                       Grasp<B, Shape>{surface, s.u, shape_, place(time, 0), records, number,
                                       static_cast<Real>(reach)});
  }
  ObstacleMotion<B> place(double time, double ahead) const override {
    const PathPoint now = path_step(path_, knots_.data(), time, ahead);
    return {origin_, ObstaclePose{now.displacement, now.velocity, time, turning_.at(time, ahead)},
            tools_, first_, !options_.inertia.empty()};
  }
  void set_motion(const Motion& motion) override {
    knots_.clear();
    path_ = make_path(motion, knots_);
  }
  void set_turn(const std::optional<Turn>& turn) override {
    turning_ = turn ? Turning(*turn, {origin_[0], origin_[1], origin_[2]}) : Turning();
  }
  void move(const Exec& exec, const Doubles<B>& wrench, int number, double end,
            double span) const override {
    if (!options_.mass) return;
    const ObstacleMotion<B> now = place(end, 0), next = place(end + span, 0);
    update_vertices<B>(exec, "plica::contact_tool", 1,
                       MoveTool<B>{now, next.pose, wrench, 6 * number, span, tool_});
  }
  double radius() const override { return radius_; }
  bool convex() const override { return Shape::convex; }
  std::size_t bytes() const override { return storage_.span() * sizeof(Real); }
};

/// Returns the shape as kernels evaluate it. The owner of the shape keeps `storage`, the memory
/// that the shape points to. `radius` becomes that of the largest ball inside the shape [m].
template <class B, class S>
auto device_shape(S, const typename S::Options& o, Scalars<B>& storage, double& radius) {
  using Real = typename B::Real;
  if constexpr (std::is_same_v<S, SampledSurface>) {
    const DistanceGrid grid = sample_distance(o.surface, o.cells, o.thickness);
    radius = -*std::min_element(grid.value.begin(), grid.value.end());
    storage = to_device<Scalars<B>>("contact.distance_grid",
                                    std::vector<Real>(grid.value.begin(), grid.value.end()));
    return SampledSurface::Shape<Real>{storage.data(),
                                       {grid.nodes[0], grid.nodes[1], grid.nodes[2]},
                                       vec3<Real>(grid.origin),
                                       static_cast<Real>(grid.cell),
                                       static_cast<Real>(grid.margin)};
  } else {
    radius = S::radius(o);
    return S::template shape<Real>(o);
  }
}

template <class B>
std::unique_ptr<Obstacle<B>> make_obstacle(const ObstacleOptions& options,
                                           const DepthWatch<B>& watch, const Doubles<B>& memory,
                                           int number, double longest) {
  std::unique_ptr<Obstacle<B>> obstacle;
  visit_shape(options.shape, [&](auto shape, const auto& its) {
    Scalars<B> storage;
    double radius = 0;
    const auto made = device_shape<B>(shape, its, storage, radius);
    using Shape = std::decay_t<decltype(made)>;
    obstacle =
        std::make_unique<ObstacleOf<B, Shape>>(made, storage, decltype(shape)::origin(its), radius,
                                               options, watch, memory, number, longest);
  });
  return obstacle;
}

}  // namespace plica
