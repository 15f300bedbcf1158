// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// What holds vertices, and what moves them as given: forces and moments on the body.
namespace {

using namespace plica;
using namespace plica::test;

using std::numbers::pi;

FixedVertices sliding_on(const Point& point, const Point& normal) {
  FixedVertices fixed(HalfSpaceSelection{point, normal});
  fixed.slide = Point(Point::Zero());
  return fixed;
}

// --- Confined compression ------------------------------------------------------------------------

/// First Piola-Kirchhoff stress of Plica's neo-Hookean in uniaxial strain l along z: along z and
/// across [Pa].
struct UniaxialStrain {
  double mu = 10e3 / 2.6, kappa = 10e3 / 1.2, l = 0.8;
  double along() const {
    return mu * (std::cbrt(l) - (l * l + 2) / 3 * std::pow(l, -5.0 / 3)) + kappa / 2 * (l - 1 / l);
  }
  double across() const {
    return mu * std::pow(l, -2.0 / 3) * (1 - (l * l + 2) / 3) + kappa / 2 * (l * l - 1);
  }
};

/// A decimetre of tissue between walls that it slides on, with its top pressed down by a fifth.
Problem confined(const std::string& element) {
  Problem p = body_of({box_mesh(decimetre, {6, 6, 6})}, "neo_hookean");
  p.body.element = {element};
  p.body.material.young_modulus = 10e3, p.body.material.poisson_ratio = 0.3;
  for (int k = 0; k < 3; ++k) {
    p.body.fixed.push_back(sliding_on(Point::Zero(), Point::Unit(k)));
    if (k < 2) p.body.fixed.push_back(sliding_on(0.1 * Point::Unit(k), -Point::Unit(k)));
  }
  p.body.prescribed = {{HalfSpaceSelection{{0, 0, 0.1}, {0, 0, -1}},
                        PathMotion{{{0, {0, 0, 0}}, {0.5, {0, 0, -0.02}}}}}};
  return p;
}

/// Sets are: left, right, front, back, bottom, and the top that moves.
void expect_confined(const std::vector<Reaction>& held, double tolerance) {
  const UniaxialStrain exact;
  EXPECT_NEAR(0.01 * exact.along(), -32.14, 0.005);
  EXPECT_NEAR(0.01 * exact.across(), -9.644, 0.0005);
  ASSERT_EQ(held.size(), 6u);
  const double top = 0.01 * exact.along(), side = -0.01 * exact.across();
  const Point forces[] = {{side, 0, 0},  {-side, 0, 0}, {0, side, 0},
                          {0, -side, 0}, {0, 0, -top},  {0, 0, top}};
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_LE((held[i].force - forces[i]).norm(), tolerance) << held[i].set;
  EXPECT_EQ(held[5].set, "prescribed_0");
  // the middle of a wall that is pressed is 1 cm below its centre at rest
  EXPECT_LE((held[0].torque - Point(0, -0.01 * side, 0)).norm(), 0.1 * tolerance);
  EXPECT_LE((held[0].about - Point(0, 0.05, 0.05)).norm(), 1e-15);
  EXPECT_LE(held[4].torque.norm(), 0.1 * tolerance);
}

// In the state of the closed form, forces are right to rounding.
TEST(Reactions, OfConfinedCompressionAreExact) {
  for (const char* element : {"linear", "nodal"}) {
    SCOPED_TRACE(element);
    const Problem p = confined(element);
    Simulation<Host> s(p);
    std::vector<Point> u;
    for (const Point& x : p.body.levels[0].vertices) u.push_back({0, 0, -0.2 * x[2]});
    s.set_state(u, std::vector<Point>(u.size(), Point::Zero()));
    expect_confined(s.reactions(), 1e-10);
  }
}

TEST(Reactions, OfConfinedCompressionAreFoundByAnyIntegrator) {
  for (const char* integrator : {"symplectic_euler", "implicit_euler"}) {
    SCOPED_TRACE(integrator);
    Problem p = confined("linear");
    p.body.damping.mass = 100;
    p.integration.integrator = {integrator};
    if (p.integration.integrator[0] == "implicit_euler") p.integration.macro_step = 0.05;
    Simulation<Host> s(p);
    advance(s, static_cast<int>(1 / s.macro_step()));
    expect_confined(s.reactions(), 0.01);
  }
}

// --- Balance -------------------------------------------------------------------------------------

struct Momentum {
  Point free = Point::Zero(), weight = Point::Zero();
  double held_mass = 0;
};

/// Momentum of the vertices off the face x = 0, the body's weight, and the mass on that face.
Momentum momentum_of(const Simulation<Host>& s, const Problem& p) {
  const TetMesh& mesh = p.body.levels[0];
  const auto v = s.velocities();
  std::vector<double> mass(v.size(), 0);
  for (const auto& t : mesh.tets) {
    const auto x = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    for (const int a : t)
      mass[static_cast<std::size_t>(a)] += 1000 * tet_volume(x(0), x(1), x(2), x(3)) / 4;
  }
  Momentum sum;
  for (std::size_t a = 0; a < v.size(); ++a) {
    sum.weight += mass[a] * p.gravity;
    if (mesh.vertices[a][0] == 0)
      sum.held_mass += mass[a];
    else
      sum.free += mass[a] * v[a];
  }
  return sum;
}

/// Expects the reaction before an explicit step to be what changes the body's momentum in it.
/// `acceleration`: mean one of the vertices that are held.
void expect_balance(const Problem& given, const Point& acceleration, int steps) {
  Problem p = given;
  p.gravity = {1, -2, -9.81};
  p.integration.macro_step = 2e-4;
  Simulation<Host> s(p);
  advance(s, steps);
  const Momentum before = momentum_of(s, p);
  const Point force = s.reactions().at(0).force;
  advance(s, 1);
  const Point gained = (momentum_of(s, p).free - before.free) / s.macro_step();
  const Point expected = gained + before.held_mass * acceleration - before.weight;
  EXPECT_GT(force.norm(), 1e-3);
  EXPECT_LE((force - expected).norm(), 1e-9 * expected.norm());
}

TEST(Reactions, ChangeTheMomentum) {
  Problem p = small_cube("neo_hookean");
  p.body.fixed = {left_face()};
  p.body.initial.velocity = {0.2, 0.1, -0.1};
  expect_balance(p, Point::Zero(), 0);
  expect_balance(p, Point::Zero(), 25);
}

TEST(Reactions, AccelerateWhatIsShaken) {
  Problem p = small_cube("neo_hookean");
  const SineMotion shake{{1e-3, -5e-4, 0}, 10, 0.4};
  p.body.prescribed = {{left_face(), shake}};
  const double rate = 2 * pi * shake.frequency, time = 25 * 2e-4;
  expect_balance(p, -rate * rate * std::sin(rate * time + shake.phase) * shake.amplitude, 25);
}

// The mass centre of the face turns about a point beside it.
TEST(Reactions, HoldWhatTurnsOnItsCircle) {
  Problem p = small_cube("neo_hookean");
  p.body.levels = {box_mesh(decimetre, {3, 3, 3})};
  const double rate = 3;
  p.body.prescribed = {{left_face(), Motion()}};
  p.body.prescribed[0].rotate =
      Turn{.axis = Point(1, 0, 0), .about = Point(0, 0.3, 0.05), .angle = SteadyTurn{rate}};
  TetMesh& mesh = p.body.levels[0];
  Point sum = Point::Zero();
  double whole = 0;
  for (const auto& t : mesh.tets)
    for (const int a : t)
      if (const Point& x = mesh.vertices[static_cast<std::size_t>(a)]; x[0] == 0)
        sum += x - Point(0, 0.3, 0.05), whole += 1;  // tetrahedra of one size
  const double angle = rate * 25 * 2e-4;
  const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Point::UnitX()).toRotationMatrix();
  expect_balance(p, -rate * rate * R * sum / whole, 25);
}

