// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/linear/stage_system.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/organs.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Contact in the linear systems of implicit levels: obstacles and points, held points, thin tools,
// bodies.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double side = 0.06, slip = 1e-4, h = 0.01;

Body cube(const Point& at, std::array<int, 3> cells) {
  Body body = body_of({box_mesh({at, at + Point(side, side, side)}, cells)}, "neo_hookean").body;
  body.surface = boundary_surface(body.levels[0]).surface;
  return body;
}

Problem implicit(Problem p, const std::string& integrator = "implicit_euler",
                 int newton_iterations = 1) {
  p.integration.integrator = {integrator};
  p.integration.macro_step = h;
  p.integration.implicit.newton_iterations = newton_iterations;
  p.integration.implicit.relative_residual = 1e-10, p.integration.implicit.max_iterations = 2000;
  return p;
}

/// A cube that is a little inside a plane.
Problem on_a_plane() {
  Problem p;
  p.body = cube({0, 0, -slip}, {3, 3, 3});
  p.contact.obstacles = {{PlaneOptions{}, 0.4, {}}};
  return implicit(p);
}

/// A cube whose lower corners are a little inside a bowl.
Problem in_a_bowl() {
  constexpr double radius = 0.2;
  const double height = radius - std::sqrt((radius + slip) * (radius + slip) - side * side / 2);
  Problem p;
  p.body = cube({-side / 2, -side / 2, height}, {3, 3, 3});
  p.contact.obstacles = {{BowlOptions{{0, 0, radius}, radius}, {}, {}}};
  return implicit(p);
}

/// A cube under a plate that holds its top.
Problem held() {
  Problem p;
  p.body = cube({0, 0, 0}, {3, 3, 3});
  ObstacleOptions plate{
      BlockOptions{{side / 2, side / 2, side + 0.0105}, {0.2, 0.2, 0.02}}, {}, {}};
  plate.name = "plate",
  plate.grasp = GraspOptions{.from = {0}, .until = {}, .reach = 1e-3, .stiffness = 300};
  p.contact.obstacles = {plate};
  return implicit(p);
}

/// A cube and needles that are a little inside its top: in the middle of a triangle, and on an
/// edge.
Problem under_needles() {
  Problem p;
  p.body = cube({0, 0, 0}, {3, 3, 3});
  for (const Point& at : {Point(0.02 + 0.02 / 3, 0.02 + 0.02 / 3, side), Point(0.05, 0.05, side)}) {
    const Point low = at + Point(0, 0, 0.001 - slip);
    p.contact.obstacles.push_back({CapsuleOptions{low, low + Point(0, 0, 0.1), 0.001}, {}, {}});
  }
  p.contact.whole_surface = "always";
  return implicit(p);
}

/// A cube a little inside another one of other cells.
Problem stacked(const std::vector<AttachmentOptions>& attachments = {}) {
  Problem p;
  p.body = join_bodies({{"lower", cube({0, 0, 0}, {3, 3, 3})},
                        {"upper", cube({0.013, 0.007, side - slip}, {4, 3, 2})}});
  p.contact.attachments = attachments;
  return implicit(p);
}

/// Two bars of one cell each that stand on an edge across each other, the edges a little inside
/// each other in their middle.
Problem crossing() {
  const auto bar = [](std::size_t along, double height) {
    Body body = cube({-side / 2, -side / 2, -side / 2}, {1, 1, 1});
    for (Point& x : body.levels[0].vertices) {
      const double across = (x[1] - x[2]) / std::numbers::sqrt2,
                   up = (x[1] + x[2]) / std::numbers::sqrt2 + height;
      x = along == 0 ? Point(x[0], across, up) : Point(-across, x[0], up);
    }
    body.surface = boundary_surface(body.levels[0]).surface;
    return body;
  };
  const double up = side / std::numbers::sqrt2 - slip / 2;
  Problem p;
  p.body = join_bodies({{"lower", bar(0, -up)}, {"upper", bar(1, up)}});
  return implicit(p);
}

Problem attached() {
  return stacked({{.body = "upper", .to = "lower", .reach = 2 * slip, .stiffness = 300}});
}

/// A level whose contact at rest is linearised.
struct Linearised {
  LevelProbe<Host> probe;
  ImplicitWeights weights{h * h, h};
  std::vector<Point> u, v;

