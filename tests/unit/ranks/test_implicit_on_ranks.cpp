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
// systems in the same way.
namespace {

using namespace plica;
using namespace plica::test;

constexpr int implicit_steps = 3;

void solve_by(Problem& p, const std::string& preconditioner, const std::string& matrix) {
  ImplicitOptions& o = p.integration.implicit;
  o.solver = "conjugate_gradients", o.preconditioner = preconditioner, o.matrix = matrix;
}

/// The pressed organ in implicit steps, whose systems are solved by products.
Problem implicit_organ(const std::string& integrator, const TetMesh& mesh,
                       const std::string& element) {
  Problem p = pressed_organ(mesh, element);
  p.integration.integrator = {integrator};
  p.integration.macro_step = 4e-3;
  solve_by(p, "block_jacobi", "free");
  return p;
}

template <class B>
void expect_the_bits_of_one(const Problem& problem, const std::vector<int>& counts) {
  const Outcome one = on_one_process<B>(problem, implicit_steps);
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
       {"oblique sliding", [](Problem& p) { p.body.fixed.front().slide = Point(1, 0.4, 0.3); }},
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

/// Solvers that read a matrix of linear elements, or one that is near that of nodal elements.
struct MatrixSolver {
  std::string preconditioner, matrix, element;
  std::vector<TetMesh> coarser = {};
};

std::vector<MatrixSolver> matrix_solvers() {
  std::vector<MatrixSolver> all{{"block_jacobi", "assembled", "linear"}};
  for (const char* preconditioner : {"chebyshev", "multigrid"}) {
    for (const char* matrix : {"assembled", "free"})
      all.push_back({preconditioner, matrix, "linear"});
    all.push_back({preconditioner, "free", "nodal"});
  }
  for (const char* element : {"linear", "nodal"})
    all.push_back(
        {"multigrid", element == std::string("linear") ? "assembled" : "free", element, {lump(8)}});
  return all;
}

Problem solved_by(const MatrixSolver& by, const std::string& integrator, const TetMesh& mesh) {
  Problem problem = implicit_organ(integrator, mesh, by.element);
  solve_by(problem, by.preconditioner, by.matrix);
  problem.body.levels.insert(problem.body.levels.end(), by.coarser.begin(), by.coarser.end());
  return problem;
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
  const auto check = [](const Problem& problem) {
    expect_saved_on_ranks<TypeParam>(problem, {2, 7}, 2, 1);
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
  check(solved_by({"multigrid", "assembled", "linear"}, "bdf2", lump()));
  check(solved_by({"multigrid", "free", "nodal"}, "bdf2", lump()));
}

// A part of a macro step that is not solved is halved on all ranks.
TYPED_TEST(ImplicitOnRanks, HalveStepsAlike) {
  using B = TypeParam;
  for (const char* element : {"linear", "nodal"}) {
    SCOPED_TRACE(element);
    Problem problem = implicit_organ("newmark", lump(), element);
    problem.integration.implicit.newton_iterations = 3;
    problem.integration.on_failure.halvings = 3;
    Simulation<B> one(problem);
    take_steps(one, implicit_steps);
    EXPECT_GT(one.counters().at("step_halvings"), 0);
    expect_the_bits_of_one<B>(problem, {3});
  }
}

template <class Check>
void for_matrix_solvers(const Check& check) {
  for (const MatrixSolver& by : matrix_solvers()) {
    SCOPED_TRACE(by.preconditioner + ", " + by.matrix + ", " + by.element + ", " +
                 std::to_string(by.coarser.size()) + " coarser meshes");
    check(by);
  }
}

TYPED_TEST(ImplicitOnRanks, HaveTheBitsOfOneWithAMatrix) {
  for_matrix_solvers([](const MatrixSolver& by) {
    expect_the_bits_of_one<TypeParam>(solved_by(by, "implicit_euler", lump()), {2, 7});
  });
}

TYPED_TEST(ImplicitOnRanks, HaveTheBitsOfOneWithAMatrixAndEachIntegrator) {
  for (const char* integrator : {"sdirk2", "newmark", "generalized_alpha"}) {
    SCOPED_TRACE(integrator);
    expect_the_bits_of_one<TypeParam>(
        solved_by({"block_jacobi", "assembled", "linear"}, integrator, lump()), {3});
  }
}

TYPED_TEST(ImplicitOnRanks, HaveTheBitsOfOneWithAMatrixInAnOrgan) {
  for (const MatrixSolver& by : {MatrixSolver{"block_jacobi", "assembled", "linear"},
                                 MatrixSolver{"multigrid", "assembled", "linear"},
                                 MatrixSolver{"multigrid", "free", "nodal"}}) {
    SCOPED_TRACE(by.preconditioner + ", " + by.element);
    expect_the_bits_of_one<TypeParam>(solved_by(by, "bdf2", liver()), {16});
  }
}

TYPED_TEST(ImplicitOnRanks, HaveTheBitsOfOneWithAMatrixAndEachOption) {
  for (const auto& [name, change] : options())
    for (const MatrixSolver& by : {MatrixSolver{"multigrid", "assembled", "linear"},
                                   MatrixSolver{"multigrid", "free", "nodal"}}) {
      SCOPED_TRACE(name + ", " + by.element);
      Problem problem = solved_by(by, "implicit_euler", lump());
      change(problem);
      expect_the_bits_of_one<TypeParam>(problem, {3});
    }
}

// Where the fibres turn with the place, each rank has those of the elements at its border too.
TYPED_TEST(ImplicitOnRanks, HaveTheBitsOfOneWithAMatrixAndFibres) {
  for (const MatrixSolver& by : {MatrixSolver{"block_jacobi", "assembled", "linear"},
                                 MatrixSolver{"chebyshev", "free", "nodal"}}) {
    SCOPED_TRACE(by.element);
    Problem problem = solved_by(by, "implicit_euler", lump());
    problem.body.material = complete({"holzapfel_gasser_ogden", 20e3, 0.35, 1000});
    problem.body.material.fibres = FibreOptions{{1, 0.3, 0}, Point(0, 1, 0.2), {}};
    problem.integration.implicit.tangent = "positive";
    expect_the_bits_of_one<TypeParam>(problem, {3});
  }
}

TYPED_TEST(ImplicitOnRanks, HaveTheBitsOfOneByAVCycle) {
  for (const char* element : {"linear", "nodal"}) {
    SCOPED_TRACE(element);
    Problem problem = implicit_organ("v_cycle_euler", lump(), element);
    problem.integration.implicit = {};
    expect_the_bits_of_one<TypeParam>(problem, {3});
  }
}

// Coarser levels are integrated, too, and have cycles of their own below them.
TYPED_TEST(ImplicitOnRanks, HaveTheBitsOfOneOnLevelsWithAMatrix) {
  for (const bool touches : {false, true}) {
    SCOPED_TRACE(touches ? "contact" : "no contact");
    Problem problem =
        solved_by({"multigrid", "assembled", "linear", {lump(8)}}, "implicit_euler", lump());
    problem.integration.cycle = "rsv";
    if (!touches) problem.contact = {}, problem.body.surface.reset();
    expect_the_bits_of_one<TypeParam>(problem, {2});
  }
}

TYPED_TEST(ImplicitOnRanks, ChooseTheSolverOfOneProcess) {
  using B = TypeParam;
  for (const char* element : {"linear", "nodal"})
    for (const double macro_step : {1e-4, 0.1}) {
      Problem problem = implicit_organ("bdf2", lump(), element);
      problem.integration.implicit = {}, problem.integration.macro_step = macro_step;
      const Simulation<B> one(problem);
      BatonRanks(2).run([&](Ranks& ranks) {
        const Simulation<B> simulation(problem, typename B::Exec(), ranks);
        EXPECT_EQ(simulation.levels()[0].linear_solver, one.levels()[0].linear_solver);
      });
    }
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
}

}  // namespace
