// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <plica/core/baton_ranks.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/level/part_of_level.hpp>
#include <plica/drivers/run/diagnose.hpp>
#include <plica/drivers/run/simulation.hpp>

#include "support/backends.hpp"
#include "support/pressed_organ.hpp"
#include "support/refusal.hpp"
#include "support/several_ranks.hpp"

// A body that several ranks share has the bits of one process.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class SeveralRanks : public testing::Test {};
TYPED_TEST_SUITE(SeveralRanks, EachBackend);

TYPED_TEST(SeveralRanks, HaveTheBitsOfOne) {
  const TetMesh mesh = liver();
  for (const char* element : {"linear", "nodal"}) {
    SCOPED_TRACE(element);
    const Problem problem = pressed_organ(mesh, element);
    const Outcome one = on_one_process<TypeParam>(problem);
    EXPECT_GT(one.contact_energy, 0) << "the ball does not touch";
    EXPECT_LT(one.force[2], 0) << "the ball does not push the body down";
    for (const int count : {1, 2, 3, 7, 16}) expect_on_ranks<TypeParam>(one, problem, count);
  }
}

TYPED_TEST(SeveralRanks, HaveTheBitsOfOneInEachMaterial) {
  for (const MaterialInfo& info : material_list())
    for (const char* element : {"linear", "nodal"}) {
      SCOPED_TRACE(std::string(info.name) + ", " + element);
      Problem problem = pressed_organ(lump(8), element);
      problem.contact = {}, problem.body.surface.reset();
      problem.body.material = complete({std::string(info.name), 20e3, 0.35, 1000});
      if (info.has_fibres)
        problem.body.material.fibres = FibreOptions{{1, 0.3, 0}, Point(0, 1, 0.2), {}};
      expect_on_ranks<TypeParam>(on_one_process<TypeParam>(problem), problem, 2);
    }
}

// Options of an explicit level: damping by stiffness, relaxation, smoothed pressures,
// regions, sliding vertices, a turn, a tool with mass, other integrators.
TYPED_TEST(SeveralRanks, HaveTheBitsOfOneWithEachOption) {
  const ProblemOptions options = with_body_options(
      {{"stiffness damping", [](Problem& p) { p.body.damping.stiffness = 1e-5; }},
       {"smoothed pressures", [](Problem& p) { p.body.material.poisson_ratio = 0.495; }},
       {"central_difference",
        [](Problem& p) { p.integration.integrator = {"central_difference"}; }},
       {"rk4", [](Problem& p) { p.integration.integrator = {"rk4"}; }},
       {"halvings", [](Problem& p) { p.integration.on_failure.halvings = 2; }},
       {"stretched", [](Problem& p) {
          p.body.initial.stretch = {1.02, 1, 0.99};
        }}});
  for (const auto& [name, change] : options)
    for (const char* element : {"linear", "nodal"}) {
      SCOPED_TRACE(name + ", " + element);
      Problem problem = pressed_organ(lump(), element);
      change(problem);
      expect_on_ranks<TypeParam>(on_one_process<TypeParam>(problem), problem, 4);
    }
}

/// A lump in three resolutions, which are not nested: 5, 2 and 1 blocks of vertices. Without
/// contact ranks share all levels, with contact the finest one.
Problem lump_of_three_levels(const std::string& cycle, const std::string& element, bool contact) {
  Problem p = pressed_organ(lump(), element);
  p.body.levels = {lump(), lump(8), lump(4)};
  p.integration.cycle = cycle;
  if (!contact) p.contact = {}, p.body.surface.reset();
  return p;
}

TYPED_TEST(SeveralRanks, HaveTheBitsOfOneOnSeveralLevels) {
  for (const char* cycle : {"rs", "rv", "rsv", "rsv_sv", "fas"})
    for (const char* element : {"linear", "nodal"})
      for (const bool contact : {false, true}) {
        SCOPED_TRACE(std::string(cycle) + ", " + element + (contact ? ", contact" : ""));
        const Problem problem = lump_of_three_levels(cycle, element, contact);
        const Outcome one = on_one_process<TypeParam>(problem);
        EXPECT_EQ(one.force.norm() > 0, contact);
        for (const int count : {1, 2, 3, 7}) expect_on_ranks<TypeParam>(one, problem, count);
      }
}

