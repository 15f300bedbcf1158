// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/cycles/him.hpp>
#include <plica/drivers/solver/set_up/lumped_masses.hpp>
#include <plica/kernels/materials/material.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/level_probe.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// The hierarchical inverse mass: what A is, what it conserves, whose equilibrium it keeps, when it gives in.
namespace {

using namespace plica;
using namespace plica::test;

Problem beam(const std::string& cycle, bool nested, const std::string& material = "linear") {
  std::vector<TetMesh> levels = {box_mesh(beam_box, {8, 4, 4})};
  levels.push_back(nested ? box_mesh(beam_box, {4, 2, 2}) : jittered_box(beam_box, {5, 3, 3}));
  levels.push_back(nested ? box_mesh(beam_box, {2, 1, 1}) : jittered_box(beam_box, {3, 2, 2}));
  Problem p = body_of(std::move(levels), material);
  p.integration.cycle = cycle;
  return p;
}

/// Level 0, the inverse mass above it and its fit, put together by hand.
struct Pieces {
  explicit Pieces(const Problem& problem)
      : levels(problem.body.levels), probe([&] {
          Problem alone = problem;
          alone.integration.cycle = "single", alone.integration.macro_step = 1e-9;
          return alone;
        }()) {
    const Level<Host>& level = probe.at(0).level;
    std::vector<std::vector<char>> constrained;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      constrained.emplace_back(levels[i].vertices.size(), 0);
      for (std::size_t a = 0; a < levels[i].vertices.size() && !problem.body.fixed.empty(); ++a)
        constrained[i][a] = levels[i].vertices[a][0] < 1e-9;
      up.push_back(i == 0 ? Embedding{} : embed(levels[i - 1].vertices, levels[i], Outside::extrapolate));
    }
    std::vector<MassMesh> meshes;
    for (std::size_t i = 0; i < levels.size(); ++i) meshes.push_back({levels[i], constrained[i], up[i]});
    const auto spaces = mass_spaces(meshes, probe.mass(), true);
    const MaterialOptions& m = problem.body.material;
    const auto lame = lame_constants(m.young_modulus, m.poisson_ratio);
    const Eigen::MatrixXd K = coarse_stiffness(levels[0], {{lame.lambda, lame.mu}}, to_finest(spaces));
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(K.rows(), K.cols());
    for (Eigen::Index a = 0; a < spaces.back().mass.rows(); ++a)
      for (RowMatrix::InnerIterator e(spaces.back().mass, a); e; ++e)
        for (int k = 0; k < 3; ++k) M(3 * a + k, 3 * e.col() + k) = e.value();
    inverse_mass = std::make_unique<InverseMass<Host>>(level, levels.front(), levels.back(), spaces);
    fitter = std::make_unique<InertiaFitter<Host>>(typename Host::Exec{}, level,
                                                   make_elasticity<Host>(problem.body.material.model), *inverse_mass,
                                                   CoarseModes(K, M));
  }

  Eigen::MatrixXd matrix() {
    const auto n = static_cast<Eigen::Index>(3 * levels[0].vertices.size());
    Eigen::MatrixXd A(n, n);
    std::vector<Point> f(levels[0].vertices.size(), Point::Zero());
    const Vectors<Host> a("a", f.size());
    for (Eigen::Index j = 0; j < n; ++j) {
      f[static_cast<std::size_t>(j / 3)][j % 3] = 1;
      inverse_mass->apply({}, device_field<Host>(f), a);
      f[static_cast<std::size_t>(j / 3)][j % 3] = 0;
      const auto column = to_host<Host>({}, a);
      for (Eigen::Index r = 0; r < n; ++r) A(r, j) = column[static_cast<std::size_t>(r / 3)][r % 3];
    }
    return A;
  }

  std::optional<InertiaFit> fit(double over_critical, double sigma = 0.8) {
    const Vectors<Host> rest("rest", levels[0].vertices.size());
    return fitter->fit(over_critical * fitter->critical_steps()[0], sigma, rest);
  }

