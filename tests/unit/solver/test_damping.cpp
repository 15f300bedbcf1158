// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <plica/drivers/study/level_probe.hpp>
#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Rayleigh damping: its forces, what it does to motion, and what it takes from the explicit limits.
namespace {

using namespace plica;
using namespace plica::test;

Problem two_halves(const std::string& material) {
  Problem p = body_of({with_regions(jittered_box(decimetre, {3, 3, 3}), 0.05, "left", "right")}, material);
  p.body.regions["left"] = {}, p.body.regions["right"] = {};
  return p;
}

template <class B>
class Damping : public testing::Test {};
TYPED_TEST_SUITE(Damping, EachBackend);

TYPED_TEST(Damping, ByStiffnessIsItsPartOfTheTangent) {
  for (const std::string& material : names(materials())) {
    Problem p = two_halves(material);
    const std::size_t n = p.body.levels[0].vertices.size();
    const auto u = random_field(n, 2e-3, 1), v = random_field(n, 1, 2);
    LevelProbe<TypeParam> plain(p);
    const auto elastic = plain.force(u), Kv = plain.stiffness(u, v);
    p.body.damping.stiffness = 2e-3;
    LevelProbe<TypeParam> damped(p);
    const auto f = damped.force(u, v);
    for (std::size_t a = 0; a < n; ++a)
      EXPECT_LE((f[a] - elastic[a] + 2e-3 * Kv[a]).norm(), round_off<typename TypeParam::Real>(100, largest(f)))
          << material;
  }
}

TEST(RegionDamping, IsOfItsElements) {
  Problem p = two_halves("linear");
  p.body.damping = {4, 0};
  p.body.regions["right"].damping = {10, 1e-3};
  LevelProbe<Host> probe(p);
  const auto& model = probe.at(0).model;
  const auto& x = p.body.levels[0].vertices;
  for (std::size_t a = 0; a < x.size(); ++a) {
    const double c = model.damping(static_cast<int>(a));
    if (x[a][0] < 1e-9) {
      EXPECT_NEAR(c, 4, 1e-12);
    }
    if (x[a][0] > 0.1 - 1e-9) {
      EXPECT_NEAR(c, 10, 1e-12);
    }
    EXPECT_GE(c, 4 - 1e-12);
    EXPECT_LE(c, 10 + 1e-12);
  }
  const auto v = random_field(x.size(), 1, 3), zero = probe.zero();
  const auto f = probe.force(zero, v);  // nothing but the damping of the right half
  for (std::size_t a = 0; a < x.size(); ++a)
    if (x[a][0] < 1e-9) {
      EXPECT_EQ(f[a].norm(), 0);
    }
  EXPECT_GT(largest(f), 0);
}

// The largest h with lambda_max(h^2 K + h r D) <= r^2, D the stiffness of each region times its own damping.
TEST(StiffnessDamping, LowersTheLimitAsPredicted) {
  for (const char* integrator : {"symplectic_euler", "central_difference", "rk4"}) {
    Problem p = two_halves("linear");
    p.integration.integrator = {integrator};
    const double radius = std::string(integrator) == "rk4" ? 2.78 : 2;
    const double undamped = Simulation<Host>(p).levels()[0].critical_step;
    p.body.regions["right"].damping.stiffness = 0.5 * undamped;
    LevelProbe<Host> probe(p);
    const double predicted = probe.built.reports[0].critical_step;
    const Eigen::MatrixXd K = probe.scaled_by_mass(probe.stiffness_matrix(probe.zero()));
    Eigen::MatrixXd D(3 * probe.vertices(), 3 * probe.vertices());
    std::vector<Point> v = probe.zero();
    for (Eigen::Index j = 0; j < D.cols(); ++j) {
      v[static_cast<std::size_t>(j / 3)][j % 3] = 1;
      const auto f = probe.force(probe.zero(), v);
      v[static_cast<std::size_t>(j / 3)][j % 3] = 0;
      for (Eigen::Index r = 0; r < D.rows(); ++r) D(r, j) = -f[static_cast<std::size_t>(r / 3)][r % 3];
    }
    const Eigen::MatrixXd S = predicted * predicted * K + predicted * radius * probe.scaled_by_mass(D);
    const double top =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
    EXPECT_LE(top, 1.001 * radius * radius) << integrator;
    EXPECT_GE(top, 0.95 * radius * radius) << integrator;
    EXPECT_LT(predicted, 0.9 * undamped) << integrator;
  }
}

// Integrators that grow undamped are stable with damping just below the predicted limit, and not well above it.
TEST(Damping, HoldsWhatGrows) {
  for (const char* integrator : {"euler", "rk2"}) {
    Problem p = small_cube("linear");
    p.body.damping.mass = 40, p.integration.substeps = {1};
    p.integration.integrator = {integrator}, p.integration.allow_unstable = true;
    const double limit = Simulation<Host>(p).levels()[0].critical_step;
    ASSERT_GT(limit, 0);
    for (const double part : {0.97, 1.5}) {
      p.integration.macro_step = part * limit;
      Simulation<Host> simulation(p);
      simulation.set_state(random_field(p.body.levels[0].vertices.size(), 1e-6, 5),
                           std::vector<Point>(p.body.levels[0].vertices.size(), Point::Zero()));
      const double before = simulation.energies().total();
      for (int n = 0; n < static_cast<int>(20 / (part * limit * 40)); ++n) simulation.step();
      EXPECT_EQ(simulation.energies().total() < before, part < 1) << integrator << " " << part;
    }
  }
}

// A mode's amplitude decays like exp(-(c + b w^2) t / 2).
TEST(Damping, DecaysAsRayleighSays) {
  for (const std::string& integrator : names(integrators())) {
    Problem p = small_cube("linear", 2);
    LevelProbe<Host> probe(p);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(
        probe.scaled_by_mass(probe.stiffness_matrix(probe.zero())));
    const double w = std::sqrt(modes.eigenvalues()[8]);  // beyond the six rigid ones
    const auto mass = probe.mass();
    std::vector<Point> shape = probe.zero();
    for (std::size_t a = 0; a < shape.size(); ++a)
      for (int k = 0; k < 3; ++k)
        shape[a][k] = 1e-4 * modes.eigenvectors()(static_cast<Eigen::Index>(3 * a) + k, 8) / std::sqrt(mass[a]);
    p.body.damping = {0.02 * w, 0.02 / w};
    p.integration.integrator = {integrator}, p.integration.allow_unstable = true;
    const double h = 5e-4 * 2 * M_PI / w;
    p.integration.macro_step = h, p.integration.implicit.relative_residual = 1e-10;
    Simulation<Host> simulation(p);
    simulation.set_state(shape, probe.zero());
    const double before = simulation.energies().total();
    for (int n = 0; n < 2000; ++n) simulation.step();  // one period
    const double decay = -std::log(simulation.energies().total() / before);
    EXPECT_NEAR(decay, 0.04 * 2 * M_PI, 0.1 * 0.04 * 2 * M_PI) << integrator;
  }
}

}  // namespace
