// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <plica/core/baton_ranks.hpp>
#include <plica/drivers/run/simulation.hpp>

#include "support/backends.hpp"
#include "support/pressed_organ.hpp"
#include "support/refusal.hpp"

// Saved states do not know how many ranks shared the body.
namespace {

using namespace plica;
using namespace plica::test;

/// What explicit levels carry from step to step: friction, relaxation, tools, forces, divisions.
const std::map<std::string, std::function<void(Problem&)>>& carried() {
  static const std::map<std::string, std::function<void(Problem&)>> all = {
      {"friction", [](Problem&) {}},
      {"relaxation",
       [](Problem& p) {
         p.body.material.prony = {{0.3, 0.01}, {0.2, 0.1}};
         p.body.regions["inclusion"].young_modulus = 60e3;
       }},
      {"two obstacles, one with mass",
       [](Problem& p) {
         ObstacleOptions other = p.contact.obstacles.front();
         other.friction.reset();
         p.contact.obstacles.insert(p.contact.obstacles.begin(), other);
         p.contact.obstacles.back().mass = 0.05;
         p.contact.obstacles.back().coupling.stiffness = 50;
       }},
      {"central_difference", [](Problem& p) { p.integration.integrator = {"central_difference"}; }},
      {"halvings", [](Problem& p) { p.integration.on_failure.halvings = 2; }},
      {"no contact", [](Problem& p) { p.contact = {}, p.body.surface.reset(); }},
      {"levels with contact",
       [](Problem& p) {
         p.body.levels = {lump(), lump(8)};
         p.integration.cycle = "rsv";
       }},
      {"shared levels, relaxation", [](Problem& p) {
         p.body.levels = {lump(), lump(8)};
         p.integration.cycle = "rv";
         p.contact = {}, p.body.surface.reset();
         p.body.material.prony = {{0.3, 0.01}};
       }}};
  return all;
}

/// Calls work(problem) for each of these, with both elements.
template <class Work>
void for_each_carried(const Work& work) {
  for (const auto& [name, change] : carried())
    for (const char* element : {"linear", "nodal"}) {
      SCOPED_TRACE(name + ", " + element);
      Problem problem = pressed_organ(lump(), element);
      change(problem);
      work(problem);
    }
}

template <class B>
void take(Simulation<B>& simulation, int steps) {
  for (int n = 0; n < steps; ++n)
    if (const auto bad = simulation.step_checked()) {
      ADD_FAILURE() << bad->text();
      return;
    }
}

/// Goes on from a state on some ranks, or from the start where it is empty. Returns the state after
/// some steps.
template <class B>
SavedState gone_on(const Problem& problem, const SavedState& from, int steps, int count) {
  SavedState to;
  BatonRanks(count).run([&](Ranks& ranks) {
    Simulation<B> simulation(problem, typename B::Exec(), ranks);
    if (!from.bytes.empty()) simulation.restore(ranks.own() == 0 ? from : SavedState{});
    take(simulation, steps);
    const SavedState saved = simulation.save();
    EXPECT_EQ(saved.bytes.empty(), ranks.own() > 0);
    if (ranks.own() == 0) to = saved;
  });
  return to;
}

template <class B>
class SavedOnRanks : public testing::Test {};
TYPED_TEST_SUITE(SavedOnRanks, EachBackend);

TYPED_TEST(SavedOnRanks, HaveTheBytesOfOneProcess) {
  using B = TypeParam;
  for_each_carried([](const Problem& problem) {
    Simulation<B> one(problem);
    take(one, 4);
    EXPECT_EQ(one.energies().contact > 0, !problem.contact.obstacles.empty());
    if (problem.contact.obstacles.size() == 1) {
      EXPECT_LT(one.friction_work(), 0) << "no slip";
    }
    const std::vector<unsigned char> bytes = one.save().bytes;
    // with 7 ranks some have no vertex, and most no contact
    for (const int count : {1, 2, 3, 7})
      EXPECT_TRUE(gone_on<B>(problem, {}, 4, count).bytes == bytes) << count << " ranks";
  });
}

// Slots of contact that were left keep what they had.
TYPED_TEST(SavedOnRanks, HaveTheBytesOfOneProcessAfterTheBallHasLeft) {
  using B = TypeParam;
  Problem problem = pressed_organ(lump(), "linear");
  const double h = Simulation<B>(problem).macro_step();  // down for four steps, then up
  problem.contact.obstacles.front().motion =
      PathMotion{{{0, Point::Zero()}, {4 * h, 4 * h * Point(0.8, 0, -1)}, {8 * h, {0, 0, 0.02}}}};
  Simulation<B> one(problem);
  take(one, 4);
  EXPECT_GT(one.energies().contact, 0);
  EXPECT_LT(one.friction_work(), 0);
  take(one, 8);
  EXPECT_EQ(one.energies().contact, 0);
  EXPECT_TRUE(gone_on<B>(problem, {}, 12, 3).bytes == one.save().bytes);
}

TYPED_TEST(SavedOnRanks, GoOnBitForBitOnAnotherNumberOfRanks) {
  using B = TypeParam;
  for_each_carried([](const Problem& problem) {
    Simulation<B> whole(problem), first(problem), last(problem);
    take(whole, 9), take(first, 3);
    const SavedState on_3 = gone_on<B>(problem, first.save(), 3, 3),
                     on_2 = gone_on<B>(problem, on_3, 3, 2);
    EXPECT_TRUE(on_2.bytes == whole.save().bytes);
    last.restore(on_2);
    EXPECT_EQ(last.macro_steps(), 9);
    take(whole, 2), take(last, 2);
    EXPECT_EQ(last.positions(), whole.positions());
    EXPECT_EQ(last.velocities(), whole.velocities());
  });
}

// The state before a failure, to which a simulation goes back, is part of what is saved.
TYPED_TEST(SavedOnRanks, GoBackToTheLastGoodStateOfOneProcess) {
  using B = TypeParam;
  const Problem problem = pressed_organ(lump(), "linear");
  Simulation<B> one(problem);
  take(one, 25);
  const SavedState saved = one.save();
  one.return_to_last_good();
  EXPECT_EQ(one.macro_steps(), 20);
  take(one, 2);
  BatonRanks(3).run([&](Ranks& ranks) {
    Simulation<B> simulation(problem, typename B::Exec(), ranks);
    simulation.restore(saved);
    simulation.return_to_last_good();
    EXPECT_EQ(simulation.macro_steps(), 20);
    take(simulation, 2);
    const SavedState now = simulation.save();
    EXPECT_TRUE(ranks.own() > 0 || now.bytes == one.save().bytes);
  });
}

TEST(SavedOnRanks_, RefuseADamagedStateAlikeAndStayAsTheyAre) {
  const Problem problem = pressed_organ(lump(), "linear");
  Simulation<Host> one(problem);
  take(one, 2);
  const SavedState saved = one.save();
  SavedState shorter = saved, longer = saved;
  shorter.bytes.resize(saved.bytes.size() / 2), longer.bytes.resize(saved.bytes.size() + 3);
  const SavedState other = Simulation<Host>(pressed_organ(lump(8), "linear")).save();
  const std::string damaged = "the saved state is damaged: ",
                    differs =
                        "the saved state is that of another simulation: the macro step differs";
  BatonRanks(3).run([&](Ranks& ranks) {
    Simulation<Host> simulation(problem, Host::Exec(), ranks);
    simulation.restore(saved);
    const auto before = simulation.save().bytes;
    const auto refused = [&](const SavedState& state) {
      return refusal([&] { simulation.restore(ranks.own() == 0 ? state : SavedState{}); });
    };
    EXPECT_EQ(refused(shorter), damaged + "it ends early") << "rank " << ranks.own();
    EXPECT_EQ(refused(longer), damaged + "3 bytes too many") << "rank " << ranks.own();
    EXPECT_EQ(refused(other), differs) << "rank " << ranks.own();
    EXPECT_TRUE(simulation.save().bytes == before) << "changed although it refused";
  });
}

// Rank 0 calls, the others follow: also after a state that is refused.
TYPED_TEST(SavedOnRanks, FollowOne) {
  using B = TypeParam;
  const Problem problem = pressed_organ(lump(), "nodal");
  Simulation<B> one(problem);
  take(one, 3);
  const SavedState saved = one.save();
  take(one, 3);
  BatonRanks(3).run([&](Ranks& ranks) {
    Simulation<B> simulation(problem, typename B::Exec(), ranks);
    if (ranks.own() > 0) {
      EXPECT_EQ(simulation.follow(), 4);
      return;
    }
    simulation.lead();
    EXPECT_EQ(refusal([&] {
                simulation.restore({{1, 2, 3}});
              }),
              "the saved state is damaged: it ends early");
    simulation.restore(saved);
    take(simulation, 3);
    EXPECT_EQ(simulation.positions(), one.positions());
    EXPECT_TRUE(simulation.save().bytes == one.save().bytes);
    simulation.dismiss(4);
  });
}

}  // namespace
