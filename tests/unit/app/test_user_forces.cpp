// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <plica/drivers/app/view/user_forces.hpp>

#include "unit/app/scene_text.hpp"

// What the mouse of a live view may do to a body.
namespace plica::app::test {
namespace {

using HandBackend = Backend<double, Kokkos::DefaultHostExecutionSpace>;

constexpr const char* pulled_block = R"(duration: 1 s
gravity: [0, 0, -9.81]
body:
  levels: [{box: {size: [0.1, 0.1, 0.1], cells: [6, 6, 6]}}, {box: {size: [0.1, 0.1, 0.1], cells: [3, 3, 3]}}]
  material: {model: neo_hookean, young_modulus: 20 kPa, poisson_ratio: 0.3, density: 1000}
  fixed: [{half_space: {normal: [0, 0, 1]}}]
)";

/// Least volume ratio of an element of level 0 at any time of a pull.
double least_ratio(const std::string& integration, const std::string& element, const Point& at,
                   const Point& way) {
  const Scene scene = scene_of(pulled_block + integration, {"body.element=" + element});
  Simulation<HandBackend> simulation(scene.problem);
  UserForces<HandBackend> hands(scene, simulation, 0.1 * std::sqrt(3.0));
  simulation.set_external_forces([&](const ForceRequest<HandBackend>& request) { hands(request); });
  Controls controls;
  controls.gravity = 9.81, controls.stiffness = 3000;  // 30 times what the page starts with
  controls.pull = {at, at + way};
  double least = 1, strongest = 0;
  while (simulation.time() < 0.3) {
    hands.hold(controls, simulation.time());
    if (const auto bad = simulation.step_checked()) {
      simulation.return_to_last_good();
      if (hands.give_way()) continue;
      ADD_FAILURE() << integration << bad->text();
      return -1;
    }
    hands.advance();
    strongest = std::max(strongest, hands.pull().norm());
    least = std::min(least, std::ranges::min(simulation.element_fields().J));
  }
  EXPECT_GT(strongest, 1);
  return least;
}

const std::string
    explicit_steps = "integration: {cycle: single, macro_step: 1 ms}\n",
    him_steps = "integration: {cycle: him, macro_step: 4 ms}\n",
    implicit_steps = "integration: {cycle: single, integrator: implicit_euler, macro_step: 2 ms}\n";

// By hands that do not look they come to 0.2
TEST(UserForces, PullLessWhereElementsAreCrushed) {
  for (const std::string& integration : {explicit_steps, him_steps, implicit_steps})
    for (const char* element : {"nodal", "linear"})
      EXPECT_GT(least_ratio(integration, element, {0.05, 0.05, 0.1}, {-0.2, -0.2, -0.2}), 0.3)
          << element << integration;
}

// One Newton iteration a step turns elements inside out here: without giving way the run ends
TEST(UserForces, GiveWayWhereAStepFails) {
  for (const char* element : {"nodal", "linear"})
    for (const double x : {0.05, 0.1})
      for (const double z : {0.05, 0.1})
        least_ratio(implicit_steps, element, {0.1, x, z}, {-0.2, -0.2, -0.2});
}

}  // namespace
}  // namespace plica::app::test
