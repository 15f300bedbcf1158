// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/generators.hpp>
#include <thread>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"
#include "support/watch.hpp"

// What a scene does not need is not there: no array, no kernel.
namespace {

using namespace plica;
using namespace plica::test;

using Counts = std::map<std::string, int>;

template <class B>
class LeftOut : public testing::Test {};
TYPED_TEST_SUITE(LeftOut, EachBackend);

Problem everything() {
  Problem p = cube_levels(3, 4, "rsv");
  p.body.material.model = "neo_hookean";
  p.body.material.prony = {{0.3, 0.1}};
  p.gravity = {0, 0, -9.81};
  p.body.damping = {1, 1e-6};
  p.body.prescribed = {{left_face(), Point(0, 0, 0.1)}};
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.045, 1);
  p.body.loads = {{Box{{0.1, 0, 0}, {0.1, 0.1, 0.1}}, Traction{{1, 0, 0}}, {}}};
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, -0.01}, {0, 0, 1}}, 0.3, {}});
  p.contact.obstacles.push_back(
      {SurfaceOptions{sphere_surface({0.05, 0.05, 0.3}, 0.05, 1), 8}, {}, {}});
  p.integration.integrator = {"symplectic_euler", "symplectic_euler", "implicit_euler"};
  p.integration.implicit.solver = "conjugate_gradients";
  return p;
}

const std::vector<std::string> optional_parts = {
    "contact", "surface",  "prescribe", "restrict",  "interpol", "start", "previous",
    "drift",   "implicit", "cg",        "stage",     "damped",   "flags", "invert",
    "rk4",     "load",     "grid",      "viscosity", "remember", "lost"};

TYPED_TEST(LeftOut, MinimalSceneHasNothingOptional) {
  Problem p = small_cube();
  const Watch watch;
  Simulation<TypeParam> simulation(p);
  simulation.step();
  // set-up's eigenvalue iteration says lanczos_start; nothing else may match
  for (const std::string& label : watch.about(optional_parts))
    EXPECT_EQ(label, "plica::lanczos_start") << "allocated or launched without need";
  EXPECT_EQ(watch.regions.count("plica: building the levels"), 1);
  EXPECT_EQ(watch.regions.count("plica: preparing contact"), 0);
}

TYPED_TEST(LeftOut, FullSceneHasItAll) {  // that the words above are those of the labels
  const Watch watch;
  Simulation<TypeParam> simulation(everything());
  simulation.step();
  for (const std::string& part : optional_parts)
    if (part != "rk4") {
      EXPECT_FALSE(watch.about({part}).empty()) << part;
    }
  EXPECT_EQ(watch.regions.count("plica: preparing contact"), 1);
}

TYPED_TEST(LeftOut, StepOfTheMinimalSceneIsThreeKernels) {
  Problem p = small_cube();
  p.integration.macro_step = 1e-4;
  p.integration.substeps = {4};
  Simulation<TypeParam> simulation(p);
  const Watch watch;
  simulation.step();
  simulation.step();
  const Counts want = {
      {"plica::elastic_force", 8}, {"plica::gather_forces", 8}, {"plica::symplectic_euler", 8}};
  EXPECT_EQ(watch.launches, want);
  EXPECT_EQ(watch.allocations, Counts{});
}

TYPED_TEST(LeftOut, NoStepAllocates) {
  for (const char* cycle : {"rs", "rv", "rsv", "rsv_sv"}) {
    Problem p = everything();
    p.integration.cycle = cycle;
    Simulation<TypeParam> simulation(p);
    simulation.step();  // Kokkos' own scratch grows where it must
    const Watch watch;
    for (int n = 0; n < 3; ++n) simulation.step();
    EXPECT_EQ(watch.allocations, Counts{}) << cycle;
  }
  for (const std::string& integrator : names(integrators())) {
    Problem p = small_cube();
    p.integration.integrator = {integrator};
    p.integration.macro_step = 1e-4;
    p.integration.allow_unstable = true;
    Simulation<TypeParam> simulation(p);
    simulation.step();
    const Watch watch;
    simulation.step();
    EXPECT_EQ(watch.allocations, Counts{}) << integrator;
  }
}

template <class B>
std::map<std::string, Part> parts_of(const Problem& p) {
  std::map<std::string, Part> parts;
  for (const Part& part : Simulation<B>(p).parts()) parts[part.name] = part;
  return parts;
}

TYPED_TEST(LeftOut, PartsSayIt) {
  const auto least = parts_of<TypeParam>(small_cube()), most = parts_of<TypeParam>(everything());
  for (const auto& [name, part] : least) {
    const bool always = name == "elastic elements" || name == "state, mass and force";
    EXPECT_EQ(part.in, always) << name;
    EXPECT_EQ(part.bytes > 0, always) << name;
    EXPECT_FALSE(part.reason.empty()) << name;
  }
  for (const auto& [name, part] : most)
    // the latter four: see below, test_viscosity.cpp, test_grasp.cpp and test_attachments.cpp
    if (name != "fixed vertices" && name != "hierarchical inverse mass" && name != "viscosity" &&
        name != "held points" && name != "attachments") {
      EXPECT_TRUE(part.in) << name;
      const bool no_memory = name == "gravity" || name == "mass damping" || name == "friction";
      EXPECT_EQ(part.bytes > 0, !no_memory) << name;
    }
}