// At rest the support carries the weight, and its moment.
TEST(Reactions, CarryTheWeight) {
  for (const char* element : {"linear", "nodal"}) {
    SCOPED_TRACE(element);
    Problem p = body_of({jittered_box(beam_box, {8, 2, 2})}, "neo_hookean");
    p.body.element = {element};
    p.body.material.young_modulus = 2e6;
    p.body.fixed = {left_face()};
    p.gravity = {0, 0, -9.81};
    p.integration.integrator = {"implicit_euler"};
    p.integration.macro_step = 100;
    p.integration.implicit.relative_residual = 1e-10;
    p.integration.implicit.newton_tolerance = 1e-9;
    Simulation<Host> s(p);
    advance(s, 5);
    const Reaction held = s.reactions().at(0);
    const TetMesh& mesh = p.body.levels[0];
    const auto x = s.positions();
    Point moment = Point::Zero();
    for (const auto& t : mesh.tets) {
      const auto X = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
      const double share = 1000 * tet_volume(X(0), X(1), X(2), X(3)) / 4;
      for (const int a : t)
        moment += (x[static_cast<std::size_t>(a)] - held.about).cross(share * p.gravity);
    }
    const double weight = 0.4 * 0.1 * 0.1 * 1000 * 9.81;
    EXPECT_LE((held.force - Point(0, 0, weight)).norm(), 1e-6 * weight);
    EXPECT_LE((held.torque + moment).norm(), 1e-6 * moment.norm());
    EXPECT_LE((held.about - Point(0, 0.05, 0.05)).norm(), 1e-15);
  }
}

