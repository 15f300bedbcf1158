// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/study/cycle_growth.hpp>
#include <plica/drivers/study/eigenvalues.hpp>
#include <plica/kernels/contact/shapes.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Linearised cycles: dense eigenvalues, the Krylov space, and what runs do.
namespace {

using namespace plica;
using namespace plica::test;
using Map = CycleMap<Host>;

/// A short clamped beam; a step over the finest level's critical step.
Problem clamped(const std::string& cycle, double over_critical, bool nested) {
  std::vector<TetMesh> levels = {box_mesh(beam_box, {4, 2, 2})};
  levels.push_back(nested ? box_mesh(beam_box, {2, 1, 1}) : jittered_box(beam_box, {3, 2, 1}, 0.2));
  Problem p = body_of(std::move(levels));
  p.body.fixed = {left_face()};
  p.integration.cycle = "single";
  const double critical = Simulation<Host>(p).levels()[0].critical_step;
  p.integration.cycle = cycle, p.integration.macro_step = over_critical * critical;
  p.integration.allow_unstable = true, p.integration.substeps = {1};
  return p;
}

TEST(Arnoldi, FindsTheLargestPairOfAMatrix) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(60, 60);
  for (int i = 0; i < 58; ++i) A(i, i) = 0.9 * i / 58, A(i, i + 1) = 0.3;
  A(58, 58) = A(59, 59) = 0.6, A(58, 59) = -0.8 * 1.1, A(59, 58) = 0.8 * 1.1;
  const double want = std::hypot(0.6, 0.88);
  const auto map = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return A * x; };
  const RitzValue all = largest_ritz_value(map, Eigen::VectorXd::Ones(60), 60);
  EXPECT_NEAR(std::abs(all.value), want, 1e-9);
  EXPECT_LE(all.residual, 1e-9);
  // it knows when it is not there
  EXPECT_GT(largest_ritz_value(map, Eigen::VectorXd::Ones(60), 3).residual, 1e-3);
  Eigen::VectorXd invariant = Eigen::VectorXd::Zero(60);
  invariant.tail(2) << 1, 2;
  EXPECT_NEAR(std::abs(largest_ritz_value(map, invariant, 60).value), want, 1e-13);
  // A e_0 = 0
  EXPECT_EQ(std::abs(largest_ritz_value(map, Eigen::VectorXd::Unit(60, 0), 60).value), 0);
}

// Symplectic Euler: all eigenvalues on the unit circle below the limit 2/w, one beyond it above.
TEST(CycleMap, OfASingleLevelHasTheLimitTwoOverOmega) {
  for (const double over : {0.5, 0.99}) {
    const CycleGrowth growth = cycle_growth(Map(clamped("single", over, true)));
    EXPECT_NEAR(spectral_radius(Map(clamped("single", over, true)).matrix()), 1, 1e-6) << over;
    EXPECT_NEAR(growth.radius, 1, 2e-3) << over;
  }
  const Map above(clamped("single", 1.01, true));
  // h w = 2.02 (to the prediction's 1e-3): lambda of lambda^2 - (2 - (h w)^2) lambda + 1 = 0
  const double b = 2.02 * 2.02 / 2 - 1, want = b + std::sqrt(b * b - 1);
  const CycleGrowth growth = cycle_growth(above);
  EXPECT_NEAR(growth.radius, want, 0.01);
  EXPECT_NEAR(growth.radius, spectral_radius(above.matrix()), 1e-6);
  EXPECT_TRUE(growth.converged);
  EXPECT_DOUBLE_EQ(growth.per_second, std::log(growth.radius) / above.macro_step());
}

TEST(CycleMap, KrylovSpaceAgreesWithDenseEigenvalues) {
  for (const bool nested : {true, false})
    for (const std::string& cycle : sharing_cycles())
      for (const double over : {1.0, 2.5}) {
        const Map map(clamped(cycle, over, nested));
        const double dense = spectral_radius(map.matrix());
        const CycleGrowth growth = cycle_growth(map, {.macro_steps = 5000});
        EXPECT_NEAR(growth.radius, dense, growth.converged ? 1e-5 * dense : 3e-3)
            << cycle << over << nested;
        EXPECT_LE(std::abs(growth.radius - dense), 10 * growth.uncertainty + 1e-5 * dense)
            << cycle << over << nested;
      }
}

