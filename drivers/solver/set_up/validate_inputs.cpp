// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/solver/set_up/expect.hpp>
#include <plica/drivers/solver/set_up/validate_inputs.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/sound_surface.hpp>

namespace plica {

namespace {

/// Of a path or a factor: at least one knot, each later than the one before.
template <class Knots>
void check_times(const std::string& option, const Knots& knots) {
  if (knots.empty()) throw InputError(option + " is empty; expected at least one time");
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const std::string at = option + "." + std::to_string(i) + ".time";
    not_negative(at, knots[i].time, " s");
    if (i > 0)
      expect(knots[i].time > knots[i - 1].time, at, knots[i].time,
             "a time after that of the entry before, " + number(knots[i - 1].time, 9) + " s");
  }
}

struct CheckSelection {
  const std::string& option;
  void operator()(const Box& box) const {
    finite(option + ".box.min", box.min);
    finite(option + ".box.max", box.max);
    for (int k = 0; k < 3; ++k) expect(box.min[k] <= box.max[k], option + ".box.min", box.min[k], "at most box.max");
  }
  void operator()(const BallSelection& ball) const {
    finite(option + ".sphere.centre", ball.centre);
    positive(option + ".sphere.radius", ball.radius, " m");
  }
  void operator()(const HalfSpaceSelection& half) const {
    finite(option + ".plane.point", half.point);
    direction(option + ".plane.normal", half.normal);
  }
  void operator()(const NearestSelection& nearest) const { finite(option + ".nearest", nearest.to); }
  template <class Named>
  void operator()(const Named&) const {}  // names are looked up on each level
};

struct CheckCourse {
  const std::string& option;
  void operator()(const ConstantCourse&) const {}
  void operator()(const RampCourse& c) const { positive(option + ".ramp", c.duration, " s"); }
  void operator()(const SineCourse& c) const {
    positive(option + ".sine.frequency", c.frequency, " 1/s");
    expect(std::isfinite(c.phase), option + ".sine.phase", c.phase, "a finite angle");
  }
  void operator()(const PolygonCourse& c) const {
    check_times(option + ".course", c.knots);
    for (const auto& knot : c.knots)
      expect(std::isfinite(knot.factor), option + ".course", knot.factor, "finite numbers");
  }
};

void check_closed(const std::string& option, const TriangleSurface& surface) {
  if (surface.triangles.empty()) throw InputError(option + " has no triangle");
  for (const Point& p : surface.vertices) finite(option + " vertex", p);
  for (const auto& t : surface.triangles)
    for (int v : t)
      expect(v >= 0 && v < static_cast<int>(surface.vertices.size()), option + " triangle's vertex", v,
             "0 to " + std::to_string(static_cast<long>(surface.vertices.size()) - 1));
  SurfaceReport edges;
  count_edges(surface, edges);
  if (!edges.closed())
    throw InputError(option + " has no inside: of its edges " + std::to_string(edges.open_edges) +
                     " are open (of one triangle), " + std::to_string(edges.crowded_edges) +
                     " of more than two triangles and " + std::to_string(edges.inconsistent_edges) +
                     " between triangles that look to different sides; expected a closed surface");
  const double volume = enclosed_volume(surface);
  expect(volume > 0, option + ", as an enclosed volume,", volume, "triangles counter-clockwise seen from outside");
}

struct CheckShape {
  const std::string& option;
  void ends(const std::string& shape, const Point& from, const Point& to, double radius) const {
    finite(option + shape + ".from", from);
    finite(option + shape + ".to", to);
    positive(option + shape + ".to, as a distance from .from,", (to - from).norm(), " m");
    positive(option + shape + ".radius", radius, " m");
  }
  void operator()(const PlaneOptions& o) const {
    finite(option + ".plane.point", o.point);
    direction(option + ".plane.normal", o.normal);
  }
  void operator()(const SphereOptions& o) const {
    finite(option + ".sphere.centre", o.centre);
    positive(option + ".sphere.radius", o.radius, " m");
  }
  void operator()(const BowlOptions& o) const {
    finite(option + ".bowl.centre", o.centre);
    positive(option + ".bowl.radius", o.radius, " m");
    expect(o.rim >= 0 && o.rim <= o.radius, option + ".bowl.rim", o.rim,
           "a height above the lowest point from 0 to the radius");
  }
  void operator()(const CapsuleOptions& o) const { ends(".capsule", o.from, o.to, o.radius); }
  void operator()(const CylinderOptions& o) const { ends(".cylinder", o.from, o.to, o.radius); }
  void operator()(const BlockOptions& o) const {
    finite(option + ".box.centre", o.centre);
    for (int k = 0; k < 3; ++k) positive(option + ".box.size", o.size[k], " m");
    finite(option + ".box.rotation", o.rotation);
  }
  void operator()(const SurfaceOptions& o) const {
    expect(o.cells == 0 || (o.cells >= 4 && o.cells <= 512), option + ".surface.cells", o.cells,
           "4 to 512, or 0 to have them chosen");
    check_closed(option + ".surface", o.surface);
  }
};

}  // namespace