// Cycle him has its inverse mass, and neither transfers of states nor an implicit solver.
TYPED_TEST(LeftOut, HimSaysWhatItHas) {
  const auto parts = parts_of<TypeParam>(cube_levels(2, 4, "him"));
  EXPECT_TRUE(parts.at("hierarchical inverse mass").in);
  EXPECT_GT(parts.at("hierarchical inverse mass").bytes, 0u);
  for (const char* name : {"transfers", "implicit solver"}) EXPECT_FALSE(parts.at(name).in) << name;
  EXPECT_FALSE(parts_of<TypeParam>(small_cube()).at("hierarchical inverse mass").in);
}

// A step enqueues its work and leaves the waiting to whoever wants the result.

template <class B>
class Asynchronous : public testing::Test {};
TYPED_TEST_SUITE(Asynchronous, EachBackend);

Problem busy(const std::string& cycle, const std::string& integrator) {
  Problem p = cube_levels(3, 5, cycle);
  p.body.material.model = "neo_hookean";
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.045, 2);
  p.body.fixed = {left_face()};
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, 0.006}, {0, 0, 1}}, 0.3, {}});
  p.integration.integrator = {integrator};
  return p;
}

TYPED_TEST(Asynchronous, NothingInAnExplicitStepWaits) {
  for (const Choice& cycle : cycles())
    for (const char* integrator : {"symplectic_euler", "rk4"}) {
      if (cycle.name == "him" && integrator != std::string("symplectic_euler")) continue;
      Simulation<TypeParam> simulation(busy(cycle.name, integrator));
      int asked = 0;
      simulation.set_external_forces([&](const ForceRequest<TypeParam>&) { ++asked; });
      const auto n = simulation.positions().size();
      const Kokkos::View<float*[3], typename TypeParam::Memory> x("x", n), v("v", n);
      simulation.read_positions(x);
      simulation.read_velocities(v);
      const Watch watch;
      for (int step = 0; step < 5; ++step) {
        simulation.step();
        simulation.read_positions(x);
        simulation.read_velocities(v);
        // him solves for momenta
        if (step == 2 && cycle.name != "him") simulation.write_state(x, v);
      }
      EXPECT_TRUE(watch.fences.empty())
          << watch.fences.begin()->first << " in " << cycle.name << ", " << integrator;
      EXPECT_TRUE(watch.allocations.empty()) << watch.allocations.begin()->first;
      EXPECT_GT(watch.launches.at("plica::read_positions"), 0);
      EXPECT_GT(asked, 0);
    }
}

// the watch sees what there is to be seen
TYPED_TEST(Asynchronous, LookingWaits) {
  Simulation<TypeParam> simulation(busy("rsv", "symplectic_euler"));
  const Watch watch;
  simulation.check();
  EXPECT_FALSE(watch.fences.empty());
}

/// Bodies stepped at the same time, each on an instance and a thread of its own.
TYPED_TEST(Asynchronous, BodiesOnTheirOwnInstancesAreWhatTheyAreAlone) {
  using Exec = typename TypeParam::Exec;
  constexpr int bodies = 2, steps = 40;
  if (Exec().concurrency() < bodies) GTEST_SKIP() << "one thread";
  const auto problem = [](int body) {
    Problem p = busy(body == 0 ? "rsv" : "rs", body == 0 ? "symplectic_euler" : "implicit_euler");
    p.body.initial.velocity = {0, 0.1 * body, 0};
    p.integration.distribution = "equal";
    p.integration.macro_step = 2e-3;
    return p;
  };
  const std::vector<Exec> instances =
      Kokkos::Experimental::partition_space(Exec(), std::vector<int>{1, 1});
  std::vector<std::unique_ptr<Simulation<TypeParam>>> together;
  for (int body = 0; body < bodies; ++body)
    together.push_back(std::make_unique<Simulation<TypeParam>>(
        problem(body), instances[static_cast<std::size_t>(body)]));
  std::vector<std::thread> threads;
  for (auto& simulation : together)
    threads.emplace_back([&simulation] {
      for (int n = 0; n < steps; ++n) simulation->step();
    });
  for (std::thread& thread : threads) thread.join();
  for (int body = 0; body < bodies; ++body) {
    Simulation<TypeParam> alone(problem(body));
    advance(alone, steps);
    EXPECT_FALSE(together[static_cast<std::size_t>(body)]->check());
    EXPECT_TRUE(same_bits(together[static_cast<std::size_t>(body)]->positions(), alone.positions()))
        << body;
  }
}

}  // namespace
