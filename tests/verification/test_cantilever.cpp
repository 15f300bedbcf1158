// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/study/free_vibration.hpp>
#include <plica/drivers/study/sparse_stiffness.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// A clamped beam against direct solves on the same mesh, and against beam theory.
namespace {

using namespace plica;
using namespace plica::test;

Problem beam(const std::string& material) {
  Problem p = body_of({jittered_box(beam_box, {12, 3, 3})}, material);
  p.body.material.young_modulus = 1e5, p.body.material.poisson_ratio = 0.3;
  p.body.fixed = {left_face()};
  return p;
}

std::vector<Point> weight(const LevelProbe<Host>&, const std::vector<double>& mass, const Point& g) {
  std::vector<Point> f;
  for (double m : mass) f.push_back(m * g);
  return f;
}

double relative(const std::vector<Point>& a, const std::vector<Point>& b) {
  return largest_difference(a, b) / largest(b);
}

std::vector<Point> settled(Problem p, const std::string& integrator, double step, double damping, double time) {
  p.integration.integrator = {integrator};
  p.integration.macro_step = step;
  p.body.damping.mass = damping;
  p.integration.implicit.relative_residual = 1e-6;
  Simulation<Host> simulation(p);
  advance(simulation, static_cast<int>(time / step));
  EXPECT_LT(largest(simulation.velocities()), 1e-6);
  return displacements(simulation, p.body.levels[0]);
}

TEST(Cantilever, LinearSagIsTheDirectSolution) {
  Problem p = beam("linear");
  p.gravity = {0, 0, -2};
  LevelProbe<Host> probe(p);
  const auto sag = SparseStiffness(probe).equilibrium(weight(probe, probe.mass(), p.gravity));
  EXPECT_LE(relative(settled(p, "implicit_euler", 2.0, 0, 60), sag), 1e-5);
  EXPECT_LE(relative(settled(p, "symplectic_euler", 1e-3, 15, 4), sag), 1e-4);
  // own weight: rho A g L^4 / 8 E I, of which coarse linear tetrahedra lock away a part
  const double tip = 1000 * 2 * std::pow(0.4, 4) / (8 * 1e5 * 0.1 * 0.1 / 12);
  EXPECT_NEAR(largest(sag), tip, 0.35 * tip);
}

TEST(Cantilever, NonlinearSagBalancesEveryVertex) {
  for (const char* material : {"st_venant_kirchhoff", "corotational", "neo_hookean"}) {
    Problem p = beam(material);
    p.gravity = {0, 0, -9.81};
    const auto u = settled(p, "implicit_euler", 0.05, 12, 5);
    EXPECT_GT(largest(u), 0.05) << material;
    LevelProbe<Host> probe(p);
    const auto f = probe.force(u);
    const auto inverse = probe.inverse_mass();
    for (std::size_t a = 0; a < f.size(); ++a)
      if (inverse[a] > 0) {
        EXPECT_LE(f[a].norm(), 1e-4 * 4 * 9.81) << material;  // of the whole weight
      }
  }
}

// Coarse levels pull to their own sag; a fine level alone must not.
TEST(Cantilever, SingleCycleOfALevelHierarchyIsTheFineSag) {
  Problem p = beam("linear");
  p.body.levels.push_back(jittered_box(beam_box, {6, 2, 2}));
  p.gravity = {0, 0, -2};
  LevelProbe<Host> probe(p);
  const auto sag = SparseStiffness(probe).equilibrium(weight(probe, probe.mass(), p.gravity));
  EXPECT_LE(relative(settled(p, "implicit_euler", 2.0, 0, 60), sag), 1e-5);
}

TEST(Cantilever, FirstBendingFrequencyIsTheEigenvalues) {
  Problem p = beam("linear");
  LevelProbe<Host> probe(p);
  const SparseStiffness K(probe);
  std::vector<Point> shape;
  for (const Point& x : p.body.levels[0].vertices) shape.push_back({0, 0, x[0] * x[0]});
  const double f = K.lowest_frequency(shape);
  // 1.8751^2 / (2 pi L^2) sqrt(E I / rho A); short and coarse: shear lowers it, locking raises it
  const double slender = 1.8751 * 1.8751 / (2 * M_PI * 0.16) * std::sqrt(1e5 * 0.01 / 12 / 1000);
  EXPECT_NEAR(f, slender, 0.25 * slender);
  for (const char* integrator : {"symplectic_euler", "rk4"}) {
    p.integration.integrator = {integrator};
    EXPECT_NEAR(frequency_of_motion(p, shape, 1e-3, 3, f), f, 1e-3 * f) << integrator;
  }
  for (const char* material : {"st_venant_kirchhoff", "corotational", "neo_hookean"}) {  // the same for small motion
    p.body.material.model = material, p.integration.integrator = {"symplectic_euler"};
    EXPECT_NEAR(frequency_of_motion(p, shape, 1e-5, 3, f), f, 2e-3 * f) << material;
  }
}

// Axial: without lateral strain (nu = 0) the mesh is a bar, f = sqrt(E / rho) / 4 L.
TEST(Bar, FirstAxialFrequency) {
  Problem p = body_of({box_mesh(beam_box, {32, 2, 2})}, "linear");
  p.body.material.young_modulus = 1e5, p.body.material.poisson_ratio = 0;
  p.body.fixed = {left_face()};
  const double want = std::sqrt(1e5 / 1000) / (4 * 0.4);
  std::vector<Point> shape;
  for (const Point& x : p.body.levels[0].vertices) shape.push_back({std::sin(M_PI / 2 * x[0] / 0.4), 0, 0});
  EXPECT_NEAR(frequency_of_motion(p, shape, 1e-4, 3, want), want, 0.005 * want);
}

// Under its own weight, hung at one end: u = rho g x (L - x/2) / E with nu = 0. The mesh shares mass out unevenly within a
// cross-section, so that the mean over each is what is exact.
TEST(Bar, StretchUnderItsOwnWeight) {
  Problem p = body_of({box_mesh(beam_box, {16, 2, 2})}, "linear");
  p.body.material.young_modulus = 1e5, p.body.material.poisson_ratio = 0;
  p.body.fixed = {left_face()};
  p.gravity = {9.81, 0, 0};
  const auto u = settled(p, "implicit_euler", 1.0, 0, 30);
  LevelProbe<Host> probe(p);
  const auto m = probe.mass();
  const double longest = 1000 * 9.81 * 0.4 * 0.2 / 1e5;
  std::map<long, std::array<double, 2>> sections;
  for (std::size_t a = 0; a < u.size(); ++a) {
    auto& section = sections[std::lround(p.body.levels[0].vertices[a][0] / 0.025)];
    section[0] += m[a] * u[a][0], section[1] += m[a];
  }
  EXPECT_EQ(sections.size(), 17u);
  for (const auto& [i, section] : sections) {
    const double x = 0.025 * static_cast<double>(i);
    EXPECT_NEAR(section[0] / section[1], 1000 * 9.81 * x * (0.4 - x / 2) / 1e5, 0.01 * longest) << x;
  }
}

}  // namespace
