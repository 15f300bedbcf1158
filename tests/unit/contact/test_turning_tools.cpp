// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <plica/core/error.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/cycles/him/advice.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Obstacles that turn about an axis, besides their motion.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double pi = std::numbers::pi, side = 0.06;

/// A cube from 0 to `side` along every axis, its boundary as surface.
Problem cube() {
  Problem p = body_of({box_mesh({{0, 0, 0}, {side, side, side}}, {4, 4, 4})}, "neo_hookean");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  return p;
}

/// Below a plate that turns.
Problem below(const Turn& turn) {
  Problem p = cube();
  p.contact.obstacles = {
      {BlockOptions{{side / 2, side / 2, side + 0.0105}, {0.2, 0.2, 0.02}, {0, 0, 0}}, {}, {}}};
  p.contact.obstacles[0].name = "plate", p.contact.obstacles[0].turn = turn;
  return p;
}

Eigen::Matrix3d rotation(const Point& vector) {
  return Eigen::AngleAxisd(vector.norm(), vector.normalized()).toRotationMatrix();
}

std::vector<Point> mapped(const TetMesh& mesh, const auto& f) {
  std::vector<Point> values;
  for (const Point& x : mesh.vertices) values.push_back(f(x));
  return values;
}

double largest_difference(const std::vector<Point>& a, const std::vector<Point>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

// --- Where they are, and how fast ---

const Point about(0.02, -0.01, 0.03), axis(1, -2, 2);
const double angle = 0.7;

/// A shape, and the same shape built turned by `angle` about `axis` through `about`.
struct Twins {
  ShapeOptions shape, turned;
};
std::vector<Twins> twins() {
  const Point by = angle * axis.normalized();
  const Eigen::Matrix3d R = rotation(by);
  const auto at = [&](const Point& x) { return Point(about + R * (x - about)); };
  const Point low(-0.02, 0.02, 0.05), high(0.05, 0.03, 0.07), centre(0.02, 0.02, 0.05),
      size(0.05, 0.04, 0.03);
  return {{PlaneOptions{{0, 0, 0.03}, {0.3, 0, 1}},
           PlaneOptions{at({0, 0, 0.03}), R * Point(0.3, 0, 1)}},
          {SphereOptions{centre, 0.03}, SphereOptions{at(centre), 0.03}},
          {CapsuleOptions{low, high, 0.02}, CapsuleOptions{at(low), at(high), 0.02}},
          {ConeOptions{low, high, 0.03, 0.01}, ConeOptions{at(low), at(high), 0.03, 0.01}},
          {CylinderOptions{low, high, 0.03}, CylinderOptions{at(low), at(high), 0.03}},
          {BlockOptions{centre, size, {0, 0, 0}}, BlockOptions{at(centre), size, by}}};
}

template <class B>
class TurningToolsOn : public testing::Test {};
TYPED_TEST_SUITE(TurningToolsOn, EachBackend);

// A tool that has got to an angle does to a body that goes with it what one built so does to a body
// at rest: places, normals, friction, and velocities relative to it. On points and, of thin tools,
// on faces.
TYPED_TEST(TurningToolsOn, DoWhatOnesBuiltTurnedDo) {
  using Real = typename TypeParam::Real;
  constexpr double time = 0.1;
  const Point speed(0.3, -0.2, 0.1), way = time * speed, rate = angle / time * axis.normalized();
  for (const Twins& pair : twins())
    for (const char* rule : {"never", "always"}) {
      Problem still = cube();
      still.contact.whole_surface = rule;
      still.contact.obstacles = {{pair.turned, 0.4, PathMotion{{{0, way}}}}};
      Problem turning = still;
      turning.contact.obstacles = {{pair.shape, 0.4, SteadyMotion{speed}}};
      turning.contact.obstacles[0].turn = Turn{axis, about, {0, 0, 0}, SteadyTurn{angle / time}};
      LevelProbe<TypeParam> built(still), turned(turning);
      const TetMesh& mesh = still.body.levels[0];
      const auto u = random_field(mesh.vertices.size(), 2e-3, 3),
                 own = random_field(mesh.vertices.size(), 0.2, 4);
      auto v = own;
      for (std::size_t a = 0; a < v.size(); ++a) {
        const Point x = mesh.vertices[a] + u[a];
        v[a] += speed + rate.cross(x - about - way);
      }
      const auto want = built.force(u, own, time), got = turned.force(u, v, time);
      double size = 0;
      for (const Point& f : want) size = std::max(size, f.norm());
      EXPECT_GT(size, 10);
      EXPECT_LE(largest_difference(want, got), round_off<Real>(20000, size)) << rule;
    }
}

// A tool and a body that are turned together feel the same forces, turned: also of shapes that
// cannot be built turned.
TYPED_TEST(TurningToolsOn, FeelTheSameTurnedAlong) {
  using Real = typename TypeParam::Real;
  constexpr double time = 0.1;
  const Point unit = axis.normalized(), rate = angle / time * unit;
  const Eigen::Matrix3d R = rotation(angle * unit);
  const TriangleSurface ball = boundary_surface(ball_mesh({0.03, 0.02, 0.05}, 0.03, 6)).surface;
  for (const ShapeOptions& shape : {ShapeOptions(BowlOptions{{0.03, 0.03, 0.05}, 0.06, 0.05}),
                                    ShapeOptions(SurfaceOptions{ball, 16})}) {
    Problem p = cube();
    p.contact.obstacles = {{shape, 0.3, {}}};
    LevelProbe<TypeParam> still(p);
    p.contact.obstacles[0].turn = Turn{axis, about, {0, 0, 0}, SteadyTurn{angle / time}};
    LevelProbe<TypeParam> turned(p);
    const std::vector<Point>& rest = p.body.levels[0].vertices;
    const auto u = random_field(rest.size(), 2e-3, 3), v = random_field(rest.size(), 0.2, 4);
    auto u_turned = u, v_turned = v;
    for (std::size_t a = 0; a < rest.size(); ++a) {
      const Point arm = R * (rest[a] + u[a] - about);
      u_turned[a] = about + arm - rest[a], v_turned[a] = R * v[a] + rate.cross(arm);
    }
    auto want = still.force(u, v);
    double size = 0;
    for (Point& f : want) f = R * f, size = std::max(size, f.norm());
    EXPECT_GT(size, 10);
    EXPECT_LE(largest_difference(want, turned.force(u_turned, v_turned, time)),
              round_off<Real>(50000, size));
  }
}

TEST(TurningTools, TurnByAngleAndBySine) {
  const Motion path = angle_of({{0, 0, 2}, {}, {0, 0, 0}, PathTurn{{{0, 0}, {2, 1}}}});
  EXPECT_EQ(std::get<PathMotion>(path).knots[1].displacement, Point(0, 0, 1));
  const Motion sine = angle_of({{3, 0, 0}, {}, {0, 0, 0}, SineTurn{0.5, 2, 0.1}});
  EXPECT_EQ(std::get<SineMotion>(sine).amplitude, Point(0.5, 0, 0));
  for (const Point& r : {Point(0, 0, 0), Point(0.3, -1, 2), Point(0, 0, 3.1)})
    EXPECT_LE((rotation_vector(rotation_by(r)) - r).norm(), 1e-14);
}

// What is turned from the start by `rotation`, and then by its angle, is where both take it.
TEST(TurningTools, StartTurned) {
  Problem p = cube();
  p.contact.obstacles = {{BlockOptions{{0.1, 0, -1}, {0.02, 0.02, 0.02}, {0, 0, 0}},
                          {},
                          SteadyMotion{Point(1, 0, 0)}}};
  p.contact.obstacles[0].turn = Turn{{0, 0, 1}, Point(0, 0, 0), {pi / 2, 0, 0}, SteadyTurn{pi}};
  Simulation<Host> s(p);
  s.set_time(0.5);
  const Point want = Eigen::AngleAxisd(pi / 2, Point::UnitZ()) *
                     (Eigen::AngleAxisd(pi / 2, Point::UnitX()) * Point(0.1, 0, -1));
  EXPECT_LE((s.obstacle_origin(0) - want - Point(0.5, 0, 0)).norm(), 1e-14);
  EXPECT_EQ(s.obstacle_displacement(0), Point(0.5, 0, 0));
  const Point r = s.obstacle_rotation(0);
  EXPECT_LE((rotation(r) * Point(0.1, 0, -1) - want).norm(), 1e-14);
}

// --- What they do to bodies ---

Point momentum_about_z(const Problem& p,
                       // of the mass: centre's velocity x, y; angular velocity
                       const Simulation<Host>& s) {
  const auto mass = lumped_masses(p.body.levels[0], {p.body.material.density});
  const auto x = s.positions(), v = s.velocities();
  double all = 0, inertia = 0, turning = 0;
  Point centre = Point::Zero(), speed = Point::Zero();
  for (std::size_t a = 0; a < x.size(); ++a)
    all += mass[a], centre += mass[a] * x[a], speed += mass[a] * v[a];
  centre /= all, speed /= all;
  for (std::size_t a = 0; a < x.size(); ++a) {
    const Point r = x[a] - centre;
    inertia += mass[a] * (r[0] * r[0] + r[1] * r[1]);
    turning += mass[a] * r.cross(v[a] - speed)[2];
  }
  return {speed[0], speed[1], turning / inertia};
}

// On a turntable a cube is taken along by friction until it turns as fast, about the same axis.
TEST(TurningTools, TurntableTakesACubeAlong) {
  for (const std::string method : {"symplectic_euler", "rk4", "implicit_euler", "him"}) {
    Problem p = cube();
    p.gravity = {0, 0, -9.81};
    p.integration.macro_step = method == "implicit_euler" ? 1e-3 : 2e-4;
    if (method == "him")
      p.integration.cycle = method,
      p.body.levels.push_back(box_mesh({{0, 0, 0}, {side, side, side}}, {2, 2, 2}));
    else
      p.integration.integrator = {method};
    p.contact.obstacles = {{PlaneOptions{{side / 2, side / 2, 0}, {0, 0, 1}}, 0.5, {}}};
    p.contact.obstacles[0].turn = Turn{{0, 0, 1}, {}, {0, 0, 0}, SteadyTurn{3}};
    Simulation<Host> s(p);
    while (s.time() < 0.3) advance(s, 1);
    Point mean = Point::Zero();
    int steps = 0;
    for (; s.time() < 0.6; ++steps) advance(s, 1), mean += momentum_about_z(p, s);
    mean /= steps;
    EXPECT_NEAR(mean[2], 3, 0.04) << method;
    EXPECT_LT(std::hypot(mean[0], mean[1]), 0.02 * 3 * side) << method;
  }
}

// A drum beside a free body throws it off at no more than its rim's speed; frictionless it does
// nothing along the rim.
TEST(TurningTools, DrumDragsAtTheSpeedOfItsRim) {
  for (const bool rough : {true, false}) {
    Problem p = cube();
    p.body.damping.mass = 0;
    const double radius = 0.2, rate = 5;  // the rim goes at 1 m/s to the right
    p.gravity = {0, 0, -9.81};
    CylinderOptions drum{{side / 2, -0.2, -radius}, {side / 2, 0.3, -radius}, radius};
    p.contact.obstacles = {{drum, rough ? std::optional<double>(1) : std::nullopt, {}}};
    p.contact.obstacles[0].turn = Turn{{0, 1, 0}, {}, {0, 0, 0}, SteadyTurn{rate}};
    p.integration.macro_step = 2e-4;
    Simulation<Host> s(p);
    double most = 0;
    for (int n = 0; n < 600; ++n) advance(s, 1), most = std::max(most, momentum_about_z(p, s)[0]);
    if (rough) {
      EXPECT_GT(most, 0.6);  // in 0.1 s friction alone gives it 1 m/s
      EXPECT_LT(most, 1.15);
    } else {
      EXPECT_LT(most, 0.05);
    }
  }
}

// A floor that tilts about its edge carries the cube up to its slope of friction, and its wrench is
// the weight; then the cube slides.
TEST(TurningTools, TiltedFloorHoldsUpToTheAngleOfFriction) {
  for (const double slope : {0.2, 0.5}) {  // tan 0.2 = 0.20, tan 0.5 = 0.55
    Problem p = cube();
    p.gravity = {0, 0, -9.81};
    p.body.damping.mass = 5;
    p.contact.obstacles = {
        {BlockOptions{{0.1, side / 2, -0.1}, {0.6, 0.6, 0.2}, {0, 0, 0}}, 0.35, {}}};
    p.contact.obstacles[0].turn =
        Turn{{0, -1, 0}, Point(0, 0, 0), {0, 0, 0}, PathTurn{{{0, 0}, {0.3, slope}}}};
    p.integration.macro_step = 2e-4;
    Simulation<Host> s(p);
    while (s.time() < 0.6) advance(s, 1);
    Point force = Point::Zero();
    for (int n = 0; n < 500; ++n) advance(s, 1), force += s.wrenches()[0].force / 500;
    const Eigen::Matrix3d back = rotation({0, slope, 0});
    Point mean = Point::Zero(), rest = Point::Zero();
    const auto x = s.positions();
    for (std::size_t a = 0; a < x.size(); ++a)
      mean += back * x[a], rest += p.body.levels[0].vertices[a];
    const double down = (rest - mean)[0] / static_cast<double>(x.size()),
                 height = mean[2] / rest[2];
    EXPECT_NEAR(height, 1, 0.05) << slope;  // on the floor, which has turned below it
    if (slope < 0.3) {
      EXPECT_LT(std::abs(down), 0.05 * side);
      double weight = 0;
      for (const double m : lumped_masses(p.body.levels[0], {p.body.material.density}))
        weight += 9.81 * m;
      EXPECT_LE((force - Point(0, 0, weight)).norm(), 0.02 * weight);
    } else {
      EXPECT_GT(down, 0.5 * side);
    }
  }
}

// A blade and a needle swing by many times their thickness in a step: they take the points along
// that they meet, and no others.
TEST(TurningTools, FastOnesDoNotPassPoints) {
  constexpr double rate = 1500, thickness = 0.4e-3;  // 200 m/s at the cube's middle
  const Point hinge(-0.1, 0.08, side / 2), end = hinge - Point(0, 0.24, 0);
  for (const ShapeOptions& shape :
       {ShapeOptions(BlockOptions{(hinge + end) / 2, {thickness, 0.24, 0.2}, {0, 0, 0}}),
        ShapeOptions(CapsuleOptions{hinge, end, thickness / 2})}) {
    const bool needle = shape.type() == typeid(CapsuleOptions);
    Problem p = cube();
    p.body.material.young_modulus = 2e6;
    p.contact.whole_surface = "never";
    p.contact.obstacles = {{shape, {}, {}}};
    // it lies along x
    p.contact.obstacles[0].turn = Turn{{0, 0, -1}, hinge, {0, 0, pi / 2}, SteadyTurn{rate}};
    Simulation<Host> s(p);
    const double way = rate * s.macro_step() * (side / 2 - hinge[0]);
    ASSERT_GT(way, 50 * thickness);
    for (int n = 0; n < 200 && s.wrenches()[0].force.norm() == 0; ++n) s.step();
    ASSERT_GT(s.wrenches()[0].force.norm(), 0);
    const Point across = rotation({0, 0, -s.time() * rate}) * Point(0, 1, 0);
    const auto x = s.surface_positions();
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Point& rest = p.body.surface->vertices[i];
      if (needle && std::abs(rest[2] - side / 2) > 1e-9) {
        EXPECT_LT((x[i] - rest).norm(), 1e-9) << i;  // beside the plane that it swings in
      } else {
        EXPECT_LT(across.dot(x[i] - hinge), 0.3 * way) << needle << i;  // still below
      }
    }
  }
}

