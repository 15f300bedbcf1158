// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/critical_step.hpp>
#include <plica/drivers/solver/set_up/plan_steps.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/tolerance.hpp"

// The predicted critical step against dense eigenvalues of the same matrices.
namespace {

using namespace plica;
using namespace plica::test;

double largest_eigenvalue_of(const Eigen::MatrixXd& S) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

/// W^T W over all degrees of freedom
Eigen::MatrixXd point_matrix(LevelProbe<Host>& probe) {
  const auto& s = probe.at(0).surface;
  const auto n = static_cast<Eigen::Index>(3 * probe.vertices());
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(3 * s.points, n);
  for (int p = 0; p < s.points; ++p)
    for (int c = 0; c < 4; ++c)
      for (int k = 0; k < 3; ++k) W(3 * p + k, 3 * s.embedding.source(p, c) + k) += s.embedding.weight(p, c);
  return W.transpose() * W;
}

/// The largest h with lambda_max(h^2 (K + k W^T W) + radius h d W^T W) <= radius^2, by bisection on dense matrices.
double dense_limit(LevelProbe<Host>& probe, double radius) {
  const Eigen::MatrixXd K = probe.scaled_by_mass(probe.stiffness_matrix(probe.zero()));
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(K.rows(), K.cols());
  double k = 0, d = 0;
  if (const auto* contact = probe.at(0).contact()) {
    C = probe.scaled_by_mass(point_matrix(probe));
    k = contact->stiffness(), d = contact->damping();
  }
  double low = 0, high = 1.01 * radius / std::sqrt(largest_eigenvalue_of(K));
  for (int i = 0; i < 20; ++i) {
    const double h = 0.5 * (low + high);
    (largest_eigenvalue_of(h * h * (K + k * C) + radius * h * d * C) <= radius * radius ? low : high) = h;
  }
  return low;
}

/// Within 2 % of the dense limit, and never above it.
void expect_limit(const Problem& problem, double radius) {
  LevelProbe<Host> probe(problem);
  const double predicted = probe.built.reports[0].critical_step, dense = dense_limit(probe, radius);
  EXPECT_LE(predicted, 1.001 * dense);
  EXPECT_GE(predicted, 0.98 * dense);
  EXPECT_LE(
      probe.built.reports[0].element_bound * radius / 2,
      1.001 * radius / std::sqrt(largest_eigenvalue_of(probe.scaled_by_mass(probe.stiffness_matrix(probe.zero())))));
}

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
  try {
    const Simulation<Host> simulation(p);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("element " + std::to_string(worst.element) + " (region right)"),
              std::string::npos)
        << e.what();
  }
}

TEST(CriticalStep, NearTheIncompressibleLimit) {
  Problem p = small_cube("linear");
  p.body.material.poisson_ratio = 0.499;
  expect_limit(p, 2);
}

TEST(CriticalStep, WithContact) {
  using Scales = std::array<double, 2>;
  for (const auto& [stiffness, damping] : {Scales{1, 0}, Scales{1, 1}, Scales{0.1, 20}, Scales{30, 20}}) {
    SCOPED_TRACE(std::to_string(stiffness) + " " + std::to_string(damping));
    expect_limit(touching_cube(stiffness, damping), 2);
  }
}

TEST(CriticalStep, OfEulerIsDampingOverSquaredFrequency) {
  Problem p = small_cube("linear");
  p.integration.integrator = {"euler"};
  p.integration.allow_unstable = true;
  p.integration.macro_step = 1e-6;
  p.body.damping.mass = 5;
  LevelProbe<Host> probe(p);
  const double w2 = largest_eigenvalue_of(probe.scaled_by_mass(probe.stiffness_matrix(probe.zero())));
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

}  // namespace
