// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Kokkos_Profiling_ProfileSection.hpp>
#include <algorithm>
#include <plica/drivers/run/simulation.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/generators.hpp>
#include <string>
#include <vector>

#include "support/bodies.hpp"
#include "support/device_memory.hpp"

// What a device is asked for in one macro step: kernels, and nothing that makes the host wait.
// Kokkos's callbacks report it on any backend, so that this is known without a GPU.
namespace plica::test {

namespace {

struct Asked {
  std::vector<std::string> launches,
      waits;  // kernels and copies on the device; allocations, and fences, at which the host waits
};
Asked* asked_now = nullptr;

void on_launch(const char* name, std::uint32_t, std::uint64_t*) {
  asked_now->launches.emplace_back(name);
}
void on_fence(const char* name, std::uint32_t, std::uint64_t*) {
  if (std::string(name).rfind("Kokkos::Tools", 0) == 0) return;  // of the callbacks themselves
  asked_now->waits.push_back("fence " + std::string(name));
}
void on_allocation(Kokkos_Profiling_SpaceHandle, const char* name, const void*, std::uint64_t) {
  asked_now->waits.push_back("allocation " + std::string(name));
}
void on_copy(Kokkos_Profiling_SpaceHandle, const char*, const void*, Kokkos_Profiling_SpaceHandle,
             const char*, const void*, std::uint64_t) {
  asked_now->launches.emplace_back("copy");
}

template <class Work>
Asked asked_by(const Work& work) {
  namespace Tools = Kokkos::Tools::Experimental;
  const auto before = Tools::get_callbacks();
  Asked asked;
  asked_now = &asked;
  Tools::set_begin_parallel_for_callback(on_launch);
  Tools::set_begin_parallel_reduce_callback(on_launch);
  Tools::set_begin_parallel_scan_callback(on_launch);
  Tools::set_begin_fence_callback(on_fence);
  Tools::set_allocate_data_callback(on_allocation);
  Tools::set_begin_deep_copy_callback(on_copy);
  work();
  Tools::set_callbacks(before);
  asked_now = nullptr;
  return asked;
}

struct Method {
  std::string cycle, integrator, element;
  int levels;
  enum { falling, touching, hanging, holding } scene;
  std::size_t most;       ///< launches
  std::size_t waits = 0;  ///< a solve ends with a look at how it went
};

std::vector<Method> methods() {
  return {{"single", "symplectic_euler", "linear", 1, Method::falling, 3},
          {"single", "symplectic_euler", "linear", 1, Method::touching, 41},
          {"single", "symplectic_euler", "linear", 1, Method::holding, 41},
          {"single", "symplectic_euler", "nodal", 1, Method::falling, 5},
          {"rsv", "symplectic_euler", "linear", 4, Method::falling, 26},
          {"rsv", "symplectic_euler", "linear", 4, Method::touching, 178},
          {"fas", "symplectic_euler", "linear", 3, Method::falling, 29},
          {"him", "symplectic_euler", "linear", 3, Method::falling, 28},
          {"him", "symplectic_euler", "linear", 3, Method::hanging, 25},
          {"single", "implicit_euler", "linear", 1, Method::falling, 46, 1}};
}

Problem problem_of(const Method& m) {
  Problem p = cube_levels(m.levels, 5, m.cycle);
  p.body.element = {m.element};
  p.gravity = {0, 0, -9.81};
  p.integration.integrator = {m.integrator};
  p.integration.macro_step = 2e-4;
  p.integration.implicit.iterations = 10;
  if (m.scene == Method::hanging) p.body.fixed = {left_face()};
  if (m.scene != Method::touching && m.scene != Method::holding) return p;
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.045, 1);
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, 0.0052}, {0, 0, 1}}, 0.3, {}});
  if (m.scene == Method::holding) p.contact.obstacles[0].grasp = GraspOptions{.from = {0}};
  return p;
}

std::string lines(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& line : list) text += "\n" + line;
  return text;
}

}  // namespace

TEST(Launches, AStepIsFewAndNeverWaits) {
  using B = Backend<double, Kokkos::DefaultExecutionSpace>;
  for (const Method& m : methods()) {
    SCOPED_TRACE(m.cycle + " " + m.integrator + " " + m.element + " " + std::to_string(m.scene));
    Simulation<B> simulation(problem_of(m));
    for (int i = 0; i < 3; ++i) simulation.step();
    Kokkos::fence("before the step");
    const Asked asked = asked_by([&] { simulation.step(); });
    EXPECT_EQ(asked.waits.size(), m.waits) << lines(asked.waits);
    EXPECT_LE(asked.launches.size(), m.most) << lines(asked.launches);
  }
}

TEST(Launches, TakingHoldAndLettingGoNeverWait) {
  using B = Backend<double, Kokkos::DefaultExecutionSpace>;
  Simulation<B> simulation(
      problem_of({"single", "symplectic_euler", "linear", 1, Method::holding, 0}));
  simulation.step();
  Kokkos::fence("before");
  const Asked asked = asked_by(
      [&] { simulation.release(0), simulation.step(), simulation.grasp(0), simulation.step(); });
  EXPECT_TRUE(asked.waits.empty()) << lines(asked.waits);
}

struct FillWithNumbers {
  Kokkos::View<double*, Kokkos::HostSpace> view;
  void operator()(int i) const { view(i) = i; }
};

TEST(DeviceMemory, KnowsWhoTouchesIt) {
  using Exec = Kokkos::DefaultHostExecutionSpace;
  DeviceMemory memory;
  const Kokkos::View<double*, Kokkos::HostSpace> seen("seen", 5), other("other", 5000);
  const auto in_kernels = [&] {
    Kokkos::parallel_for("fill", Kokkos::RangePolicy<Exec>(0, 5), FillWithNumbers{seen});
    Kokkos::deep_copy(Exec(), other, 1.0);
  };
  EXPECT_EQ(memory.touched_by(in_kernels), std::vector<std::string>{});
  double sum = 0;
  EXPECT_EQ(memory.touched_by([&] { sum += other(4000); }), std::vector<std::string>{"other"});
  EXPECT_EQ(memory.touched_by([&] { seen(3) += 1; }), std::vector<std::string>{"seen"});
  EXPECT_EQ(sum + seen(3), 5);  // what touches it goes on
}

// As on a device, where the host has no access to it
TEST(DeviceMemory, NoStepTouchesItFromTheHost) {
  using B = Backend<double, Kokkos::DefaultHostExecutionSpace>;
  for (const Method& m : methods()) {
    SCOPED_TRACE(m.cycle + " " + m.integrator + " " + m.element + " " + std::to_string(m.scene));
    DeviceMemory memory;
    Simulation<B> simulation(problem_of(m));
    for (int i = 0; i < 3; ++i) simulation.step();
    const auto touched = memory.touched_by([&] { simulation.step(); });
    EXPECT_EQ(touched.size(), m.waits) << lines(touched);
  }
}

}  // namespace plica::test
