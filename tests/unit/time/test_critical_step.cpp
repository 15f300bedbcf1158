// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/drivers/cycles/plan_steps.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/drivers/time/critical_step.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// The predicted critical step against dense eigenvalues of the same matrices.
namespace {

using namespace plica;
using namespace plica::test;

double largest_eigenvalue_of(const Eigen::MatrixXd& S) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

/// radius / w_max, of a dense matrix
double dense_limit(LevelProbe<Host>& probe, double radius) {
  return radius / std::sqrt(largest_eigenvalue_of(
                      probe.scaled_by_mass(probe.stiffness_matrix(probe.zero()))));
}

/// Within 2 % of the dense limit, and never above it.
void expect_limit(const Problem& problem, double radius) {
  LevelProbe<Host> probe(problem);
  const double predicted = probe.built.reports[0].critical_step, dense = dense_limit(probe, radius);
  EXPECT_LE(predicted, 1.001 * dense);
  EXPECT_GE(predicted, 0.98 * dense);
  EXPECT_LE(probe.built.reports[0].element_bound * radius / 2,
            1.001 * radius /
                std::sqrt(largest_eigenvalue_of(
                    probe.scaled_by_mass(probe.stiffness_matrix(probe.zero())))));
}

/// Its surface touches: contact is implicit in the step, and the limit is that of the elements.
Problem touching_cube(double stiffness, double damping) {
  Problem p = small_cube("linear");
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.045, 2);
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, -1}, {0, 0, 1}}, 0.3, {}});
  p.contact.stiffness_scale = stiffness, p.contact.damping_scale = damping;
  return p;
}

TEST(CriticalStep, OfEachMaterial) {
  for (const std::string& material : names(materials())) {
    SCOPED_TRACE(material);
    expect_limit(small_cube(material), 2);
  }
}

TEST(CriticalStep, OfRungeKuttaAndOfFixedVertices) {
  Problem p = small_cube("linear");
  p.body.fixed = {left_face()};
  expect_limit(p, 2);
  p.integration.integrator = {"rk4"};
  p.integration.macro_step = 1e-5;
  expect_limit(p, 2.78);
}

TEST(CriticalStep, OfAStiffInclusion) {
  for (double contrast : {10.0, 1e6}) {
    Problem p = small_cube("linear");
    p.body.levels[0] = with_regions(p.body.levels[0], 0.04, "stiff", "soft");
    p.body.regions["stiff"].young_modulus = contrast * 20e3;
    p.body.regions["soft"].density = 300;
    p.body.regions["soft"].poisson_ratio = 0.49;
    expect_limit(p, 2);
  }
}

TEST(CriticalStep, OfSlivers) {
  Problem p = small_cube("linear");
  TetMesh& mesh = p.body.levels[0];
  for (Point& x : mesh.vertices)  // one inner layer of vertices almost onto the next: flat elements
    if (x[2] > 0.02 && x[2] < 0.045 && !on_boundary(decimetre, x)) x = Point(x[0], x[1], 0.0634);
  expect_limit(p, 2);
}

TEST(CriticalStep, NamesTheElementsThatSetIt) {
  Problem p = small_cube("linear", 4);
  p.body.levels[0] = with_regions(p.body.levels[0], 0.05, "left", "right");
  TetMesh& mesh = p.body.levels[0];
  std::size_t moved = 0;  // the right half's vertex that is nearest to the next one above it
  while (on_boundary(decimetre, mesh.vertices[moved]) || mesh.vertices[moved][0] < 0.06) ++moved;
  const LevelReport sound = Simulation<Host>(p).levels()[0];
  EXPECT_EQ(sound.stiffest.size(), 10u);
  EXPECT_GT(sound.stiffest.front().step, named_below * sound.typical_element);
  mesh.vertices[moved] += Point(0, 0, 0.02);
  const LevelReport report = Simulation<Host>(p).levels()[0];
  const StiffElement& worst = report.stiffest.front();
  EXPECT_EQ(worst.step, report.element_bound);
  EXPECT_LT(worst.step, named_below * report.typical_element);
  EXPECT_EQ(worst.region, "right");
  EXPECT_GT(worst.height_ratio, 4);
  const auto& t = mesh.tets[static_cast<std::size_t>(worst.element)];
  EXPECT_NE(std::ranges::find(t, static_cast<int>(moved)), t.end());
  for (std::size_t i = 1; i < report.stiffest.size(); ++i)
    EXPECT_LE(report.stiffest[i - 1].step, report.stiffest[i].step);
  // a step that is refused for it says so, one of a sound mesh does not
  p.integration.macro_step = 2 * sound.critical_step, p.integration.substeps = {1};
  const std::string text = refusal([&] { Simulation<Host>{p}; });
  EXPECT_NE(text.find("element " + std::to_string(worst.element) + " (region right)"),
            std::string::npos)
      << text;
}