  Linearised(const Problem& p, const Point& velocity)
      : probe(p), u(probe.zero()), v(probe.vertices(), velocity) {
    if (p.contact.obstacles.size() == 1 && p.contact.obstacles[0].grasp)
      level().response().grasp({}, level(), 0, 0);
    if (level().contact()) begin();
    linearise(u, v);
  }
  /// The step begins so far before the state that its velocities lead there; caps are those of the
  /// state.
  void begin() {
    auto start = u;
    for (std::size_t a = 0; a < u.size(); ++a) start[a] -= h * v[a];
    level().response().begin_stage({}, level(), {device_field<Host>(start), device_field<Host>(v)},
                                   0, {.span = h});
    level().response().update_caps({}, level(), state());
  }
  void linearise(const std::vector<Point>& at, const std::vector<Point>& speed) {
    const State<Host> there{device_field<Host>(at), device_field<Host>(speed)};
    level().linearise(there, 0, weights, 0, level().f);
    if (level().contact()) level().response().linearise({}, level(), there, weights, 0, level().f);
  }
  Level<Host>& level() { return probe.at(0); }
  State<Host> state() const { return {device_field<Host>(u), device_field<Host>(v)}; }

  /// (M + h^2 K + h C) direction by differences of the forces.
  std::vector<Point> difference(const std::vector<Point>& direction, double e) {
    const auto force = [&](double t) {
      auto x = u, speed = v;
      for (std::size_t a = 0; a < x.size(); ++a)
        speed[a] += t * direction[a], x[a] += h * t * direction[a];
      linearise(x, speed);
      return to_host<Host>({}, level().f);
    };
    auto q = minus(force(-e), force(e));
    const auto mass = probe.mass();
    for (std::size_t a = 0; a < q.size(); ++a) q[a] = h / (2 * e) * q[a] + mass[a] * direction[a];
    linearise(u, v);
    return q;
  }
  std::vector<Point> product(const std::vector<Point>& direction) {
    const Vectors<Host> q("test.q", direction.size());
    level().product(state(), device_field<Host>(direction), weights, false, q);
    return to_host<Host>({}, q);
  }
};

struct ContactCase {
  const char* name;
  Problem problem;
  Point sliding = {0.0001, -0.0002, 0};
};
std::vector<ContactCase> cases() {
  return {{"sticks", on_a_plane()},
          {"slips", on_a_plane(), {3, 4, 0}},
          {"hollow", in_a_bowl(), {0, 0, 0}},
          {"held", held()},
          {"needles", under_needles(), {0, 0, 0}},
          {"pairs", stacked()},
          {"edges", crossing()},
          {"attached", attached()}};
}

// Against differences of the forces, at the caps of the state.
TEST(ImplicitContact, IsLinearisedAsItActs) {
  for (const ContactCase& c : cases()) {
    SCOPED_TRACE(c.name);
    Linearised it(c.problem, c.sliding);
    const auto direction = random_field(it.probe.vertices(), 1, 2);
    const auto want = it.difference(direction, 1e-6), got = it.product(direction);
    EXPECT_LE(largest_difference(got, want), 2e-6 * largest(want));
    Problem without = c.problem;
    without.contact = {}, without.contact.bodies = false;
    EXPECT_GE(largest_difference(Linearised(without, c.sliding).product(direction), want), 1e-5);
  }
}

/// Whether the vertex blocks of a system are those of the product.
void expect_blocks(Linearised& it, const StageSystem<Host>& system) {
  for (std::size_t a = 0; a < it.probe.vertices(); a += 3)
    for (int k = 0; k < 3; ++k) {
      auto unit = it.probe.zero();
      unit[a][k] = 1;
      const Point column = it.product(unit)[a];
      SymMat3<double> block;
      ASSERT_TRUE(
          invert_positive(block_at<Host>(system.inverse_diagonal(), static_cast<int>(a)), block));
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(block[SymMat3<double>::place(3 * i + k)], column[i], 1e-12 * column.norm())
            << a;
    }
}

// The vertex blocks are those of the product, and so is the assembled matrix with what it has no
// room for.
TEST(ImplicitContact, HasOneSystem) {
  for (const ContactCase& c : cases()) {
    SCOPED_TRACE(c.name);
    Linearised it(c.problem, {0.001, -0.002, 0});
    StageSystem<Host> by_products(it.level(), false), assembled(it.level(), true);
    const auto direction = random_field(it.probe.vertices(), 1, 2);
    for (auto* system : {&by_products, &assembled})
      system->prepare(it.level(), it.state(), it.weights, false);
    const auto want = it.product(direction);
    expect_blocks(it, by_products), expect_blocks(it, assembled);
    const Vectors<Host> q("test.q", direction.size());
    assembled.product({}, device_field<Host>(direction), q);
    EXPECT_LE(largest_difference(to_host<Host>({}, q), want), 1e-12 * largest(want));
  }
}

// --- Steps ---

struct Method {
  const char* integrator;
  int newton_iterations;
};
constexpr Method methods[] = {{"implicit_euler", 1}, {"implicit_euler", 20},
                              {"newmark", 20},       {"bdf2", 1},
                              {"sdirk2", 20},        {"generalized_alpha", 20}};

