// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/mesh_quality.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// How a body starts, what is read from it and what is set.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class BodyState : public testing::Test {};
TYPED_TEST_SUITE(BodyState, EachBackend);

TYPED_TEST(BodyState, StartsWhereAndAsFastAsItIsTold) {
  using Real = typename TypeParam::Real;
  Problem p = cube_levels(2, 4, "rs");
  p.body.initial.position = Point(1, 2, 3);
  p.body.initial.velocity = {0.1, 0.2, 0.3};
  p.body.initial.angular_velocity = {0, 0, 2};
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.04, 1);
  Simulation<TypeParam> simulation(p);
  for (int level : {0, 1}) {
    const auto& mesh = p.body.levels[static_cast<std::size_t>(level)];
    const auto x = simulation.positions(level), v = simulation.velocities(level);
    for (std::size_t a = 0; a < x.size(); ++a) {
      const Point arm = mesh.vertices[a] - Point(0.05, 0.05, 0.05);
      EXPECT_LE((x[a] - arm - Point(1, 2, 3)).norm(), round_off<Real>(8, 4));
      EXPECT_LE((v[a] - Point(0.1, 0.2, 0.3) - Point(0, 0, 2).cross(arm)).norm(),
                round_off<Real>(20));
    }
  }
  const auto surface = simulation.surface_positions(), speed = simulation.surface_velocities();
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const Point arm = p.body.surface->vertices[i] - Point(0.05, 0.05, 0.05);
    EXPECT_LE((surface[i] - arm - Point(1, 2, 3)).norm(), round_off<Real>(8, 4));
    EXPECT_LE((speed[i] - Point(0.1, 0.2, 0.3) - Point(0, 0, 2).cross(arm)).norm(),
              round_off<Real>(20));
  }
}

// Two macro steps that are cut in two, then whole ones again: the times are those of the others
TYPED_TEST(BodyState, EndsAtTheTimeThatIsAsked) {
  for (const char* cycle : {"single", "rsv", "him"}) {
    SCOPED_TRACE(cycle);
    Problem p = cube_levels(cycle == std::string("single") ? 1 : 2, 3, cycle);
    p.body.initial.velocity = {0.5, 0, 0};
    Simulation<TypeParam> simulation(p);
    const double t = simulation.macro_step();
    simulation.end_at(2.25 * t);
    advance(simulation, 3);
    EXPECT_EQ(simulation.time(), 2.25 * t);
    EXPECT_EQ(simulation.macro_steps(), 2);
    const Point moved = simulation.positions()[0] - p.body.levels[0].vertices[0];
    EXPECT_LE((moved - Point(0.5 * 2.25 * t, 0, 0)).norm(), 1e-2 * t);
    advance(simulation, 2);
    EXPECT_EQ(simulation.time(), 4 * t);
    EXPECT_EQ(simulation.macro_steps(), 4);
    simulation.end_at(5 * t);
    advance(simulation, 1);
    EXPECT_EQ(simulation.time(), 5 * t);
    EXPECT_EQ(simulation.macro_steps(), 5) << "a whole one that ends there";
  }
}

TYPED_TEST(BodyState, HasASurfaceOfItsOwn) {
  Problem p = small_cube();
  p.body.surface = sphere_surface({50, 50, 50}, 40, 1);  // as if in millimetres
  EXPECT_THROW(Simulation<TypeParam>{p}, InputError);
}