// --- What is said of them ---

TEST(TurningTools, AreRefusedWhereTheyCannotBe) {
  const auto why = [](const Turn& turn) {
    const Problem p = below(turn);
    return refusal([&] { Simulation<Host>{p}; });
  };
  EXPECT_NE(why({.axis = {0, 0, 0}}).find("contact.obstacles.0.rotate.axis"), std::string::npos);
  EXPECT_NE(why({.about = Point(0, NAN, 0)}).find("contact.obstacles.0.rotate.about"),
            std::string::npos);
  EXPECT_NE(why({.angle = SineTurn{1, 0, 0}})
                .find("contact.obstacles.0.rotate.sine.frequency is 0 1/s; expected"),
            std::string::npos);
  EXPECT_EQ(why({.angle = PathTurn{}}),
            "contact.obstacles.0.rotate.curve is empty; expected at least one time");
  EXPECT_EQ(why({.angle = PathTurn{{{0.1, 0}, {0.1, 1}}}}),
            "contact.obstacles.0.rotate.curve.1.time is 0.1 s; expected a time after that of the "
            "entry before, 0.1 s");
  const Turn steady{.angle = SteadyTurn{1}};
  Problem p = below(steady);
  p.contact.obstacles[0].mass = 1;
  EXPECT_EQ(
      refusal([&] { Simulation<Host>{p}; }),
      "contact.obstacles.0.rotate, beside mass, is of an obstacle that turns by the torque on "
      "it; expected "
      "contact.obstacles.0.inertia, too, or neither");
  p.contact.obstacles[0].turn.reset();
  Simulation<Host> heavy(p);
  EXPECT_NE(refusal([&] { heavy.set_obstacle_turn(0, steady); }).find("plate has mass"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              heavy.move_obstacle(0, Point::Zero(), {0, 0, 1});
            }).find("plate has mass"),
            std::string::npos);
  EXPECT_EQ(heavy.obstacle_displacement(0), Point(0, 0, 0));
  Simulation<Host> s(below(steady));
  EXPECT_NE(refusal([&] {
              s.set_obstacle_turn(0, Turn{.axis = {0, 0, 0}});
            }).find("turn.axis"),
            std::string::npos);
  EXPECT_NE(refusal([&] { s.set_obstacle_motion(0, PathMotion{}); }).find("motion.curve"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              s.set_obstacle_motion(0, SteadyMotion{Point(NAN, 0, 0)});
            }).find("motion.velocity"),
            std::string::npos);
  EXPECT_NE(refusal([&] { s.set_time(NAN); }).find("set_time"), std::string::npos);
  EXPECT_NE(refusal([&] { s.end_at(NAN); }).find("end_at"), std::string::npos);
  EXPECT_NE(refusal([&] {
              s.move_obstacle(0, {NAN, 0, 0}, {0, 0, 1});
            }).find("displacement"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              s.move_obstacle(0, {0, 0, 0}, {0, 0, NAN});
            }).find("rotation"),
            std::string::npos);
}