TYPED_TEST(SeveralRanks, HaveTheBitsOfOneWithEachOptionOnSeveralLevels) {
  const std::map<std::string, std::function<void(Problem&)>> options = {
      {"relaxation",
       [](Problem& p) {
         p.body.material.prony = {{0.3, 0.01}, {0.2, 0.1}};
       }},
      {"smoothed pressures", [](Problem& p) { p.body.material.poisson_ratio = 0.495; }},
      {"sliding", [](Problem& p) { p.body.fixed.front().along = {"x"}; }},
      {"halvings", [](Problem& p) { p.integration.on_failure.halvings = 2; }},
      {"extrapolation", [](Problem& p) { p.integration.outside = "extrapolate"; }},
      {"implicit coarse level",
       [](Problem& p) {
         p.integration.integrator = {"symplectic_euler", "symplectic_euler", "implicit_euler"};
         p.integration.implicit.solver = "conjugate_gradients";
         p.integration.implicit.preconditioner = "block_jacobi";
         p.integration.implicit.matrix = "free";
       }},
      {"an element for each level", [](Problem& p) {
         p.body.element = {"nodal", "nodal", "linear"};
         p.integration.cycle = "rs";
       }}};
  for (const auto& [name, change] : options) {
    SCOPED_TRACE(name);
    Problem problem = lump_of_three_levels("rsv", "linear", false);
    change(problem);
    expect_on_ranks<TypeParam>(on_one_process<TypeParam>(problem), problem, 4);
  }
}

// Rank 0 has all of each level, whether it is shared or not.
TYPED_TEST(SeveralRanks, GiveEachLevel) {
  using B = TypeParam;
  for (const char* element : {"linear", "nodal"})
    for (const bool contact : {false, true}) {
      const Problem problem = lump_of_three_levels("rsv", element, contact);
      Simulation<B> one(problem);
      take_steps(one);
      BatonRanks(3).run([&](Ranks& ranks) {
        Simulation<B> simulation(problem, typename B::Exec(), ranks);
        if (ranks.own() > 0) {
          EXPECT_EQ(simulation.follow(), 0);
          return;
        }
        simulation.lead();
        take_steps(simulation);
        for (int level = 0; level < 3; ++level) {
          EXPECT_TRUE(equal_bits(simulation.positions(level), one.positions(level)));
          EXPECT_TRUE(equal_bits(simulation.velocities(level), one.velocities(level)));
          EXPECT_TRUE(equal_bits(simulation.element_fields(level, true).stress,
                                 one.element_fields(level, true).stress));
        }
        simulation.dismiss(0);
      });
    }
}

// A vertex that two ranks update has the same values on both, after each macro step.
TYPED_TEST(SeveralRanks, HaveEqualCopies) {
  using B = TypeParam;
  const Problem problem = pressed_organ(liver(), "linear");
  Simulation<B> one(problem);
  std::vector<std::vector<Point>> u, v;
  for (int n = 0; n < macro_steps; ++n) {
    one.step();
    u.push_back(to_host<B>({}, one.displacement())), v.push_back(to_host<B>({}, one.velocity()));
  }
  BatonRanks(5).run([&](Ranks& ranks) {
    Simulation<B> simulation(problem, typename B::Exec(), ranks);
    const std::vector<int> local =
        part_of_level(problem.body.levels[0], Element::linear, ranks).part.vertex;
    ASSERT_EQ(local.size(), simulation.displacement().extent(0));
    EXPECT_GT(local.size(), simulation.numbers().size());
    for (std::size_t n = 0; n < macro_steps; ++n) {
      simulation.step();
      const auto own_u = to_host<B>({}, simulation.displacement()),
                 own_v = to_host<B>({}, simulation.velocity());
      for (std::size_t i = 0; i < local.size(); ++i) {
        const auto a = static_cast<std::size_t>(local[i]);
        ASSERT_EQ(own_u[i], u[n][a]) << "vertex " << a << ", macro step " << n + 1;
        ASSERT_EQ(own_v[i], v[n][a]) << "vertex " << a << ", macro step " << n + 1;
      }
    }
  });
}