TYPED_TEST(BodyState, SetIsReadBackAndReachesTheCoarseLevels) {
  using Real = typename TypeParam::Real;
  for (const char* cycle : {"single", "rs", "rv", "rsv", "rsv_sv"}) {
    Problem p = cube_levels(2, 4, cycle);
    Simulation<TypeParam> simulation(p);
    Eigen::Matrix3d A;
    A << 0.1, 0.02, 0, -0.02, 0.05, 0.01, 0, 0, -0.1;
    std::vector<Point> u, v;
    for (const Point& x : p.body.levels[0].vertices)
      u.push_back(A * x), v.push_back(Point(1, 2, 3) + A * x);
    simulation.set_state(u, v);
    EXPECT_LE(largest_difference(displacements(simulation, p.body.levels[0]), u),
              round_off<Real>(4, 0.2));
    EXPECT_LE(largest_difference(simulation.velocities(), v), round_off<Real>(4, 4));
    if (std::string(cycle) == "single") continue;
    const auto coarse = displacements(simulation, p.body.levels[1], 1);
    for (std::size_t a = 0; a < coarse.size(); ++a)
      EXPECT_LE((coarse[a] - A * p.body.levels[1].vertices[a]).norm(), round_off<Real>(8, 0.2))
          << cycle;
  }
}