TEST(CriticalStep, NearTheIncompressibleLimit) {
  Problem p = small_cube("linear");
  p.body.material.poisson_ratio = 0.499;
  expect_limit(p, 2);
}

TEST(CriticalStep, WithContact) {
  using Scales = std::array<double, 2>;
  for (const auto& [stiffness, damping] :
       {Scales{1, 0}, Scales{1, 1}, Scales{0.1, 20}, Scales{30, 20}}) {
    SCOPED_TRACE(std::to_string(stiffness) + " " + std::to_string(damping));
    expect_limit(touching_cube(stiffness, damping), 2);
  }
}

// The limit is that at rest, also where a given motion starts elsewhere.
TEST(CriticalStep, DoesNotDependOnWhereAPathStarts) {
  const auto limit = [](const Point& start) {
    Problem p = small_cube("neo_hookean");
    p.body.prescribed = {{left_face(), PathMotion{{{0, start}, {1, {0, 0, 0}}}}}};
    return LevelProbe<Host>(p).built.reports[0].critical_step;
  };
  EXPECT_EQ(limit({-0.02, 0, 0}), limit({0, 0, 0}));
}

// Compressed so far some motions lower the energy, and K has no length for them.
TEST(CriticalStep, EigenvaluesOfAnIndefiniteStiffness) {
  LevelProbe<Host> probe(small_cube("st_venant_kirchhoff"));
  for (const double size : {0.95, 0.9, 0.8}) {
    std::vector<Point> u;
    for (const Point& x : probe.problem.body.levels[0].vertices) u.push_back((size - 1) * x);
    const Eigen::MatrixXd S = probe.scaled_by_mass(probe.stiffness_matrix(u));
    const auto eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S, Eigen::EigenvaluesOnly).eigenvalues();
    ASSERT_LT(eigenvalues.minCoeff(), -1e-3 * eigenvalues.maxCoeff()) << size;
    const LevelData<Host>& level = probe.at(0);
    const double found =
        largest_eigenvalue<Host>({}, {level, probe.at(0).elasticity(), device_field<Host>(u)});
    EXPECT_GE(found, 0.99 * eigenvalues.maxCoeff()) << size;
    EXPECT_LE(found, 1.003 * eigenvalues.maxCoeff()) << size;
  }
}

// After as many products as a body has frequencies, only rounding is left of the iteration. The
// value: NumPy's, of K over the lumped masses.
TEST(CriticalStep, OfATetrahedronInEveryOrderOfItsNodes) {
  const std::array<Point, 4> corners = {Point(0, 0, 0), Point(0.1, 0, 0), Point(0, 0.1, 0),
                                        Point(0, 0, 0.1)};
  for (const char* material : {"neo_hookean", "st_venant_kirchhoff", "corotational", "linear"})
    for (const char* element : {"linear", "nodal"}) {
      std::array<int, 4> order = {0, 1, 2, 3};
      do {
        TetMesh mesh;
        for (const int k : order) mesh.vertices.push_back(corners[static_cast<std::size_t>(k)]);
        const auto& x = mesh.vertices;
        mesh.tets = {{0, 1, 2, 3}};
        if (tet_volume(x[0], x[1], x[2], x[3]) < 0) mesh.tets = {{1, 0, 2, 3}};
        Problem p = body_of({mesh}, material);
        p.body.element = {element};
        p.body.material.young_modulus = 100e3, p.body.material.poisson_ratio = 0.4;
        EXPECT_NEAR(LevelProbe<Host>(p).built.reports[0].critical_step, 3.0396814e-3, 3e-6)
            << material << ' ' << element << ' ' << testing::PrintToString(order);
      } while (std::next_permutation(order.begin(), order.end()));
    }
}