  std::vector<TetMesh> levels;
  LevelProbe<Host> probe;
  std::vector<Embedding> up;
  std::unique_ptr<InverseMass<Host>> inverse_mass;
  std::unique_ptr<InertiaFitter<Host>> fitter;
};

TEST(InverseMass, IsSymmetricPositiveAndBoundedByTheMass) {
  for (const bool nested : {true, false}) {
    Pieces pieces(beam("him", nested));
    ASSERT_TRUE(pieces.fit(6));
    const Eigen::MatrixXd A = pieces.matrix();
    EXPECT_LE((A - A.transpose()).norm(), 1e-12 * A.norm());
    Eigen::VectorXd root(A.rows());
    const auto m = pieces.probe.mass();
    for (Eigen::Index k = 0; k < root.size(); ++k) root[k] = std::sqrt(m[static_cast<std::size_t>(k / 3)]);
    const Eigen::MatrixXd scaled = root.asDiagonal() * A * root.asDiagonal();
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues();
    EXPECT_GT(values.minCoeff(), 1e-6);
    EXPECT_LE(values.maxCoeff(), 1 + 1e-9);  // nothing gets lighter
    // a push that moves the body as a whole: close to its own mass
    Eigen::VectorXd push = Eigen::VectorXd::Zero(A.rows());
    for (Eigen::Index k = 0; k < push.size(); k += 3) push[k] = m[static_cast<std::size_t>(k / 3)];
    const Eigen::VectorXd a = A * push;
    for (Eigen::Index k = 0; k < push.size(); ++k) EXPECT_NEAR(a[k], k % 3 == 0 ? 1 : 0, 0.02);
  }
}

