// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <plica/core/error.hpp>
#include <plica/drivers/cycles/him/him_stepper.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>

#include "support/him_pieces.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// The hierarchical inverse mass: what A is, whose equilibrium it keeps, when it gives in.
namespace {

using namespace plica;
using namespace plica::test;

TEST(InverseMass, IsSymmetricPositiveAndBoundedByTheMass) {
  for (const Problem& problem : {him_beam(true), him_beam(false), him_beam_alone()}) {
    Pieces pieces(problem);
    ASSERT_TRUE(pieces.fit(6));
    const Eigen::MatrixXd A = pieces.matrix();
    EXPECT_LE((A - A.transpose()).norm(), 1e-12 * A.norm());
    Eigen::VectorXd root(A.rows());
    const auto m = pieces.probe.mass();
    for (Eigen::Index k = 0; k < root.size(); ++k)
      root[k] = std::sqrt(m[static_cast<std::size_t>(k / 3)]);
    const Eigen::MatrixXd scaled = root.asDiagonal() * A * root.asDiagonal();
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly)
            .eigenvalues();
    EXPECT_GT(values.minCoeff(), 1e-3);
    EXPECT_LE(values.maxCoeff(), 1 + 1e-6);  // nothing gets lighter
    // a push that moves the body as a whole: close to its own mass
    Eigen::VectorXd push = Eigen::VectorXd::Zero(A.rows());
    for (Eigen::Index k = 0; k < push.size(); k += 3) push[k] = m[static_cast<std::size_t>(k / 3)];
    const Eigen::VectorXd a = A * push;
    for (Eigen::Index k = 0; k < push.size(); ++k) EXPECT_NEAR(a[k], k % 3 == 0 ? 1 : 0, 1e-5);
  }
}

TEST(InverseMass, IsFittedToTheStepItsSpectrumAllows) {
  for (const bool nested : {true, false}) {
    Problem p = him_beam(nested);
    p.body.fixed = {left_face()};
    Pieces pieces(p);
    const double t = 6 * pieces.fitter->critical_steps()[0];
    const auto fit = pieces.fit(6);
    ASSERT_TRUE(fit);
    const Eigen::MatrixXd K = pieces.probe.stiffness_matrix(pieces.probe.zero());
    const auto list = pieces.probe.free();
    const Eigen::MatrixXd A = pieces.matrix();
    const double largest = t * t * (A(list, list) * K(list, list)).eigenvalues().real().maxCoeff();
    EXPECT_LE(largest, fit->product * (1 + 1e-9));
    EXPECT_GE(largest, 0.95 * fit->product);
    EXPECT_LE(fit->product, 4 * 0.8 * 0.8);
    EXPECT_GE(fit->product, 0.85 * 4 * 0.8 * 0.8);  // and uses what it may
    EXPECT_GE(fit->bound, largest);
    ASSERT_EQ(fit->inertia.size(), 3u);
    EXPECT_GT(fit->inertia[0], fit->inertia[1]);
    EXPECT_EQ(fit->inertia[2], 1);
  }
}

TEST(InverseMass, LeavesOutNothingThatHasAWeight) {
  for (const Problem& problem : {him_beam(false), him_beam_alone()}) {
    Pieces pieces(problem);
    ASSERT_TRUE(pieces.fit(6));
    const auto levels = static_cast<std::size_t>(pieces.inverse_mass->levels());
    const auto with = [&](const std::vector<double>& weights) {
      pieces.inverse_mass->set_weights(weights);
      return pieces.matrix();
    };
    const Eigen::MatrixXd all = with(std::vector<double>(levels, 1.0));
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(all.rows(), all.cols());
    for (std::size_t i = 0; i < levels; ++i) {
      std::vector<double> alone(levels, 0.0);
      alone[i] = 1;
      const Eigen::MatrixXd part = with(alone);
      EXPECT_GT(part.norm(), 1e-3 * all.norm()) << "level " << i;
      sum += part;
    }
    EXPECT_LE((sum - all).norm(), 1e-12 * all.norm());
  }
}

TEST(InverseMass, HasTheLeastInertiaThatFits) {
  for (const double over_critical : {4.0, 6.0, 12.0}) {
    Pieces pieces(him_beam_alone());
    const double t = over_critical * pieces.fitter->critical_steps()[0];
    const Vectors<Host> rest("rest", pieces.levels[0].vertices.size());
    const auto fit = pieces.fitter->fit(t, 0.8, rest);
    ASSERT_TRUE(fit);
    ASSERT_LT(fit->scale, 1) << "or there is nothing to look for";
    EXPECT_LE(fit->product, 4 * 0.8 * 0.8);
    EXPECT_GE(fit->product, 0.93 * 4 * 0.8 * 0.8) << "scales are 4 % apart";
  }
}