TEST(CriticalStep, OfTwoTetrahedraInEveryOrderOfTheirNodes) {
  const std::array<Point, 5> corners = {Point(0, 0, 0), Point(0.1, 0, 0), Point(0, 0.1, 0),
                                        Point(0, 0, 0.1), Point(0.1, 0.1, 0.12)};
  std::array<int, 5> order = {0, 1, 2, 3, 4};
  do {
    TetMesh mesh;
    std::array<int, 5> place{};
    for (int k = 0; k < 5; ++k) {
      const auto corner = static_cast<std::size_t>(order[static_cast<std::size_t>(k)]);
      mesh.vertices.push_back(corners[corner]), place[corner] = k;
    }
    mesh.tets = {{place[0], place[1], place[2], place[3]},
                 {place[4], place[2], place[1], place[3]}};
    Problem p = body_of({mesh}, "st_venant_kirchhoff");
    expect_limit(p, 2);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(CriticalStep, OfEulerIsDampingOverSquaredFrequency) {
  Problem p = small_cube("linear");
  p.integration.integrator = {"euler"};
  p.integration.allow_unstable = true;
  p.integration.macro_step = 1e-6;
  p.body.damping.mass = 5;
  LevelProbe<Host> probe(p);
  const double w2 =
      largest_eigenvalue_of(probe.scaled_by_mass(probe.stiffness_matrix(probe.zero())));
  EXPECT_NEAR(probe.built.reports[0].critical_step, 5 / w2, 1e-3 * 5 / w2);
  p.body.damping.mass = 0;
  EXPECT_EQ(LevelProbe<Host>(p).built.reports[0].critical_step, 0);
  // heavily damped, free rigid motion itself limits the step: v += -h c v needs h c <= 2
  p.body.damping.mass = 1e6;
  EXPECT_LE(LevelProbe<Host>(p).built.reports[0].critical_step, 2 / 1e6);
}

TEST(CriticalStep, OfRungeKuttaCountsMassDamping) {
  Problem p = small_cube("linear");
  p.integration.integrator = {"rk4"};
  p.integration.macro_step = 1e-6;
  p.body.damping.mass = 1e5;
  EXPECT_LE(LevelProbe<Host>(p).built.reports[0].critical_step, 2.79 / 1e5);
}

template <class B>
class CriticalStepOn : public testing::Test {};
TYPED_TEST_SUITE(CriticalStepOn, EachBackend);

TYPED_TEST(CriticalStepOn, IsTheSameOnEveryBackend) {
  const Problem p = touching_cube(1, 1);
  const double here = LevelProbe<TypeParam>(p).built.reports[0].critical_step,
               there = LevelProbe<Host>(p).built.reports[0].critical_step;
  EXPECT_NEAR(here, there, 1e-5 * there);
}

// Shares of the macro step, sub-steps, and what is refused.

const std::vector<LevelLimits> levels = {{6 * 17 * 17 * 17, "symplectic_euler", true, 1.0e-3},
                                         {6 * 15 * 15 * 15, "symplectic_euler", true, 1.1e-3},
                                         {6 * 12 * 12 * 12, "symplectic_euler", true, 1.4e-3},
                                         {6 * 10 * 10 * 10, "implicit_euler", false, 1.7e-3}};

IntegrationOptions options(const std::string& distribution, double shift, double macro_step) {
  IntegrationOptions o;
  o.distribution = distribution, o.shift_to_coarsest = shift, o.macro_step = macro_step;
  return o;
}

std::string refusal_of(const IntegrationOptions& o, const std::vector<LevelLimits>& of = levels) {
  return refusal([&] { plan_steps(o, of); });
}

TEST(Shares, SumToOneInEveryDistribution) {
  for (const char* distribution : {"equal", "inverse_elements", "critical", "custom"})
    for (double shift : {0.0, 0.3, 0.99}) {
      IntegrationOptions o = options(distribution, shift, 1e-3);
      o.shares = {0.1, 0.2, 0.3, 0.4};
      const auto share = plan_steps(o, levels).share;
      EXPECT_NEAR(std::accumulate(share.begin(), share.end(), 0.0), 1, round_off<double>(8))
          << distribution;
      for (double w : share) EXPECT_GT(w, 0);
    }
}

TEST(Shares, AreWhatTheirNamesSay) {
  const auto critical = plan_steps(options("critical", 0, 1e-3), levels).share;
  EXPECT_NEAR(critical[3] / critical[0], 1.7, round_off<double>(8));
  const auto elements = plan_steps(options("inverse_elements", 0, 1e-3), levels).share;
  EXPECT_NEAR(elements[3] / elements[0], std::pow(1.7, 3), round_off<double>(16));
  EXPECT_NEAR(plan_steps(options("equal", 0, 1e-3), levels).share[2], 0.25, round_off<double>(2));
}

// The paper's hybrid cycle: equation 1 on cubes of 17, 15, 12 and 10 cells, half of it moved,
// shares 23 ms as 17 + 6.
TEST(Shares, MovedToTheCoarsestAreThePapersTable2) {
  const auto share = plan_steps(options("inverse_elements", 0.5, 0.023), levels).share;
  EXPECT_NEAR(share[3] * 23, 17.03, 0.005);
  EXPECT_NEAR((share[0] + share[1] + share[2]) * 23, 5.97, 0.005);
}

TEST(Shares, OfOneLevelAreAll) {
  EXPECT_EQ(plan_steps(options("inverse_elements", 0.5, 1e-4), {levels[0]}).share,
            std::vector<double>{1.0});
}

TEST(Shares, RefusesCustomOnesThatDoNotFit) {
  IntegrationOptions o = options("custom", 0, 1e-3);
  o.shares = {0.1, 0.2, 0.3, 0.41};
  EXPECT_NE(refusal_of(o).find("the shares must add up to 1, got 1.01"), std::string::npos)
      << refusal_of(o);
  o.shares = {0.1, 0.2, 0.3, 0.4 + 1e-11};
  EXPECT_NE(refusal_of(o).find("add up to 1, got 1.00000000001"), std::string::npos)
      << refusal_of(o);
  o.shares = {0.5, 0.5};
  EXPECT_NE(refusal_of(o).find("one for each level (4 in body.levels), got a list of 2"),
            std::string::npos)
      << refusal_of(o);
  o.shares = {0.5, 0.6, -0.2, 0.1};
  EXPECT_NE(refusal_of(o).find("integration.distribution is -0.2; expected a number > 0"),
            std::string::npos)
      << refusal_of(o);
  o.distribution = "equall";
  EXPECT_NE(refusal_of(o).find("did you mean 'equal'?"), std::string::npos) << refusal_of(o);
}

TEST(AutomaticStep, SaysWhyThereIsNone) {
  LevelLimits level;
  level.tets = 1, level.integrator = "symplectic_euler";
  level.critical_step = std::numeric_limits<double>::infinity();
  const auto refused = [&] { return refusal([&] { plan_steps(IntegrationOptions{}, {level}); }); };
  EXPECT_NE(refused().find("nothing is free to move"), std::string::npos) << refused();
  level.integrator = "implicit_euler", level.is_explicit = false;
  EXPECT_NE(refused().find("all are implicit"), std::string::npos) << refused();
}

// A level without a limit of its own has no critical share: never a NaN that runs.
TEST(Shares, RefusesCriticalOnesWithoutALimit) {
  auto none = levels, rigid = levels;
  none[0].integrator = "euler", none[0].critical_step = 0;
  rigid[3].critical_step = std::numeric_limits<double>::infinity();
  IntegrationOptions o = options("critical", 0, 1e-3);
  o.allow_unstable = true;
  for (const auto& bad : {none, rigid}) {
    EXPECT_NE(refusal_of(o, bad).find("critical"), std::string::npos) << refusal_of(o, bad);
    EXPECT_NE(refusal_of(o, bad).find("equal"), std::string::npos) << refusal_of(o, bad);
  }
  auto all = none;
  for (auto& level : all)
    level.critical_step = 0, level.integrator = "euler", level.is_explicit = true;
  EXPECT_NE(refusal_of(o, all), "");
  o.distribution = "equal";
  EXPECT_EQ(refusal_of(o, all), "");
  // one level needs no shares
  EXPECT_EQ(refusal_of(options("critical", 0, 1e-3), {rigid[3]}), "");
}

TEST(Substeps, AutomaticOnesKeepTheLimit) {
  IntegrationOptions o = options("equal", 0, 0.02);
  const StepPlan plan = plan_steps(o, levels);
  // ceil(5 ms / (0.9 * limit)); implicit: one
  EXPECT_EQ(plan.substeps, (std::vector<int>{6, 6, 4, 1}));
  o.safety = 1;
  EXPECT_EQ(plan_steps(o, levels).substeps, (std::vector<int>{5, 5, 4, 1}));
  o.substeps = {7, 8, 9, 2};
  EXPECT_EQ(plan_steps(o, levels).substeps, (std::vector<int>{7, 8, 9, 2}));
  EXPECT_EQ(
      refusal_of(options("equal", 0, 1e6)),
      "integration.macro_step asks for 277777778 sub-steps on one level; expected at most 1000000");
}

TEST(MacroStep, AutomaticIsNineTenthsOfTheTightestLevel) {
  IntegrationOptions o;
  o.distribution = "custom", o.shares = {0.4, 0.3, 0.2, 0.1};
  EXPECT_NEAR(plan_steps(o, levels).macro_step, 0.9 * 1e-3 / 0.4, round_off<double>(8, 1e-3));
  EXPECT_EQ(plan_steps(o, levels).substeps, (std::vector<int>{1, 1, 1, 1}));
  o.substeps = {4, 1, 1, 1};
  EXPECT_NEAR(plan_steps(o, levels).macro_step, 0.9 * 1.1e-3 / 0.3, round_off<double>(8, 1e-3));
  EXPECT_NE(refusal_of(IntegrationOptions{}, {levels[3]}).find("give it in seconds"),
            std::string::npos);
}

TEST(MacroStep, AboveTheLimitIsRefusedWithNumbersAndRemedy) {
  IntegrationOptions o = options("equal", 0, 0.008);
  o.substeps = {1};
  const std::string text = refusal_of(o);
  for (const char* part :
       {"level 0", "symplectic_euler", "0.002 s", "2 times", "critical step 0.001 s", "substeps: 2",
        "implicit", "allow_unstable: true"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " not in: " << text;
  o.allow_unstable = true;
  EXPECT_EQ(refusal_of(o), "");
  EXPECT_EQ(plan_steps(o, levels).substeps, (std::vector<int>{1, 1, 1, 1}));
}

TEST(MacroStep, UndampedEulerIsRefused) {
  Problem p = small_cube();
  p.integration.integrator = {"euler"};
  const auto text = [&] { return refusal([&] { Simulation<Host>{p}; }); };
  EXPECT_NE(text().find("(euler, rk2) is unconditionally unstable"), std::string::npos) << text();
  p.integration.macro_step = 1e-5;
  EXPECT_NE(text().find("'euler' is unconditionally unstable without damping"), std::string::npos)
      << text();
  p.integration.allow_unstable = true;
  EXPECT_EQ(text(), "");
  p.integration.allow_unstable = false, p.integration.macro_step.reset(), p.body.damping.mass = 1;
  EXPECT_EQ(text(), "");
}

}  // namespace