TEST(InverseMass, IsFittedToTheStepItsSpectrumAllows) {
  for (const bool nested : {true, false}) {
    Problem p = beam("him", nested);
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

// A is fixed, the step shrinks: the error of a linear swing falls like its square.
TEST(Him, IsOfSecondOrderAtAFixedInverseMass) {
  Problem p = beam("him", true);
  p.body.fixed = {left_face()};
  const auto end_after = [&](int steps) {
    Pieces pieces(p);
    HimParts<Host> parts;
    parts.options.dissipation = 0;
    const double duration = 10 * pieces.fitter->critical_steps()[0];
    parts.fit = pieces.fit(4).value();
    parts.inverse_mass = std::move(pieces.inverse_mass), parts.fitter = std::move(pieces.fitter);
    Hierarchy<Host>& h = *pieces.probe.built.hierarchy;
    const auto v = random_field(pieces.levels[0].vertices.size(), 0, 1);
    for (std::size_t a = 0; a < pieces.levels[0].vertices.size(); ++a)
      for (int k = 0; k < 3; ++k)
        h[0].level.state.u(a, k) = k == 2 ? 1e-4 * std::pow(pieces.levels[0].vertices[a][0] / 0.4, 2) : 0;
    HimCycle<Host> cycle(h, std::move(parts));
    cycle.begin(h);
    for (int n = 0; n < steps; ++n) cycle.step(h, n * duration / steps, duration / steps);
    return to_host<Host>(h.exec(), h[0].level.state.u);
  };
  const auto exact = end_after(640), coarse = end_after(10), fine = end_after(20);
  const double ratio = largest_difference(coarse, exact) / largest_difference(fine, exact);
  EXPECT_NEAR(std::log2(ratio), 2, 0.15);
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
  EXPECT_LE(largest_difference(him.velocities(), single.velocities()), 1e-10);
  auto x = single.positions();
  const auto v = single.velocities();
  for (std::size_t a = 0; a < x.size(); ++a) x[a] -= 0.5 * 3e-4 * v[a];
  EXPECT_LE(largest_difference(him.positions(), x), 1e-13);
}

template <class B>
class HimOnEachBackend : public testing::Test {};
TYPED_TEST_SUITE(HimOnEachBackend, EachBackend);

TYPED_TEST(HimOnEachBackend, KeepsTheMomentaOfAFreeBody) {
  using Real = typename TypeParam::Real;
  Problem p = beam("him", false, "corotational");
  p.body.initial.angular_velocity = {2, 5, -3};
  p.body.initial.velocity = {0.3, -0.2, 0.1};
  Simulation<TypeParam> simulation(p);
  const auto m = lumped_masses(p.body.levels[0], {p.body.material.density});
  const auto momenta = [&] {
    const auto x = simulation.positions(), v = simulation.velocities();
    std::pair<Point, Point> sum{Point::Zero(), Point::Zero()};
    for (std::size_t a = 0; a < v.size(); ++a) sum.first += m[a] * v[a], sum.second += m[a] * x[a].cross(v[a]);
    return sum;
  };
  const auto before = momenta();
  advance(simulation, 100);
  const auto after = momenta();
  EXPECT_LE((after.first - before.first).norm(), round_off<Real>(1000, before.first.norm()));
  EXPECT_LE((after.second - before.second).norm(), round_off<Real>(1000, before.second.norm()));
  EXPECT_GT((simulation.positions()[0] - p.body.levels[0].vertices[0]).norm(), 0.05);  // it did turn
}

// What hangs still under its weight does so as the finest level alone does.
TEST(Him, KeepsTheEquilibriumOfTheFinestLevel) {
  Problem p = beam("single", false, "neo_hookean");
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
  EXPECT_GT(largest(hanging), 0.01);
  him.set_state(hanging, std::vector<Point>(hanging.size(), Point::Zero()));
  advance(him, 200);
  EXPECT_LE(largest_difference(displacements(him, p.body.levels[0]), hanging), 1e-6 * largest(hanging));
}

TEST(Him, IsCloserToTheFinestLevelThanACoarserOne) {
  Problem p = beam("single", true, "corotational");
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
  const double error = std::abs(fall(p, 4e-3) / exact - 1), coarser = std::abs(fall(coarse, 5e-4) / exact - 1);
  EXPECT_LE(error, 0.02);
  EXPECT_GE(coarser, 5 * error);
}

TEST(Him, LosesNoStabilityUnnoticed) {
  Problem p = beam("him", true, "st_venant_kirchhoff");
  p.body.fixed = {left_face()};
  p.body.material.young_modulus = 15e3;
  p.body.material.poisson_ratio = 0.45;
  p.gravity = {-9.81, 0, -9.81};
  p.integration.him.sigma = 0.98;
  Simulation<Host> simulation(p);
  for (int n = 0; n < 400; ++n) {
    simulation.step();
    if (const auto bad = simulation.check()) {
      EXPECT_NE(bad->kind, "non_finite") << bad->text();
      return;
    }
  }
  EXPECT_GT(simulation.counters().at("inertia_refits"), 0);
}

TEST(Him, RefusesWhatItCannotDo) {
  const auto message = [](const auto& change) {
    Problem p = beam("him", true);
    p.body.fixed = {left_face()};
    change(p);
    try {
      const Simulation<Host> simulation(p);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto refuses = [&](const auto& change, const std::string& text) {
    EXPECT_NE(message(change).find(text), std::string::npos) << message(change);
  };
  EXPECT_EQ(message([](Problem&) {}), "accepted");
  refuses([](Problem& p) { p.integration.integrator = {"implicit_euler"}; },
          "implicit_euler, but cycle him steps level 0");
  refuses([](Problem& p) { p.integration.substeps = {4}; }, "substeps is 4, but cycle him");
  refuses([](Problem& p) { p.integration.distribution = "equal"; }, "distribution is equal, but cycle him");
  refuses([](Problem& p) { p.integration.shift_to_coarsest = 0.5; }, "shift_to_coarsest");
  refuses([](Problem& p) { p.integration.outside = "keep"; }, "outside is keep");
  refuses([](Problem& p) { p.integration.him.sigma = 1; }, "him.sigma");
  refuses([](Problem& p) { p.integration.him.dissipation = 1; }, "him.dissipation");
  refuses([](Problem& p) { p.body.levels.resize(1), p.integration.macro_step = 10; }, "no inertia makes it stable");
  refuses([](Problem& p) { p.body.levels.back() = box_mesh(beam_box, {40, 8, 8}); }, "expected at most 1500");
}

}  // namespace