TYPED_TEST(BodyState, SetOfAWrongLengthIsRefused) {
  Simulation<TypeParam> simulation(small_cube());
  const std::vector<Point> few(3, Point::Zero()), before = simulation.positions();
  EXPECT_THROW(simulation.set_state(few, few), InputError);
  std::vector<Point> moved(before.size(), Point(0.1, 0, 0));
  EXPECT_THROW(simulation.set_state(moved, few), InputError);
  EXPECT_TRUE(same_bits(simulation.positions(), before)) << "nothing has changed";
  moved[2][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(
      refusal([&] { simulation.set_state(before, moved); }).find("velocities 2 is not finite"),
      std::string::npos);
}

TYPED_TEST(BodyState, ReportsWhatWasDecided) {
  Problem p = cube_levels(2, 4, "rsv");
  p.integration.integrator = {"symplectic_euler", "implicit_euler"};
  p.integration.distribution = "custom", p.integration.shares = {0.25, 0.75};
  p.integration.substeps = {0, 2};
  p.integration.macro_step = 0.02, p.integration.implicit.newton_iterations = 1;
  Simulation<TypeParam> simulation(p);
  const auto& r = simulation.levels();
  ASSERT_EQ(r.size(), 2u);
  EXPECT_EQ(r[0].vertices, 125);
  EXPECT_EQ(r[1].tets, 6 * 27);
  EXPECT_NEAR(r[0].mean_edge, mean_edge_length(p.body.levels[0]), 1e-12);
  EXPECT_NEAR(r[1].mass, 1, 1e-12);
  EXPECT_EQ(r[1].integrator, "implicit_euler");
  EXPECT_FALSE(r[1].explicit_integrator);
  EXPECT_EQ(r[1].substeps, 2);
  EXPECT_EQ(r[0].substeps, static_cast<int>(std::ceil(0.005 / (0.9 * r[0].critical_step))));
  EXPECT_EQ(simulation.macro_step(), 0.02);
  simulation.step();
  const auto counters = simulation.counters();
  EXPECT_EQ(counters.at("force_evaluations"), r[0].substeps + 2);
  EXPECT_EQ(counters.at("linear_solves"), 2);
  EXPECT_TRUE(simulation.stages().empty());
  simulation.time_stages(true);
  simulation.step();
  EXPECT_GT(simulation.stages().size(), 3u);
}

TEST(Implicit, ReachesItsResidualOrCountsAMiss) {
  Problem p = small_cube("corotational");
  p.body.initial.angular_velocity = {0, 0, 10};
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 0.02;
  p.integration.implicit.solver = "conjugate_gradients",
  p.integration.implicit.newton_iterations = 1;
  for (double tolerance : {1e-3, 1e-9}) {
    p.integration.implicit.relative_residual = tolerance;
    Simulation<Host> simulation(p);
    advance(simulation, 5);
    EXPECT_EQ(simulation.counters().at("cg_misses"), 0);
    EXPECT_LE(simulation.worst_residual(), tolerance);
    EXPECT_GT(simulation.worst_residual(), 0);
  }
  p.integration.implicit.max_iterations = 2;
  Simulation<Host> short_of(p);
  short_of.step();
  EXPECT_EQ(short_of.counters().at("cg_misses"), 1);
  EXPECT_GT(short_of.worst_residual(), 1e-9);
  p.integration.implicit.iterations = 3;
  Simulation<Host> exactly(p);
  exactly.step();
  EXPECT_EQ(exactly.counters().at("cg_iterations"), 3);
  EXPECT_EQ(exactly.counters().at("cg_misses"), 0);
}

// Newton's method to convergence solves the step's own equation M (v - v0) = h (f(u0 + h v) - c M
// v); a linear material takes one iteration.
void expect_step_solved(const std::string& material, int newton_iterations) {
  SCOPED_TRACE(material);
  Problem p = small_cube(material);
  p.gravity = {0, 0, -9.81};
  p.body.fixed = {left_face()};
  p.body.damping.mass = 3;
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 0.01;
  p.integration.implicit = {.relative_residual = 1e-11,
                            .newton_iterations = newton_iterations,
                            .newton_tolerance = 1e-12};
  Simulation<Host> simulation(p);
  advance(simulation, 5);
  const auto v0 = simulation.velocities();
  advance(simulation, 1);
  const auto v = simulation.velocities();
  LevelProbe<Host> probe(p);
  const auto f = probe.force(displacements(simulation, p.body.levels[0]));
  const auto m = probe.mass(), inverse = probe.inverse_mass();
  for (std::size_t a = 0; a < v.size(); ++a)
    if (inverse[a] > 0) {
      EXPECT_LE((m[a] * (v[a] - v0[a]) - 0.01 * (f[a] - 3 * m[a] * v[a])).norm(),
                1e-8 * 0.01 * 9.81)
          << a;
    }
}

TEST(Implicit, NewtonSolvesTheStep) { expect_step_solved("neo_hookean", 20); }
TEST(Implicit, OneIterationSolvesALinearStep) { expect_step_solved("linear", 1); }

// Velocity fields at the start: a twist and parts, wherever the body is placed; and levels that are
// not of one body.

std::vector<Point> start_velocity(const Problem& p) { return Simulation<Host>(p).velocities(); }

TEST(InitialVelocity, TwistGrowsAlongItsAxis) {
  Problem p = cube_levels(2, 4, "rs");
  p.body.initial.position = Point(3, 2, 1);
  p.body.initial.twist = TwistOptions{{0.01, 0.05, 0.05}, {0.06, 0.05, 0.05}, 30};
  const auto v = start_velocity(p);
  const auto& x = p.body.levels[0].vertices;
  for (std::size_t a = 0; a < v.size(); ++a) {
    const double omega = 30 * (x[a][0] - 0.01) / 0.05;  // beyond both points too
    const Point want(0, -omega * (x[a][2] - 0.05), omega * (x[a][1] - 0.05));
    EXPECT_LE((v[a] - want).norm(), round_off<double>(20, 3));
  }
}

TEST(InitialVelocity, AllPartsAddUpAndWhatIsFixedStays) {
  Problem p = cube_levels(2, 4, "rs");
  p.body.fixed = {left_face()};
  p.body.initial.velocity = {1, 0, 0};
  p.body.initial.parts.push_back({HalfSpaceSelection{{0.09, 0, 0}, {-1, 0, 0}}, {0, 0, -2}});
  p.body.initial.parts.push_back({Box{{-1, 0, 0}, {1, 0.01, 1}}, {0, 3, 0}});
  p.body.initial.twist = TwistOptions{{0, 0, 0}, {0, 0, 1}, 0};
  const auto v = start_velocity(p);
  const auto& x = p.body.levels[0].vertices;
  for (std::size_t a = 0; a < v.size(); ++a) {
    const Point want(1, x[a][1] <= 0.01 ? 3 : 0, x[a][0] >= 0.09 ? -2 : 0);
    EXPECT_EQ(v[a], x[a][0] == 0 ? Point(0, 0, 0) : want);
  }
}

TEST(InitialVelocity, APartHasAVertexOfTheFinestLevel) {
  Problem p = cube_levels(2, 4, "rs");
  // none of level 1 is there
  p.body.initial.parts.push_back({BallSelection{{0.025, 0.1, 0.1}, 0.003}, {0, 0, 1}});
  EXPECT_NO_THROW(start_velocity(p));
  p.body.initial.parts.push_back({BallSelection{{0.03, 0.1, 0.1}, 0.003}, {0, 0, 1}});
  const std::string text = refusal([&] { start_velocity(p); });
  EXPECT_NE(text.find("body.initial.parts.1"), std::string::npos) << text;
}

TEST(LevelsOfOneBody, MustOverlap) {
  Problem p = body_of(
      {box_mesh(decimetre, {4, 4, 4}), box_mesh({{0.4, 0, 0}, {0.5, 0.1, 0.1}}, {2, 2, 2})});
  EXPECT_NO_THROW(Simulation<Host>{p});  // `single` does not look at the second
  p.integration.cycle = "rs";
  EXPECT_EQ(refusal([&] { Simulation<Host>{p}; }),
            "body.levels: levels 0 and 1 do not overlap, they are 0.3 m apart; expected meshes of "
            "one body");
  p.body.levels[1] = box_mesh({{0.02, 0, 0}, {0.12, 0.1, 0.1}}, {2, 2, 2});  // mostly
  EXPECT_NO_THROW(Simulation<Host>{p});
}

// A wrong scale or place of a coarse level is an error with the numbers; what round bodies differ
// by is at most a warning.
TEST(LevelsOfOneBody, HaveOneSizeAndPlace) {
  Problem p = body_of({box_mesh(decimetre, {4, 4, 4}), box_mesh(decimetre, {2, 2, 2})});
  p.integration.cycle = "rs";
  EXPECT_NO_THROW(Simulation<Host>{p});
  EXPECT_TRUE(other_doubts(p).empty());
  const auto refused = [&](const TetMesh& coarse) {
    p.body.levels[1] = coarse;
    return refusal([&] { Simulation<Host>{p}; });
  };
  EXPECT_EQ(refused(box_mesh({{0, 0, 0}, {100, 100, 100}}, {2, 2, 2})),
            "body.levels: level 1 is not the body of level 0: 100 x 100 x 100 m, 1e+06 m^3, 1e+09 "
            "kg, centroid [50, 50, "
            "50] instead of 0.1 x 0.1 x 0.1 m, 0.001 m^3, 1 kg, centroid [0.05, 0.05, 0.05]; is "
            "the file of level 1 in "
            "mm? Then its scale is 0.001");
  EXPECT_NE(refused(box_mesh({{0, 0, 0}, {1e-3, 1e-3, 1e-3}}, {2, 2, 2}))
                .find("the file of level 0 in cm?"),
            std::string::npos);
  EXPECT_NE(refused(box_mesh({{0.05, 0, 0}, {0.15, 0.1, 0.1}}, {2, 2, 2}))
                .find("must lie at the same place"),
            std::string::npos);
  EXPECT_NE(refused(box_mesh({{0, 0, 0}, {0.1, 0.1, 0.04}}, {2, 2, 2})).find("0.1 x 0.1 x 0.04 m"),
            std::string::npos);
  p.integration.cycle = "single";  // looks at the second only for what level 0 may lack
  EXPECT_EQ(refused(box_mesh({{0, 0, 0}, {1e-3, 1e-3, 1e-3}}, {2, 2, 2})), "");
  EXPECT_TRUE(other_doubts(p).empty());
  EXPECT_NE(refused(box_mesh({{0, 0, 0}, {100, 100, 100}}, {2, 2, 2}))
                .find("is the file of level 1 in mm?"),
            std::string::npos);
  p.integration.cycle = "rs";
  EXPECT_EQ(refused(box_mesh({{0, 0, 0}, {0.1, 0.1, 0.08}}, {2, 2, 2})), "");
  ASSERT_EQ(other_doubts(p).size(), 1);
  EXPECT_EQ(other_doubts(p)[0],
            "body.levels: level 1 differs from level 0: 0.1 x 0.1 x 0.08 m, 0.0008 m^3, 0.8 kg, "
            "centroid [0.05, 0.05, "
            "0.04] instead of 0.1 x 0.1 x 0.1 m, 0.001 m^3, 1 kg, centroid [0.05, 0.05, 0.05]");
}

// A finest level of 30 of a beam's 40 cm is the beam to no cycle: it would move 3 kg of 4.
TEST(LevelsOfOneBody, CoverAllOfIt) {
  const TetMesh part = box_mesh({{0, 0, 0}, {0.3, 0.1, 0.1}}, {12, 4, 4}),
                whole = box_mesh(beam_box, {8, 2, 2});
  Problem p = body_of({part, whole});
  const std::string numbers =
      "0.3 x 0.1 x 0.1 m, 0.003 m^3, 3 kg, centroid [0.15, 0.05, 0.05] of 0.4 x 0.1 x 0.1 m, 0.004 "
      "m^3, 4 kg, centroid [0.2, 0.05, 0.05]; expected levels of the whole body, or the key covers "
      "of the level that does not";
  for (const char* cycle : {"single", "him", "rsv", "fas"}) {
    p.integration.cycle = cycle;
    EXPECT_EQ(refusal([&] { Simulation<Host>{p}; }),
              "body.levels: level 0 covers a part of level 1: " + numbers)
        << cycle;
  }
  p.body.levels = {box_mesh(beam_box, {12, 4, 4}),
                   box_mesh({{0, 0, 0}, {0.3, 0.1, 0.1}}, {6, 2, 2})};
  EXPECT_EQ(refusal([&] { Simulation<Host>{p}; }),
            "body.levels: level 1 covers a part of level 0: " + numbers);
}

// The same body, but denser on its coarse level: a region that has lost its name there.
TEST(LevelsOfOneBody, HaveOneMass) {
  Problem p = body_of({box_mesh(decimetre, {4, 4, 4}), box_mesh(decimetre, {2, 2, 2})});
  p.integration.cycle = "rs";
  p.body.levels[1].region.assign(p.body.levels[1].tets.size(), 0);
  p.body.levels[1].region_names = {"bone"};
  p.body.regions["bone"].density = 2 * p.body.material.density;
  ASSERT_EQ(other_doubts(p).size(), 1);
  EXPECT_NE(other_doubts(p)[0].find("0.001 m^3, 2 kg"), std::string::npos) << other_doubts(p)[0];
  p.body.regions["bone"].density = 10 * p.body.material.density;
  EXPECT_THROW(Simulation<Host>{p}, InputError);
}

// Positions and velocities through arrays of the caller's, on the device.

template <class B>
class DeviceArrays : public testing::Test {};
TYPED_TEST_SUITE(DeviceArrays, EachBackend);

template <class View>
std::vector<Point> host_copy(const View& view) {
  Kokkos::fence();
  const Kokkos::View<typename View::value_type**, Kokkos::LayoutRight, typename View::memory_space>
      packed("packed", view.extent(0), 3);
  Kokkos::deep_copy(packed, Kokkos::subview(view, Kokkos::ALL, Kokkos::pair<int, int>(0, 3)));
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), packed);
  std::vector<Point> points;
  for (std::size_t a = 0; a < host.extent(0); ++a)
    points.emplace_back(static_cast<double>(host(a, 0)), static_cast<double>(host(a, 1)),
                        static_cast<double>(host(a, 2)));
  return points;
}