Point momentum(const Simulation<Host>& s, const std::vector<double>& mass) {
  Point sum = Point::Zero();
  const auto v = s.velocities();
  for (std::size_t a = 0; a < mass.size(); ++a) sum += mass[a] * v[a];
  return sum;
}

// Two cubes meet: momentum to what the linear solves leave, no energy gained, and they fly apart.
TEST(ImplicitContact, TurnsCollidingBodies) {
  for (const Method& m : methods) {
    SCOPED_TRACE(std::string(m.integrator) + " " + std::to_string(m.newton_iterations));
    Body left = cube({0, 0, 0}, {3, 3, 3}), right = cube({side + 0.001, 0.007, 0.004}, {4, 3, 2});
    left.initial.velocity = {0.3, 0, 0}, right.initial.velocity = {-0.3, 0, 0};
    Problem p;
    p.body = join_bodies({{"left", left}, {"right", right}});
    p = implicit(p, m.integrator, m.newton_iterations);
    p.contact.stiffness_scale = 0.03;  // one that stores enough to see
    p.integration.macro_step = 1e-3;
    Simulation<Host> s(p);
    const auto mass = lumped_masses(p.body.levels[0], region_densities(p.body, p.body.levels[0]));
    const Point before = momentum(s, mass);
    const double energy = s.energies().total(), size = 0.3 * s.levels()[0].mass;
    double contact = 0;
    while (s.time() < 0.1) {
      advance(s, 1);
      const Energies e = s.energies();
      EXPECT_LE(e.total(), 1.02 * energy);
      contact = std::max(contact, e.contact);
    }
    EXPECT_GT(contact, 0.03 * energy);
    EXPECT_LE((momentum(s, mass) - before).norm(), 1e-6 * size);
    Point of_left = Point::Zero();
    for (std::size_t a = 0; a < 64; ++a) of_left += mass[a] * s.velocities()[a];
    EXPECT_LT(of_left[0], -0.1 * size / 2);  // it came with 1
  }
}

// A single tetrahedron, the lightest of bodies, meets the floor in long steps: whatever the
// friction, energy is never more than was put in, and it comes to rest.
TEST(ImplicitContact, TakesNoEnergyFromFriction) {
  for (const double step : {1e-3, 4e-3, 8e-3})
    for (const double friction : {0.0, 0.3, 1.0})
      for (const Point& velocity : {Point(0, 0, -1), Point(0.5, 0.2, -0.3)}) {
        SCOPED_TRACE(std::to_string(step) + " s, friction " + std::to_string(friction));
        TetMesh mesh;
        mesh.vertices = {
            {0.02, 0, 0.001}, {-0.01, 0.017, 0.001}, {-0.01, -0.017, 0.003}, {0, 0, 0.04}};
        mesh.tets = {{0, 1, 2, 3}};
        Problem p = body_of({mesh}, "neo_hookean");
        p.body.material.young_modulus = 1e5;
        p.body.surface = boundary_surface(p.body.levels[0]).surface;
        p.body.initial.velocity = velocity;
        p.gravity = {0, 0, -9.81};
        p.contact.obstacles = {{PlaneOptions{}, friction, {}}};
        p = implicit(p);
        p.integration.macro_step = step;
        Simulation<Host> s(p);
        const double start = s.energies().total(),
                     size = s.energies().kinetic + 9.81 * 0.04 * s.levels()[0].mass;
        while (s.time() < 0.5) {
          advance(s, 1);
          ASSERT_LE(s.energies().total(), start + 1e-3 * size) << s.time();
        }
      }
}

// A block on a slope below the friction angle stays for ever, by every integrator and with long
// steps.
TEST(ImplicitContact, SticksOnASlope) {
  for (const Method& m : methods) {
    if (m.integrator == std::string("newmark") || m.integrator == std::string("generalized_alpha"))
      continue;  // they keep the first jolt's motion for long
    SCOPED_TRACE(m.integrator);
    Problem p = on_a_plane();
    p = implicit(p, m.integrator, m.newton_iterations);
    p.body.material.young_modulus = 5e4;
    p.body.damping.mass = 20;
    p.gravity = 9.81 * Point(std::sin(0.17), 0, -std::cos(0.17));
    p.integration.macro_step = 5e-3;
    Simulation<Host> s(p);
    while (s.time() < 2) advance(s, 1);
    // what they leave unsolved differs
    const bool two_stages = m.integrator == std::string("sdirk2");
    EXPECT_LT(largest(s.velocities()), two_stages ? 1e-6 : 1e-7);
    const double weight = 9.81 * s.levels()[0].mass;
    EXPECT_NEAR(s.wrenches()[0].force[2], std::cos(0.17) * weight, 1e-4 * weight);
    EXPECT_NEAR(s.wrenches()[0].force[0], -std::sin(0.17) * weight, 1e-4 * weight);
  }
}