// A is fixed, the step shrinks: the error of a linear swing falls like its square.
TEST(Him, IsOfSecondOrderAtAFixedInverseMass) {
  Problem p = him_beam(true);
  p.body.fixed = {left_face()};
  const auto end_after = [&](int steps) {
    Pieces pieces(p);
    HimParts<Host> parts;
    parts.rows = {0, static_cast<int>(pieces.levels[0].vertices.size())};
    HimOptions options;
    options.dissipation = 0;
    const double duration = 10 * pieces.fitter->critical_steps()[0];
    parts.fit = pieces.fit(4).value();
    parts.inverse_mass = std::move(pieces.inverse_mass), parts.fitter = std::move(pieces.fitter);
    Hierarchy<Host>& h = *pieces.probe.built.hierarchy;
    const auto v = random_field(pieces.levels[0].vertices.size(), 0, 1);
    for (std::size_t a = 0; a < pieces.levels[0].vertices.size(); ++a)
      for (int k = 0; k < 3; ++k)
        h[0].state.u(a, k) = k == 2 ? 1e-4 * std::pow(pieces.levels[0].vertices[a][0] / 0.4, 2) : 0;
    HimStepper<Host> cycle(h, options, std::move(parts));
    cycle.begin(h);
    for (int n = 0; n < steps; ++n) cycle.step(h, n * duration / steps, duration / steps);
    return to_host<Host>(h.exec(), h[0].state.u);
  };
  const auto exact = end_after(640), coarse = end_after(10), fine = end_after(20);
  const double ratio = largest_difference(coarse, exact) / largest_difference(fine, exact);
  EXPECT_NEAR(std::log2(ratio), 2, 0.01);
}

// Position Verlet: between its half drifts, one level does what symplectic Euler does.
TEST(Him, WithOneLevelIsCentralDifference) {
  Problem p = small_cube();
  const auto v0 = random_field(p.body.levels[0].vertices.size(), 0.3, 5);
  p.integration.macro_step = 3e-4, p.integration.him.dissipation = 0;
  p.integration.cycle = "him";
  Simulation<Host> him(p);
  p.integration.cycle = "single";
  Simulation<Host> single(p);
  const std::vector<Point> zero(v0.size(), Point::Zero());
  std::vector<Point> half = v0;
  for (Point& u : half) u *= 0.5 * 3e-4;
  him.set_state(zero, v0);
  single.set_state(half, v0);
  advance(him, 50), advance(single, 50);
  EXPECT_LE(largest_difference(him.velocities(), single.velocities()), 1e-13);
  auto x = single.positions();
  const auto v = single.velocities();
  for (std::size_t a = 0; a < x.size(); ++a) x[a] -= 0.5 * 3e-4 * v[a];
  EXPECT_LE(largest_difference(him.positions(), x), 1e-13);
}

// What hangs still under its weight does so as the finest level alone does.
TEST(Him, KeepsTheEquilibriumOfTheFinestLevel) {
  Problem p = him_beam(false, "neo_hookean");
  p.integration.cycle = "single";
  p.body.fixed = {left_face()};
  p.body.material.young_modulus = 200e3;
  p.body.damping.mass = 12;
  p.gravity = {0, 0, -9.81};
  Simulation<Host> single(p);
  advance(single, static_cast<int>(std::ceil(5 / single.macro_step())));
  p.integration.cycle = "him";
  Simulation<Host> him(p);
  ASSERT_GT(him.macro_step(), 4 * single.macro_step());
  const auto hanging = displacements(single, p.body.levels[0]);
  EXPECT_GT(largest(hanging), 0.1);
  him.set_state(hanging, std::vector<Point>(hanging.size(), Point::Zero()));
  advance(him, 200);
  EXPECT_LE(largest_difference(displacements(him, p.body.levels[0]), hanging),
            1e-11 * largest(hanging));
}

TEST(Him, IsCloserToTheFinestLevelThanACoarserOne) {
  Problem p = him_beam(true, "corotational");
  p.integration.cycle = "single";
  p.body.levels = {box_mesh(beam_box, {16, 4, 4}), box_mesh(beam_box, {8, 3, 3})};
  p.body.fixed = {left_face()};
  p.gravity = {0, 0, -9.81};
  p.body.material.young_modulus = 300e3;
  const auto mean_fall = [&](const Simulation<Host>& s, const TetMesh& rest) {
    const auto u = displacements(s, rest);
    double tip = 0;
    int count = 0;
    for (std::size_t a = 0; a < u.size(); ++a)
      if (rest.vertices[a][0] > 0.39999) tip += u[a][2], ++count;
    return tip / count;
  };
  const auto fall = [&](const Problem& q, double step) {
    Problem r = q;
    r.integration.macro_step = step;
    Simulation<Host> s(r);
    advance(s, static_cast<int>(std::lround(0.1 / step)));
    return mean_fall(s, q.body.levels[0]);
  };
  const double exact = fall(p, 1e-4);
  Problem coarse = p;
  coarse.body.levels = {p.body.levels[1]};
  p.integration.cycle = "him";
  const double error = std::abs(fall(p, 4e-3) / exact - 1),
               coarser = std::abs(fall(coarse, 5e-4) / exact - 1);
  EXPECT_LE(error, 2e-3);
  EXPECT_GE(coarser, 20 * error);
}