// The rest's state is all there is to a cycle: what it carries beside it from cycle to cycle does
// not matter.
TEST(CycleMap, IsWhatCyclesDoStepAfterStep) {
  for (const bool nested : {true, false})
    for (const std::string& cycle : sharing_cycles()) {
      Problem p = clamped(cycle, 0.8, nested);
      p.body.material.model = "linear";
      const Map map(p);
      Eigen::VectorXd x = Eigen::VectorXd::Random(map.size()) * 1e-3;
      const TetMesh& mesh = p.body.levels[0];
      std::vector<Point> u(mesh.vertices.size(), Point::Zero()), v = u;
      Eigen::Index i = 0;
      for (std::size_t a = 0; a < u.size(); ++a)
        for (int k = 0; k < 3 && mesh.vertices[a][0] > 0; ++k, ++i)
          u[a][k] = x[i], v[a][k] = x[i + map.size() / 2] / map.macro_step();
      ASSERT_EQ(i, map.size() / 2);
      Simulation<Host> simulation(p);
      simulation.set_state(u, v);
      for (int n = 0; n < 6; ++n) simulation.step(), x = map.apply(x);
      const auto end = displacements(simulation, mesh);
      i = 0;
      double difference = 0;
      for (std::size_t a = 0; a < u.size(); ++a)
        for (int k = 0; k < 3 && mesh.vertices[a][0] > 0; ++k, ++i)
          difference = std::max(difference, std::abs(end[a][k] - x[i]));
      // the threshold of rsv is 0.1 edges here, 1 cm: far away
      EXPECT_LE(difference, 1e-11 * x.norm() + 1e-15) << cycle << nested;
    }
}

// However fast it grows on the way.
TEST(CycleMap, NeverSwitches) {
  const CycleGrowth switched = cycle_growth(Map(clamped("rsv", 6, true))),
                    variation = cycle_growth(Map(clamped("rv", 6, true)));
  EXPECT_GT(variation.radius, 10);
  EXPECT_NEAR(switched.radius, variation.radius, 1e-6 * variation.radius);
}

TEST(CycleMap, FasGrowsALittleEvenWhereEveryLevelIsStable) {
  const double radius = spectral_radius(Map(clamped("fas", 1, true)).matrix());
  EXPECT_GT(radius, 1 + 1e-5);
  EXPECT_LT(radius, 1.05);
}

TEST(CycleMap, ImplicitCoarsestLevelMakesFasStable) {
  Problem p = clamped("fas", 1.5, true);
  p.integration.integrator = {"symplectic_euler", "implicit_euler"};
  EXPECT_LE(spectral_radius(Map(p).matrix()), 1 + 1e-9);
}

TEST(CycleMap, LeavesOutWhatIsNotLinearAndKeepsTheStep) {
  const Problem plain = clamped("rsv", 1, true);
  Problem p = plain;
  p.gravity = {0, 0, -9.81};
  p.body.material.model = "neo_hookean";
  p.body.surface = TriangleSurface{{{0.4, 0, 0}, {0.4, 0.1, 0}, {0.4, 0, 0.1}}, {{0, 1, 2}}};
  // touching, and it moves
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, 0.05}, {0, 0, 1}}, 0.2, {}});
  p.contact.obstacles[0].motion = SteadyMotion{Point(0, 0, 1)};
  p.body.loads.push_back({Box{{0.3, 0, 0}, {0.4, 1, 1}}, TotalForce{Point(1, 2, 3)}, {}});
  p.body.prescribed.push_back({left_face(), SteadyMotion{Point(1, 0, 0)}});
  p.body.fixed.clear();
  p.body.initial.velocity = {1, 1, 1};
  p.integration.distribution = "custom", p.integration.shares = {0.5, 0.5};
  Problem same = plain;
  same.integration.distribution = "equal";
  const Map a(p), b(same);
  EXPECT_EQ(a.macro_step(), *p.integration.macro_step);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_LE((a.matrix() - b.matrix()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(CycleMap, RefusesABodyThatCannotMove) {
  Problem p = clamped("single", 1, true);
  p.body.fixed = {Box{{-1, -1, -1}, {1, 1, 1}}};
  EXPECT_THROW(Map{p}, InputError);
}

}  // namespace