void validate_selection(const std::string& option, const Selection& selection) {
  std::visit(CheckSelection{option}, selection);
}

void validate_motion(const std::string& option, const Motion& motion) {
  if (const auto* steady = std::get_if<SteadyMotion>(&motion)) {
    finite(option + ".velocity", steady->velocity);
  } else if (const auto* sine = std::get_if<SineMotion>(&motion)) {
    finite(option + ".sine.amplitude", sine->amplitude);
    positive(option + ".sine.frequency", sine->frequency, " 1/s");
    expect(std::isfinite(sine->phase), option + ".sine.phase", sine->phase, "a finite angle");
  } else {
    const auto& knots = std::get<PathMotion>(motion).knots;
    check_times(option + ".path", knots);
    for (std::size_t i = 0; i < knots.size(); ++i)
      finite(option + ".path." + std::to_string(i) + ".displacement", knots[i].displacement);
  }
}

void validate_load(const std::string& option, const LoadOptions& load) {
  validate_selection(option, load.where);
  if (const auto* traction = std::get_if<Traction>(&load.load))
    finite(option + ".traction", traction->value);
  else
    finite(option + ".force", std::get<TotalForce>(load.load).value);
  std::visit(CheckCourse{option}, load.course);
}

void validate_velocities(const InitialOptions& o) {
  finite("body.initial.velocity", o.velocity);
  finite("body.initial.angular_velocity", o.angular_velocity);
  if (const auto& twist = o.twist) {
    finite("body.initial.twist.from", twist->from);
    finite("body.initial.twist.to", twist->to);
    positive("body.initial.twist.to, as a distance from .from,", (twist->to - twist->from).norm(), " m");
    expect(std::isfinite(twist->angular_velocity), "body.initial.twist.angular_velocity", twist->angular_velocity,
           "a finite number, rad/s");
  }
  finite("body.initial.stretch", o.stretch);
  if (o.random) {
    expect(*o.random >= 0, "body.initial.random", *o.random, "a seed, 0 or more");
    if (o.stretch != Point::Ones())
      throw InputError("body.initial has stretch and random, which puts vertices anywhere; expected one of them");
  }
  for (std::size_t i = 0; i < o.parts.size(); ++i) {
    const std::string option = "body.initial.parts." + std::to_string(i);
    validate_selection(option, o.parts[i].where);
    finite(option + ".velocity", o.parts[i].velocity);
  }
}

void validate_obstacle(const std::string& option, const ObstacleOptions& o) {
  std::visit(CheckShape{option}, o.shape);
  if (o.friction) not_negative(option + ".friction", *o.friction, "");
  validate_motion(option, o.motion);
}

}  // namespace plica
