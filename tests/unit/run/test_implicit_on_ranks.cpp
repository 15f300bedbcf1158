// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <plica/core/baton_ranks.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/run/simulation.hpp>

#include "support/backends.hpp"
#include "support/pressed_organ.hpp"
#include "support/refusal.hpp"
#include "support/several_ranks.hpp"

// Implicit steps of a body that several ranks share have the bits of one process, which solves its
// systems in the same way: by products, preconditioned by the vertices' own blocks.
namespace {

using namespace plica;
using namespace plica::test;

constexpr int implicit_steps = 3;

/// The pressed organ in implicit steps; which solver is left open.
Problem implicit_organ(const std::string& integrator, const TetMesh& mesh,
                       const std::string& element) {
  Problem p = pressed_organ(mesh, element);
  p.integration.integrator = {integrator};
  p.integration.macro_step = 4e-3;
  return p;
}

/// Names the solver that several ranks choose.
Problem by_products(Problem p) {
  ImplicitOptions& o = p.integration.implicit;
  o.solver = "conjugate_gradients", o.preconditioner = "block_jacobi", o.matrix = "free";
  return p;
}

template <class B>
void expect_the_bits_of_one(const Problem& problem, const std::vector<int>& counts) {
  const Outcome one = on_one_process<B>(by_products(problem), implicit_steps);
  EXPECT_EQ(one.contact_energy > 0, !problem.contact.obstacles.empty());
  for (const int count : counts) expect_on_ranks<B>(one, problem, count, implicit_steps);
}

/// Smooths the pressures of nodal elements. Their systems take many iterations; steps are taken as
/// far as four of them solve them.
void smooth_pressures(Problem& p) {
  p.body.material.poisson_ratio = 0.45;
  p.integration.implicit.newton_iterations = 4, p.integration.on_failure.halvings = 0;
  if (p.body.element.front() == "nodal") p.body.pressure = "smoothed";
}

/// Options of implicit steps, and of bodies that take them.
const ProblemOptions& options() {
  static const ProblemOptions all = with_body_options(
      {{"stiffness damping", [](Problem& p) { p.body.damping.stiffness = 1e-3; }},
       {"smoothed pressures", smooth_pressures},
       {"nothing moved", [](Problem& p) { p.body.prescribed.clear(); }},
       {"no contact", [](Problem& p) { p.contact = {}, p.body.surface.reset(); }},
       {"one linear system", [](Problem& p) { p.integration.implicit.newton_iterations = 1; }},
       {"fixed iterations", [](Problem& p) { p.integration.implicit.iterations = 12; }},
       {"exact tangents", [](Problem& p) { p.integration.implicit.tangent = "exact"; }},
       {"long steps", [](Problem& p) {
          p.integration.macro_step = 0.012;
          p.integration.on_failure.halvings = 2;
        }}});
  return all;
}

template <class B>
class ImplicitOnRanks : public testing::Test {};
TYPED_TEST_SUITE(ImplicitOnRanks, EachBackend);

TYPED_TEST(ImplicitOnRanks, HaveTheBitsOfOne) {
  for (const char* integrator :
       {"implicit_euler", "bdf2", "sdirk2", "newmark", "generalized_alpha"})
    for (const char* element : {"linear", "nodal"}) {
      SCOPED_TRACE(std::string(integrator) + ", " + element);
      expect_the_bits_of_one<TypeParam>(implicit_organ(integrator, lump(), element), {2, 3, 7});
    }
}

TYPED_TEST(ImplicitOnRanks, HaveTheBitsOfOneInAnOrgan) {
  for (const char* element : {"linear", "nodal"}) {
    SCOPED_TRACE(element);
    expect_the_bits_of_one<TypeParam>(implicit_organ("implicit_euler", liver(), element), {3, 16});
  }
}

TYPED_TEST(ImplicitOnRanks, HaveTheBitsOfOneWithEachOption) {
  for (const auto& [name, change] : options())
    for (const char* element : {"linear", "nodal"}) {
      SCOPED_TRACE(name + ", " + element);
      Problem problem = implicit_organ("implicit_euler", lump(), element);
      change(problem);
      expect_the_bits_of_one<TypeParam>(problem, {4});
    }
}

// Linear elements keep projected tangents where there is no matrix, nodal ones do always.
TYPED_TEST(ImplicitOnRanks, HaveTheBitsOfOneWithProjectedTangents) {
  for (const bool damped : {false, true})
    for (const char* element : {"linear", "nodal"}) {
      SCOPED_TRACE(std::string(element) + (damped ? ", damped" : ""));
      Problem problem = implicit_organ("implicit_euler", lump(), element);
      problem.integration.implicit.tangent = "positive";
      if (damped) problem.body.damping.stiffness = 1e-3;
      expect_the_bits_of_one<TypeParam>(problem, {2, 4});
    }
}

TYPED_TEST(ImplicitOnRanks, HaveTheBitsOfOneInEachMaterial) {
  for (const MaterialInfo& info : material_list())
    for (const char* element : {"linear", "nodal"}) {
      SCOPED_TRACE(std::string(info.name) + ", " + element);
      Problem problem = implicit_organ("bdf2", lump(8), element);
      problem.contact = {}, problem.body.surface.reset();
      problem.body.material = complete({std::string(info.name), 20e3, 0.35, 1000});
      if (info.has_fibres)
        problem.body.material.fibres = FibreOptions{{1, 0.3, 0}, Point(0, 1, 0.2), {}};
      expect_the_bits_of_one<TypeParam>(problem, {2});
    }
}

// What implicit levels carry from step to step: guesses of solutions, changes, accelerations, mixed
// dilatations, contact.
TYPED_TEST(ImplicitOnRanks, SaveTheBytesOfOneAndGoOn) {
  using B = TypeParam;
  const auto check = [](const Problem& problem) {
    Simulation<B> one(by_products(problem));
    take_steps(one, 2);
    EXPECT_EQ(one.counters().contains("pressure_updates"), problem.body.pressure == "smoothed");
    const SavedState saved = one.save();
    take_steps(one, 1);
    const SavedState end = one.save();
    for (const int count : {2, 7})
      BatonRanks(count).run([&](Ranks& ranks) {
        Simulation<B> first(problem, typename B::Exec(), ranks);
        take_steps(first, 2);
        const SavedState own = first.save();
        Simulation<B> second(problem, typename B::Exec(), ranks);
        second.restore(ranks.own() == 0 ? saved : SavedState{});
        take_steps(second, 1);
        const SavedState last = second.save();
        if (ranks.own() > 0) return;
        EXPECT_TRUE(own.bytes == saved.bytes) << count << " ranks";
        EXPECT_TRUE(last.bytes == end.bytes) << count << " ranks";
      });
  };
  for (const char* integrator : {"bdf2", "generalized_alpha"})
    for (const char* element : {"linear", "nodal"}) {
      SCOPED_TRACE(std::string(integrator) + ", " + element);
      check(implicit_organ(integrator, lump(), element));
    }
  Problem smoothed = implicit_organ("implicit_euler", lump(), "nodal");
  smooth_pressures(smoothed);
  smoothed.body.material.prony = {{0.3, 0.01}};
  check(smoothed);
}

// A part of a macro step that is not solved is halved on all ranks.
TYPED_TEST(ImplicitOnRanks, HalveStepsAlike) {
  using B = TypeParam;
  for (const char* element : {"linear", "nodal"}) {
    SCOPED_TRACE(element);
    Problem problem = implicit_organ("newmark", lump(), element);
    problem.integration.implicit.newton_iterations = 3;
    problem.integration.on_failure.halvings = 3;
    Simulation<B> one(by_products(problem));
    take_steps(one, implicit_steps);
    EXPECT_GT(one.counters().at("step_halvings"), 0);
    expect_the_bits_of_one<B>(problem, {3});
  }
}

TYPED_TEST(ImplicitOnRanks, ChooseConjugateGradientsWithoutAMatrix) {
  using B = TypeParam;
  for (const char* element : {"linear", "nodal"})
    BatonRanks(2).run([&](Ranks& ranks) {
      const Simulation<B> simulation(implicit_organ("bdf2", lump(), element), typename B::Exec(),
                                     ranks);
      EXPECT_EQ(simulation.levels()[0].linear_solver,
                "conjugate_gradients, block_jacobi, without a matrix");
    });
}

TEST(ImplicitOnRanksRefusals, NameTheOptionAndTheAlternative) {
  const auto refused = [](const std::function<void(ImplicitOptions&)>& change) {
    Problem problem = implicit_organ("implicit_euler", lump(8), "linear");
    change(problem.integration.implicit);
    std::string said;
    BatonRanks(2).run([&](Ranks& ranks) {
      said = refusal([&] { Simulation<Host>(problem, Host::Exec(), ranks); });
    });
    return said;
  };
  const std::string alone = ", which runs on one process alone; expected ";
  EXPECT_EQ(
      refused([](ImplicitOptions& o) { o.solver = "direct"; }),
      "integration.implicit.solver is direct" + alone + "conjugate_gradients, or one process");
  EXPECT_EQ(
      refused([](ImplicitOptions& o) { o.solver = "v_cycle"; }),
      "integration.implicit.solver is v_cycle" + alone + "conjugate_gradients, or one process");
  EXPECT_EQ(
      refused([](ImplicitOptions& o) { o.preconditioner = "multigrid"; }),
      "integration.implicit.preconditioner is multigrid" + alone + "block_jacobi, or one process");
  EXPECT_EQ(refused([](ImplicitOptions& o) { o.matrix = "assembled"; }),
            "integration.implicit.matrix is assembled" + alone + "free, or one process");
}

}  // namespace