TYPED_TEST(SeveralRanks, StopAlike) {
  using B = TypeParam;
  for (const bool invert : {true, false}) {
    Problem problem = pressed_organ(lump(), "linear");
    problem.contact = {}, problem.body.surface.reset();
    problem.body.material.allow_inversion = invert;
    problem.integration.macro_step = 1.7 * Simulation<B>(problem).levels()[0].critical_step;
    problem.integration.substeps = {1};
    problem.integration.allow_unstable = true;
    const auto end = [](Simulation<B>& simulation) {
      for (int n = 0; n < 500; ++n)
        if (const auto bad = simulation.step_checked()) return bad->text();
      return std::string("it goes on");
    };
    Simulation<B> alone(problem);
    const std::string expected = end(alone);
    EXPECT_NE(expected, "it goes on");
    BatonRanks(3).run([&](Ranks& ranks) {
      Simulation<B> simulation(problem, typename B::Exec(), ranks);
      EXPECT_EQ(end(simulation), expected) << "rank " << ranks.own();
      EXPECT_EQ(simulation.macro_steps(), alone.macro_steps());
    });
  }
}

// Rank 0 calls, the others follow; it has the whole body.
TYPED_TEST(SeveralRanks, FollowOne) {
  using B = TypeParam;
  for (const char* element : {"linear", "nodal"}) {
    const Problem problem = pressed_organ(lump(), element);
    Simulation<B> one(problem);
    take_steps(one);
    const ElementFields expected = one.element_fields(0, true);
    BatonRanks(3).run([&](Ranks& ranks) {
      Simulation<B> simulation(problem, typename B::Exec(), ranks);
      if (ranks.own() > 0) {
        EXPECT_EQ(simulation.follow(), 3);
        return;
      }
      simulation.lead();
      take_steps(simulation);
      EXPECT_TRUE(equal_bits(simulation.positions(), one.positions()));
      EXPECT_TRUE(equal_bits(simulation.velocities(), one.velocities()));
      EXPECT_TRUE(equal_bits(simulation.surface_positions(), one.surface_positions()));
      EXPECT_TRUE(equal_bits(simulation.surface_velocities(), one.surface_velocities()));
      EXPECT_TRUE(equal_bits(simulation.contact_pressure(), one.contact_pressure()));
      const ElementFields fields = simulation.element_fields(0, true);
      EXPECT_TRUE(equal_bits(fields.von_mises, expected.von_mises));
      EXPECT_TRUE(equal_bits(fields.J, expected.J));
      EXPECT_TRUE(equal_bits(fields.stress, expected.stress));
      EXPECT_TRUE(equal_bits(fields.principal_stretches, expected.principal_stretches));
      const RankReport report = simulation.ranks().value();
      EXPECT_EQ(report.count, 3);
      EXPECT_GT(report.messages, 0);
      EXPECT_GT(report.bytes, report.messages);
      EXPECT_GE(report.imbalance, 1);
      simulation.dismiss(3);
    });
  }
}

TEST(SeveralRanksRefusals, NameTheOptionAndTheAlternative) {
  const auto refused = [](const std::function<void(Problem&)>& change) {
    Problem problem = pressed_organ(lump(), "linear");
    change(problem);
    std::string said;
    BatonRanks(2).run([&](Ranks& ranks) {
      said = refusal([&] { Simulation<Host>(problem, Host::Exec(), ranks); });
    });
    return said;
  };
  EXPECT_EQ(
      refused([](Problem& p) { p.integration.cycle = "auto"; }),
      "integration.cycle is auto, which runs on one process alone; expected single, him, rest, "
      "rs, rv, rsv, rsv_sv or fas, or one process");
  EXPECT_EQ(refused([](Problem& p) { p.contact.obstacles.front().grasp.emplace(); }),
            "contact.obstacles.0.grasp holds points, which runs on one process alone; expected "
            "none, or one process");
  EXPECT_NE(refused([](Problem& p) { p.contact.whole_surface = "auto"; }).find("expected never"),
            std::string::npos);
}

}  // namespace