template <class B>
Problem thrown_cube() {
  Problem p = cube_levels(2, 4, "rsv");
  p.body.initial.position = Point(1, -2, 0.5);
  p.body.initial.angular_velocity = {0, 30, 0};
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.04, 1);
  return p;
}

TYPED_TEST(DeviceArrays, OfEveryLayoutAndPrecisionAreFilled) {
  using Memory = typename TypeParam::Memory;
  Simulation<TypeParam> simulation(thrown_cube<TypeParam>());
  advance(simulation, 3);
  for (int level : {0, 1}) {
    const auto n = simulation.positions(level).size();
    const Kokkos::View<float* [3], Kokkos::LayoutRight, Memory> right("right", n);
    const Kokkos::View<double* [3], Kokkos::LayoutLeft, Memory> left("left", n);
    // part of a structure of 8 numbers
    const Kokkos::View<double**, Kokkos::LayoutRight, Memory> wide("wide", n, 8);
    const auto columns = Kokkos::subview(wide, Kokkos::ALL, Kokkos::pair<int, int>(2, 5));
    simulation.read_positions(right, level);
    simulation.read_velocities(left, level);
    simulation.read_positions(columns, level);
    EXPECT_LE(largest_difference(host_copy(right), simulation.positions(level)),
              round_off<float>(4, 3));
    EXPECT_EQ(host_copy(left), simulation.velocities(level));
    EXPECT_LE(largest_difference(host_copy(columns), simulation.positions(level)),
              round_off<typename TypeParam::Real>(4, 3));
  }
}