// --- Turned ends ---------------------------------------------------------------------------------

Turn by_curve(const Point& axis, double angle, double end) {
  return {.axis = axis, .angle = PathTurn{{{0, 0}, {end, angle}}}};
}

TEST(Rotate, PutsVerticesOnTheirCircles) {
  const Point about(0.02, -0.03, 0.1), axis = Point(1, 2, -2).normalized();
  for (const std::string& integrator : names(integrators())) {
    SCOPED_TRACE(integrator);
    Problem p = small_cube();
    p.body.prescribed = {{left_face(), Motion()}};
    p.body.prescribed[0].rotate = by_curve(axis, 0.6, 0.03);
    p.body.prescribed[0].rotate->about = about;
    p.integration.integrator = {integrator};
    p.integration.macro_step = 5e-4;
    p.integration.substeps = {2};
    p.integration.allow_unstable = true;
    Simulation<Host> s(p);
    advance(s, 30);
    const Eigen::Matrix3d R = Eigen::AngleAxisd(0.6 * s.time() / 0.03, axis).toRotationMatrix();
    const auto x = s.positions(), v = s.velocities();
    const TetMesh& mesh = p.body.levels[0];
    for (std::size_t a = 0; a < x.size(); ++a) {
      if (mesh.vertices[a][0] != 0) continue;
      const Point arm = R * (mesh.vertices[a] - about);
      EXPECT_LE((x[a] - about - arm).norm(), 1e-14);
      EXPECT_LE((v[a] - 20 * axis.cross(arm)).norm(), 1e-12);
    }
  }
}

// Where no point is given, all levels turn about the same: the centre of level 0's vertices.
TEST(Rotate, TurnsAllLevelsAboutOnePoint) {
  Problem p = cube_levels(2, 4, "rsv");
  p.body.initial.position = Point(1, 2, 3);
  p.body.prescribed = {{left_face(), Motion()}};
  p.body.prescribed[0].rotate = Turn{.axis = Point::UnitX(), .rotation = Point(pi / 2, 0, 0)};
  Simulation<Host> s(p);
  const Point about(0.95, 2, 3);
  EXPECT_LE((s.reactions().at(0).about - about).norm(), 1e-14);
  for (int level = 0; level < 2; ++level) {
    const auto x = s.positions(level);
    const TetMesh& mesh = p.body.levels[static_cast<std::size_t>(level)];
    for (std::size_t a = 0; a < x.size(); ++a) {
      if (mesh.vertices[a][0] != 0) continue;
      const Point arm = mesh.vertices[a] - Point(0, 0.05, 0.05);
      EXPECT_LE((x[a] - about - Point(0, -arm[2], arm[1])).norm(), 1e-14) << level;
    }
  }
}

/// Polar moment of area of the face z = 0 [m^4].
double polar_moment(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& t : boundary_triangles(mesh)) {
    const auto x = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    const Point a = x(0), b = x(1), c = x(2);
    if (a[2] == 0 && b[2] == 0 && c[2] == 0)
      sum += (b - a).cross(c - a).norm() / 12 *
             (a.dot(a) + b.dot(b) + c.dot(c) + a.dot(b) + b.dot(c) + c.dot(a));
  }
  return sum;
}

