// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/baton_ranks.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/run/simulation.hpp>

#include "support/backends.hpp"
#include "support/pressed_organ.hpp"
#include "support/refusal.hpp"
#include "support/several_ranks.hpp"

// The hierarchical inverse mass of a body that several ranks share has the bits of one process.
// Ranks share the finest level; the coarser ones are whole on each.
namespace {

using namespace plica;
using namespace plica::test;

/// The pressed organ in steps of the inverse mass.
Problem him_organ(const TetMesh& mesh, const std::string& element) {
  Problem p = pressed_organ(mesh, element);
  p.integration.cycle = "him";
  return p;
}

/// Nothing holds or moves the body: its translation is exact.
void set_free(Problem& p) {
  p.body.fixed.clear(), p.body.prescribed.clear();
  p.body.initial.angular_velocity = {3, -20, 9};
}

template <class B>
void expect_the_bits_of_one(const Problem& problem, const std::vector<int>& counts) {
  const Outcome one = on_one_process<B>(problem);
  EXPECT_EQ(one.contact_energy > 0, !problem.contact.obstacles.empty());
  for (const int count : counts) expect_on_ranks<B>(one, problem, count);
}

template <class B>
class HimOnRanks : public testing::Test {};
TYPED_TEST_SUITE(HimOnRanks, EachBackend);

TYPED_TEST(HimOnRanks, HasTheBitsOfOne) {
  for (const char* element : {"linear", "nodal"}) {
    SCOPED_TRACE(element);
    expect_the_bits_of_one<TypeParam>(him_organ(lump(), element), {2, 7});
  }
}

TYPED_TEST(HimOnRanks, HasTheBitsOfOneInAnOrganWithSlivers) {
  const Problem problem = him_organ(liver(), "linear");
  const Simulation<TypeParam> one(problem);
  EXPECT_EQ(one.levels()[1].kind, LevelKind::slivers);
  expect_the_bits_of_one<TypeParam>(problem, {3});
}

TYPED_TEST(HimOnRanks, HasTheBitsOfOneWithEachOption) {
  ProblemOptions options = with_body_options({
      {"free", set_free},
      {"no contact", [](Problem& p) { p.contact = {}, p.body.surface.reset(); }},
      {"a coarser mesh", [](Problem& p) { p.body.levels.push_back(lump(4)); }},
      {"one coarser level", [](Problem& p) { p.body.coarsen = std::vector{200}; }},
      {"smoothed pressures",
       [](Problem& p) {
         p.body.material.poisson_ratio = 0.45;
         if (p.body.element.front() == "nodal") p.body.pressure = "smoothed";
       }},
  });
  options.erase("sliding");  // which him does not take
  for (const auto& [name, change] : options)
    for (const char* element : {"linear", "nodal"}) {
      SCOPED_TRACE(name + ", " + element);
      Problem problem = him_organ(lump(8), element);
      change(problem);
      expect_the_bits_of_one<TypeParam>(problem, {2});
    }
}

// A body that stiffens takes shorter steps, then longer ones again.
TYPED_TEST(HimOnRanks, RepairsAlike) {
  using B = TypeParam;
  Problem problem = him_organ(lump(), "linear");
  problem.contact = {}, problem.body.surface.reset();
  problem.body.material = complete({"veronda_westmann", 20e3, 0.35, 1000});
  problem.body.initial.velocity = {0, 0, -2};
  Simulation<B> one(problem);
  take_steps(one);
  EXPECT_GT(one.counters().at("inertia_refits"), 0);
  expect_the_bits_of_one<B>(problem, {3});
}

TYPED_TEST(HimOnRanks, SavesTheBytesOfOneAndGoesOn) {
  for (const bool is_free : {false, true}) {
    Problem problem = him_organ(lump(), "nodal");
    if (is_free) set_free(problem);
    expect_saved_on_ranks<TypeParam>(problem, {3}, 3, 2);
  }
}

TEST(HimOnRanksRefusals, NameWhatItNeeds) {
  const auto refused = [](const Problem& problem) {
    std::string said;
    BatonRanks(2).run([&](Ranks& ranks) {
      said = refusal([&] { Simulation<Host>(problem, Host::Exec(), ranks); });
    });
    return said;
  };
  Problem several = him_organ(lump(8), "linear");
  several.contact = {};
  several.body.parts.resize(2);
  EXPECT_EQ(refused(several),
            "integration.cycle is him, with several bodies, which runs on one process alone; "
            "expected another cycle or one body, or one process");
}

}  // namespace