// Where it starts is where its turn has it.
TEST(TurningTools, StartOutsideOrInsideByTheirTurn) {
  Problem p = cube();
  p.contact.obstacles = {{BlockOptions{{side / 2, side / 2, 1}, {1, 1, 1.8}, {0, 0, 0}}, {}, {}}};
  EXPECT_TRUE(starts_in_obstacles(p).empty());
  p.contact.obstacles[0].motion = PathMotion{{{0, {0, 0, -0.5}}}};
  EXPECT_NE(refusal([&] { starts_in_obstacles(p); }).find("contains the whole body"),
            std::string::npos);
  p.contact.obstacles[0].motion = {};
  p.contact.obstacles[0].turn = Turn{{0, 0, 1}, Point(0, 0, 0), {pi, 0, 0}, SteadyTurn{0}};
  EXPECT_TRUE(starts_in_obstacles(p).empty());
  p.contact.obstacles[0].turn->about = Point(side / 2, side / 2, 0.5);
  EXPECT_NE(refusal([&] { starts_in_obstacles(p); }).find("contains the whole body"),
            std::string::npos);
}

// The speed that is too fast for him is that of the tool where the body is: of a needle that turns
// about itself that of its rim, of a lever that of its arm, of a plane that of the body's furthest
// point.
TEST(TurningTools, AreAsFastAsTheirFastestPlaceAtTheBody) {
  Problem p = cube();
  const Point x(side / 2, side / 2, 0);
  const auto speed = [&](const ShapeOptions& shape, const Point& about_what) {
    p.contact.obstacles = {{shape, {}, SteadyMotion{Point(0.1, 0, 0)}}};
    p.contact.obstacles[0].turn = Turn{{0, 0, 1}, about_what, {0, 0, 0}, SteadyTurn{10}};
    return fastest_obstacle(p);
  };
  EXPECT_NEAR(speed(CapsuleOptions{x, x + Point(0, 0, 1), 1e-3}, x), 0.1 + 10 * 1e-3, 1e-12);
  EXPECT_NEAR(speed(CapsuleOptions{x, x + Point(0.03, 0, 0), 1e-3}, x), 0.1 + 10 * 0.031, 1e-12);
  EXPECT_NEAR(speed(CapsuleOptions{x, x + Point(9, 0, 0), 1e-3}, x), 0.1 + 10 * side / std::sqrt(2),
              1e-12);
  EXPECT_NEAR(speed(PlaneOptions{x, {0, 0, 1}}, x), 0.1 + 10 * side / std::sqrt(2), 1e-12);
  EXPECT_NEAR(speed(ConeOptions{x, x + Point(0, 0, 1), 1e-3, 2e-3}, x), 0.1 + 10 * 2e-3, 1e-12);
  EXPECT_NEAR(speed(SphereOptions{x, 0.01}, x), 0.1 + 10 * 0.01, 1e-12);
}

}  // namespace