// A block on a slope, 30 degrees: with little friction it slides, with much it all but stays, as
// the finest level has it.
TEST(Him, SlidesAndHoldsAsTheFinestLevelDoes) {
  const auto way = [](const std::string& cycle, double friction) {
    Problem p =
        body_of({box_mesh(decimetre, {6, 6, 6}), box_mesh(decimetre, {4, 4, 4})}, "neo_hookean");
    p.body.material.young_modulus = 50e3;
    p.body.surface = boundary_surface(p.body.levels[0]).surface;
    p.gravity = {4.905, 0, -8.496};
    p.contact.obstacles.push_back({PlaneOptions{}, friction, {}});
    p.integration.cycle = cycle;
    if (cycle == "him") p.integration.macro_step = 4e-3;
    Simulation<Host> simulation(p);
    advance(simulation, static_cast<int>(std::lround(0.4 / simulation.macro_step())));
    Point mean = Point::Zero();
    const auto u = displacements(simulation, p.body.levels[0]);
    for (const Point& one : u) mean += one / static_cast<double>(u.size());
    return mean[0] / std::pow(simulation.time(), 2);
  };
  const double slides = way("single", 0.3), holds = way("single", 0.8);
  EXPECT_NEAR(way("him", 0.3), slides, 5e-3 * slides);  // 4e-3
  EXPECT_NEAR(way("him", 0.8), holds, 0.03 * slides);
  EXPECT_LT(holds, 0.4 * slides);
}

// The critical step of level 0 is its own, as every other cycle has it; contact changes neither
// that nor what the cycle goes by.
TEST(Him, ReportsTheCriticalStepOfTheLevel) {
  Problem p = him_beam(true, "neo_hookean");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.contact.obstacles.push_back({PlaneOptions{}, {}, {}});
  p.contact.stiffness_scale = 50;
  const Simulation<Host> him(p);
  p.integration.cycle = "single";
  const Simulation<Host> single(p);
  const auto& levels = him.levels();
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_EQ(levels[0].critical_step, single.levels()[0].critical_step);
  EXPECT_NEAR(levels[0].detail_step, levels[0].critical_step, 0.02 * levels[0].critical_step);
  EXPECT_GT(levels[1].detail_step, levels[0].detail_step);
  for (std::size_t i = 1; i < levels.size(); ++i)
    EXPECT_EQ(levels[i].critical_step, 0) << "it is not integrated";
  EXPECT_EQ(single.levels()[0].detail_step, 0);
}

// Where the body stiffens beyond what its inertia was fitted to, that is fitted anew, and the run
// goes on soundly.
TEST(Him, LosesNoStabilityUnnoticed) {
  Problem p = him_beam(true, "st_venant_kirchhoff");
  p.body.fixed = {left_face()};
  p.body.material.young_modulus = 15e3;
  p.body.material.poisson_ratio = 0.45;
  p.gravity = {-9.81, 0, -9.81};
  p.integration.him.sigma = 0.98;
  Simulation<Host> simulation(p);
  advance(simulation, 400);
  EXPECT_GT(simulation.counters().at("inertia_refits"), 0);
}

TEST(Him, TakesStepsFarBelowTheCriticalOne) {
  Problem p = him_beam(true);
  p.integration.macro_step = 1e-3 * Simulation<Host>(p).levels()[0].critical_step;
  EXPECT_EQ(Simulation<Host>(p).macro_step(), *p.integration.macro_step);
}

TEST(Him, RefusesWhatItCannotDo) {
  const auto message = [](const auto& change) {
    Problem p = him_beam(true);
    p.body.fixed = {left_face()};
    change(p);
    return refusal([&] { Simulation<Host>{p}; });
  };
  const auto refuses = [&](const auto& change, const std::string& text) {
    EXPECT_NE(message(change).find(text), std::string::npos) << message(change);
  };
  EXPECT_EQ(message([](Problem&) {}), "");
  refuses([](Problem& p) { p.integration.integrator = {"implicit_euler"}; },
          "implicit_euler, but cycle him steps level 0");
  refuses([](Problem& p) { p.integration.substeps = {4}; }, "substeps is 4, but cycle him");
  refuses([](Problem& p) { p.integration.distribution = "equal"; },
          "distribution is equal, but cycle him");
  refuses([](Problem& p) { p.integration.shift_to_coarsest = 0.5; }, "shift_to_coarsest");
  refuses([](Problem& p) { p.integration.outside = "keep"; }, "outside is keep");
  refuses([](Problem& p) { p.integration.him.sigma = 1; }, "him.sigma");
  refuses([](Problem& p) { p.integration.him.dissipation = 1; }, "him.dissipation");
  refuses([](Problem& p) { p.body.levels = {p.body.levels.back()}, p.integration.macro_step = 10; },
          "no inertia makes it stable");
  refuses(
      [](Problem& p) {
        p.body.levels.back() = box_mesh(beam_box, {40, 8, 8}), p.body.coarsen = {2000};
      },
      "it has 2000 points, expected at most 1500");
  refuses(
      [](Problem& p) {
        p.body.fixed = {Box{{-9, -9, -9}, {9, 9, 9}}};
      },
      "nothing is left to step");
}

}  // namespace
