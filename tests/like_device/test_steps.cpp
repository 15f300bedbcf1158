// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "any_order.hpp"
#include "step_problems.hpp"
#include "support/simulate.hpp"

// Whole macro steps as a device might do them. What is right is known from the other tests, and
// from test_stored_values.cpp, which this program has, too.
namespace {

using namespace plica;
using namespace plica::test;

std::vector<double> after_some_steps(const Problem& problem) {
  Simulation<Host> simulation(problem);
  advance(simulation, 12);
  double force = 0;
  for (const Wrench& wrench : simulation.wrenches()) force += wrench.force.norm();
  EXPECT_GT(force, 0);
  std::vector<double> all;
  for (const auto& field : {simulation.positions(), simulation.velocities()})
    for (const Point& x : field) all.insert(all.end(), x.begin(), x.end());
  return all;
}

class Steps : public testing::TestWithParam<StepProblem> {};

// Sums of a team of another size are added in another order, by design: the bits are the same in
// any order of the teams. What touches is decided by signs, which rounding may turn.
TEST_P(Steps, AreTheSameInAnyOrder) {
  const Problem problem = GetParam().make();
  std::vector<double> by_one;
  for (const int team : {1, 2, 8}) {
    const auto want = [&] {
      const LikeDevice like(team, 0);
      return after_some_steps(problem);
    }();
    for (const unsigned order : {1U, 2U}) {
      const LikeDevice like(team, order);
      EXPECT_TRUE(same_bits(after_some_steps(problem), want))
          << "teams of " << team << ", order " << order;
    }
    if (team == 1) by_one = want;
    double size = 0, difference = 0;
    for (std::size_t i = 0; i < want.size(); ++i)
      size = std::max(size, std::abs(want[i])),
      difference = std::max(difference, std::abs(want[i] - by_one[i]));
    const bool touches = !problem.contact.obstacles.empty() || !problem.body.parts.empty();
    EXPECT_LE(difference, (touches ? 2e-5 : 1e-8) * size) << "teams of " << team;
  }
}

INSTANTIATE_TEST_SUITE_P(LikeDevice, Steps, testing::ValuesIn(step_problems()),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
