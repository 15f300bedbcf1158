// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/generators.hpp>
#include <thread>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"
#include "support/watch.hpp"

// A step enqueues its work and leaves the waiting to whoever wants the result.
namespace {

using namespace plica;
using namespace plica::test;

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
        if (step == 2 && cycle.name != "him") simulation.write_state(x, v);  // him solves for momenta
      }
      EXPECT_TRUE(watch.fences.empty()) << watch.fences.begin()->first << " in " << cycle.name << ", " << integrator;
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
  const std::vector<Exec> instances = Kokkos::Experimental::partition_space(Exec(), std::vector<int>{1, 1});
  std::vector<std::unique_ptr<Simulation<TypeParam>>> together;
  for (int body = 0; body < bodies; ++body)
    together.push_back(
        std::make_unique<Simulation<TypeParam>>(problem(body), instances[static_cast<std::size_t>(body)]));
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
    EXPECT_TRUE(same_bits(together[static_cast<std::size_t>(body)]->positions(), alone.positions())) << body;
  }
}

}  // namespace