/// Torque on a cylinder whose upper end is turned by half a radian, over mu J times the angle per
/// length [1], J the polar moment of its mesh. `cells`: across the diameter.
double torque_over_exact(int cells) {
  constexpr double radius = 0.02, length = 0.06, angle = 0.5, mu = 5e3;
  Problem p = body_of({cylinder_mesh({0, 0, 0}, radius, length, cells, cells)}, "neo_hookean");
  p.body.material.young_modulus = 2.6 * mu, p.body.material.poisson_ratio = 0.3;
  p.body.element = {"nodal"};
  p.body.fixed = {HalfSpaceSelection{}};
  p.body.prescribed = {{HalfSpaceSelection{{0, 0, length}, {0, 0, -1}}, Motion()}};
  p.body.prescribed[0].rotate = by_curve(Point::UnitZ(), angle, 0.5);
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 0.1;
  p.integration.implicit.newton_tolerance = 1e-6;
  Simulation<Host> s(p);
  advance(s, 15);
  const auto held = s.reactions();
  const double exact = mu * polar_moment(p.body.levels[0]) * angle / length;
  EXPECT_NEAR(held[0].torque[2], -held[1].torque[2], 1e-3 * exact);
  EXPECT_LT(held[1].force[2], 0);  // it would grow longer: Poynting's effect
  return held[1].torque[2] / exact;
}

// The torque is mu J times the angle per length (Rivlin, Phil. Trans. R. Soc. A 241, 1948).
TEST(Rotate, TakesRivlinsTorque) {
  const double coarse = std::abs(torque_over_exact(4) - 1),
               fine = std::abs(torque_over_exact(8) - 1);
  EXPECT_LT(fine, 0.08);
  EXPECT_LT(fine, 0.5 * coarse);
}

// --- Reading between steps -----------------------------------------------------------------------

struct Variant {
  const char *cycle, *integrator, *element;
  bool viscous;
};

Problem shaken(const Variant& v) {
  const std::string cycle = v.cycle;
  Problem p = cube_levels(cycle == "single" ? 1 : 2, 4, cycle);
  p.body.element = {v.element};
  p.body.material.model = "neo_hookean";
  if (v.viscous) p.body.material.prony = {{0.3, 0.1}};
  if (std::string(v.element) == "nodal") p.body.material.poisson_ratio = 0.49;
  p.body.prescribed = {{left_face(), SineMotion{{0, 2e-3, 0}, 20, 0}}};
  if (cycle != "him") {
    p.body.fixed = {FixedVertices(HalfSpaceSelection{{0.1, 0, 0}, {-1, 0, 0}})};
    p.body.fixed[0].along = {"x"};
  }
  p.gravity = {0, 0, -9.81};
  if (cycle != "him") p.integration.integrator = {v.integrator};
  p.integration.macro_step = 1e-3;
  return p;
}

const Variant variants[] = {{"single", "symplectic_euler", "linear", false},
                            {"single", "central_difference", "linear", true},
                            {"single", "rk4", "nodal", false},
                            {"single", "newmark", "linear", false},
                            {"single", "implicit_euler", "nodal", true},
                            {"rsv", "symplectic_euler", "linear", false},
                            {"him", "", "linear", false}};

TEST(Reactions, MayBeReadBetweenSteps) {
  for (const Variant& v : variants) {
    SCOPED_TRACE(std::string(v.cycle) + ", " + v.integrator + ", " + v.element);
    const Problem p = shaken(v);
    Simulation<Host> a(p), b(p);
    for (int n = 0; n < 10; ++n) {
      advance(a, 1), advance(b, 1);
      const auto first = b.reactions(), again = b.reactions();
      ASSERT_EQ(first.size(), p.body.fixed.size() + 1);
      EXPECT_EQ(first.back().force, again.back().force);
      EXPECT_GT(first.back().force.norm(), 0);
    }
    EXPECT_TRUE(same_bits(a.positions(), b.positions()));
    EXPECT_TRUE(same_bits(a.velocities(), b.velocities()));
    EXPECT_EQ(a.counters(), b.counters());
  }
}

TEST(Reactions, GoOnWithASavedRun) {
  for (const Variant& v : variants) {
    SCOPED_TRACE(std::string(v.cycle) + ", " + v.integrator + ", " + v.element);
    const Problem p = shaken(v);
    Simulation<Host> a(p), b(p);
    advance(a, 5);
    b.restore(a.save());
    advance(a, 5), advance(b, 5);
    EXPECT_TRUE(same_bits(a.positions(), b.positions()));
    const auto one = a.reactions(), other = b.reactions();
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].force, other[i].force) << one[i].set;
      EXPECT_EQ(one[i].torque, other[i].torque) << one[i].set;
    }
  }
}

}  // namespace