// A held cube, and one that is attached to another, pull by their weight.
TEST(ImplicitContact, HoldsWhatHangs) {
  for (const Method& m : methods) {
    SCOPED_TRACE(std::string(m.integrator) + " " + std::to_string(m.newton_iterations));
    Problem one = implicit(held(), m.integrator, m.newton_iterations),
            two = implicit(attached(), m.integrator, m.newton_iterations);
    for (auto& [name, region] : two.body.regions) region.damping.mass = 30;
    one.body.damping.mass = 30;
    one.gravity = {0, 0, -9.81}, two.gravity = {0, 0, 9.81};
    two.body.fixed = {HalfSpaceSelection{{0, 0, 1e-6}, {0, 0, 1}}};
    const double weight = 9.81 * 1000 * side * side * side;
    for (const Problem* p : {&one, &two}) {
      Simulation<Host> s(*p);
      while (s.time() < 1) advance(s, 1);
      EXPECT_NEAR(std::abs(s.wrenches().back().force[2]), weight, 0.005 * weight);
    }
  }
}

// Needles between the points of the top come down by half an edge: points alone let them pass.
TEST(ImplicitContact, StopsNeedles) {
  Problem p = under_needles();
  p.body.fixed = {HalfSpaceSelection{{0, 0, 1e-6}, {0, 0, 1}}};
  p.body.damping.mass = 30;
  for (auto& o : p.contact.obstacles) o.motion = PathMotion{{{0, {0, 0, 0}}, {0.1, {0, 0, -0.01}}}};
  const auto force = [&](const std::string& rule, const std::string& integrator,
                         int newton_iterations) {
    Problem of = implicit(p, integrator, newton_iterations);
    of.contact.whole_surface = rule;
    Simulation<Host> s(of);
    while (s.time() < 0.3) advance(s, 1);
    return s.wrenches()[0].force[2];
  };
  const double want = force("auto", "implicit_euler", 1);
  EXPECT_LT(want, -0.3);
  EXPECT_EQ(force("never", "implicit_euler", 1), 0);
  for (const char* integrator : {"newmark", "bdf2", "sdirk2"})
    EXPECT_NEAR(force("auto", integrator, 1), want, 0.03 * -want) << integrator;
  EXPECT_NEAR(force("auto", "symplectic_euler", 1), want, 0.03 * -want);
}

// Factorisations and V-cycles need all of the system in a matrix.
TEST(ImplicitContact, IsRefusedWhereAMatrixHasNoRoom) {
  const auto said = [](Problem p, const std::string& what) {
    const std::string by_factors =
        "integration.implicit.solver is direct, whose matrix has no room for " + what;
    p.integration.implicit.solver = "direct";
    EXPECT_NE(refusal([&] { Simulation<Host>{p}; }).find(by_factors), std::string::npos) << what;
    p.integration.implicit.solver = "auto", p.integration.integrator = {"v_cycle_euler"};
    EXPECT_NE(refusal([&] {
                Simulation<Host>{p};
              }).find("integration.integrator is v_cycle_euler, whose matrix"),
              std::string::npos)
        << what;
    p.integration.integrator = {"implicit_euler"};
    EXPECT_EQ(Simulation<Host>(p).levels()[0].linear_solver.find("direct"), std::string::npos)
        << what;
  };
  said(stacked(), "contact.bodies");
  said(attached(), "contact.bodies");
  said(under_needles(), "contact.whole_surface: always");
  Problem p = under_needles();
  p.contact.whole_surface = "auto", p.integration.implicit.solver = "direct";
  EXPECT_EQ(refusal([&] { Simulation<Host>{p}; }), "");
  p = held(), p.integration.implicit.solver = "direct";
  EXPECT_EQ(refusal([&] { Simulation<Host>{p}; }), "");
}

// Where something touches, motion that these integrators let ring on makes forces of tools
// alternate.
TEST(ImplicitContact, DoubtsWhatRingsOn) {
  Problem p = small_cube();
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.contact.obstacles = {{PlaneOptions{{0, 0, -1}, {0, 0, 1}}, {}, {}}};
  for (const char* integrator : {"generalized_alpha", "newmark"}) {
    p.integration.integrator = {integrator};
    ASSERT_EQ(other_doubts(p).size(), 1);
    EXPECT_EQ(other_doubts(p)[0].find(std::string("integration.integrator is ") + integrator), 0);
  }
  p.integration.integrator = {"bdf2"};
  EXPECT_TRUE(other_doubts(p).empty());
  p.integration.integrator = {"newmark"}, p.contact.obstacles.clear();
  EXPECT_TRUE(other_doubts(p).empty());
}

}  // namespace