TYPED_TEST(DeviceArrays, HoldTheSurface) {
  Simulation<TypeParam> simulation(thrown_cube<TypeParam>());
  advance(simulation, 3);
  const auto n = simulation.surface_positions().size();
  const Kokkos::View<float*[3], Kokkos::LayoutRight, typename TypeParam::Memory> x("x", n),
      v("v", n);
  simulation.read_surface_positions(x);
  simulation.read_surface_velocities(v);
  EXPECT_LE(largest_difference(host_copy(x), simulation.surface_positions()),
            round_off<float>(4, 3));
  EXPECT_LE(largest_difference(host_copy(v), simulation.surface_velocities()),
            round_off<float>(4, 3));
}

// what is written continues as if it had been set from the host
TYPED_TEST(DeviceArrays, ReplaceTheState) {
  for (const char* cycle : {"single", "rs", "rv", "rsv", "rsv_sv"}) {
    Problem p = thrown_cube<TypeParam>();
    p.integration.cycle = cycle;
    Simulation<TypeParam> from_host(p), from_device(p), source(p);
    advance(source, 5);
    const auto n = source.positions().size();
    const Vectors<TypeParam> u = source.displacement(), v("v", n);
    Kokkos::View<double* [3], Kokkos::LayoutLeft, typename TypeParam::Memory> x("x", n);
    source.read_positions(x);
    source.read_velocities(v);
    auto moved = host_copy(u);
    from_host.set_state(moved, source.velocities());
    from_device.write_state(
        Kokkos::View<const double* [3], Kokkos::LayoutLeft, typename TypeParam::Memory>(x), v);
    advance(from_host, 4);
    advance(from_device, 4);
    const double scale = 2e-3;  // of the differences that round-off of positions a metre away makes
    for (int level = 0; level < static_cast<int>(from_host.levels().size()); ++level)
      EXPECT_LE(largest_difference(from_device.positions(level), from_host.positions(level)),
                round_off<typename TypeParam::Real>(1e3 * scale, 3))
          << cycle;
  }
}

TYPED_TEST(DeviceArrays, OfAnotherSizeAreRefused) {
  Simulation<TypeParam> simulation(thrown_cube<TypeParam>());
  const Vectors<TypeParam> few("few", 7);
  EXPECT_THROW(simulation.read_positions(few), InputError);
  EXPECT_THROW(simulation.read_velocities(few, 1), InputError);
  EXPECT_THROW(simulation.read_surface_positions(few), InputError);
  EXPECT_THROW(simulation.write_state(few, few), InputError);
  const auto before = simulation.positions();
  EXPECT_THROW(simulation.write_state(Vectors<TypeParam>("x", before.size()), few), InputError);
  EXPECT_EQ(simulation.positions(), before);
  EXPECT_THROW(simulation.read_positions(simulation.velocity(1), 2), InputError);
  const Kokkos::View<float**, typename TypeParam::Memory> flat("flat",
                                                               simulation.positions().size(), 2);
  EXPECT_THROW(simulation.read_positions(flat), InputError);
}

}  // namespace
