// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/baton_ranks.hpp>
#include <plica/drivers/run/simulation.hpp>

#include "support/backends.hpp"
#include "support/pressed_organ.hpp"
#include "support/several_ranks.hpp"

// Load steps to equilibrium of a body that several ranks share have the bits of one process.
namespace {

using namespace plica;
using namespace plica::test;

constexpr int load_steps = 2;

/// The pressed organ in short load steps.
Problem organ_to_rest(const TetMesh& mesh, const std::string& element) {
  Problem p = pressed_organ(mesh, element);
  p.body.initial = {};
  p.integration.cycle = "rest";
  p.integration.rest.ramp = 0.02, p.integration.macro_step = 2e-3;
  p.integration.implicit.solver = "conjugate_gradients";
  return p;
}

template <class B>
class RestOnRanks : public testing::Test {};
TYPED_TEST_SUITE(RestOnRanks, EachBackend);

TYPED_TEST(RestOnRanks, HasTheBitsOfOne) {
  using B = TypeParam;
  for (const char* element : {"linear", "nodal"})
    for (const bool touches : {true, false}) {
      SCOPED_TRACE(std::string(element) + (touches ? ", contact" : ""));
      Problem problem = organ_to_rest(lump(), element);
      if (!touches) problem.contact = {}, problem.body.surface.reset();
      const Outcome one = on_one_process<B>(problem, load_steps);
      EXPECT_EQ(one.contact_energy > 0, touches);
      for (const int count : {2, 7}) expect_on_ranks<B>(one, problem, count, load_steps);
    }
}

// A body that nothing holds finds no equilibrium. All ranks stop, and name the same vertex.
TYPED_TEST(RestOnRanks, StopsAlike) {
  using B = TypeParam;
  Problem problem = organ_to_rest(lump(8), "linear");
  problem.contact = {}, problem.body.surface.reset();
  problem.body.fixed.clear(), problem.body.prescribed.clear();
  problem.body.fixed = {Box{{-1, -1, -1}, {-0.046, 1, 1}}};
  problem.body.loads.front().load = TotalForce{{4000, 0, 0}};
  problem.integration.on_failure.halvings = 0;
  const auto fails = [](Simulation<B>& simulation) {
    for (int n = 0; n < 10; ++n)
      if (const auto bad = simulation.step_checked()) return bad->text();
    return std::string("no failure");
  };
  Simulation<B> one(problem);
  const std::string expected = fails(one);
  EXPECT_NE(expected.find("no equilibrium was found"), std::string::npos) << expected;
  BatonRanks(2).run([&](Ranks& ranks) {
    Simulation<B> simulation(problem, typename B::Exec(), ranks);
    EXPECT_EQ(fails(simulation), expected);
  });
}

}  // namespace
