// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/verify.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/tolerance.hpp"

// How rows are judged, and the direct solvers behind them.
namespace {

using namespace plica;
using namespace plica::test;

VerifyRow row_of(Judged judged, std::optional<double> accepted, double tolerance,
                 std::vector<double> values) {
  VerifyRow row;
  row.judged = judged, row.accepted = accepted, row.tolerance = tolerance;
  double size = 1;
  for (const double value : values) row.add("mesh", size, value), size /= 2;
  judge(row);
  return row;
}

TEST(Judge, TheFinestValueAndItsOrder) {
  const VerifyRow row = row_of(Judged::finest, 10, 0.01, {11.28, 10.32, 10.08});
  EXPECT_EQ(row.outcome, "ok");
  EXPECT_NEAR(*row.order, 2, 1e-9);
  EXPECT_FALSE(row.limit);
  EXPECT_EQ(row_of(Judged::finest, 10, 0.007, {11.28, 10.32, 10.08}).outcome, "not ok");
  EXPECT_FALSE(row_of(Judged::finest, 10, 0.01, {10.01, 10.02, 10.02}).order);
}

TEST(Judge, WhatTheValuesTendTo) {
  const VerifyRow row = row_of(Judged::limit, 10, 1e-9, {11.28, 10.32, 10.08});
  EXPECT_EQ(row.outcome, "ok");
  EXPECT_NEAR(*row.limit, 10, 1e-9);
  EXPECT_NEAR(*row.order, 2, 1e-9);
  EXPECT_EQ(row_of(Judged::limit, 10.1, 1e-3, {11.28, 10.32, 10.08}).outcome, "not ok");
  EXPECT_EQ(row_of(Judged::limit, 10, 1, {10.32, 11, 10.08}).outcome, "not ok")
      << "they tend to nothing";
  EXPECT_EQ(row_of(Judged::limit, 10, 1, {10.3, 10.1}).outcome, "not ok") << "two do not tell";
}

TEST(Judge, DeflectionsAreExtrapolatedAsStiffnesses) {
  VerifyRow row;
  row.judged = Judged::limit, row.accepted = 0.5, row.tolerance = 1e-9, row.power = -1;
  for (const double h : {1.0, 0.5, 0.25}) row.add("mesh", h, 1 / (2 + 3 * h * h));
  judge(row);
  EXPECT_EQ(row.outcome, "ok");
  EXPECT_NEAR(*row.order, 2, 1e-9);
}

TEST(Judge, SizesOrdersAndWhatStaysAbove) {
  EXPECT_EQ(row_of(Judged::size, {}, 1e-9, {1e-10, -1e-10}).outcome, "ok");
  EXPECT_EQ(row_of(Judged::size, {}, 1e-9, {-1e-8, 1e-10}).outcome, "not ok");
  EXPECT_EQ(row_of(Judged::size, {}, 1e-9, {std::nan("")}).outcome, "not ok");
  EXPECT_EQ(row_of(Judged::order, 2, 0.1, {4, 1}).outcome, "ok");
  EXPECT_EQ(row_of(Judged::order, 2, 0.1, {4, 2}).outcome, "not ok");
  EXPECT_EQ(row_of(Judged::order, 2, 0.1, {4}).outcome, "not ok");
  EXPECT_EQ(row_of(Judged::above, 1, 0, {1.5, 1.2}).outcome, "ok");
  EXPECT_EQ(row_of(Judged::above, 1, 0, {1.5, 0.9}).outcome, "not ok");
  EXPECT_EQ(row_of(Judged::above, 1, 0, {1.2, 1.5}).outcome, "not ok");
  EXPECT_EQ(row_of(Judged::nothing, 1, 0, {5, 7}).outcome, "shown");
  EXPECT_EQ(row_of(Judged::finest, 1, 1, {}).outcome, "not ok") << "nothing was measured";
}

TEST(Verify, OneWrongRowMakesItWrong) {
  VerifyResult result;
  result.rows = {row_of(Judged::nothing, 1, 0, {5}), row_of(Judged::size, {}, 1, {0})};
  EXPECT_TRUE(result.ok());
  result.rows.push_back(row_of(Judged::size, {}, 1, {2}));
  EXPECT_FALSE(result.ok());
}

TEST(Verify, AnUnknownProblemIsAnErrorWithTheNearest) {
  const std::string text = refusal([] { verify({{"cook_membrain"}, true}); });
  EXPECT_NE(text.find("cook_membrane"), std::string::npos) << text;
}

TEST(Verify, RunsWhatIsAskedForAndStopsWhenTold) {
  const VerifyResult one = verify({{"uniaxial_tension"}, true});
  ASSERT_EQ(one.rows.size(), 2U);
  EXPECT_EQ(one.rows[0].problem, "uniaxial_tension");
  EXPECT_NEAR(one.rows[0].ours.at(0).value, 1e-3, 1e-13);
  int calls = 0;
  const VerifyResult none = verify({{}, true}, [&](const VerifyProgress&) { return ++calls < 1; });
  EXPECT_TRUE(none.stopped);
  EXPECT_TRUE(none.rows.empty());
  EXPECT_EQ(calls, 1);
}

TEST(LowestEigenvalues, AreTheDenseOnes) {
  const Eigen::MatrixXd R = Eigen::MatrixXd::Random(80, 80),
                        A = R * R.transpose() + Eigen::MatrixXd::Identity(80, 80);
  const Eigen::LLT<Eigen::MatrixXd> solver(A);
  const auto found = lowest_eigenvalues(
      [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return solver.solve(x); }, 80, 5);
  const Eigen::VectorXd want = symmetric_eigenvalues(A);
  ASSERT_EQ(found.size(), 5U);
  for (Eigen::Index i = 0; i < 5; ++i)
    EXPECT_NEAR(found[static_cast<std::size_t>(i)], want[i], 1e-8 * want[i]);
}

TEST(LowestEigenvalues, OfASmallMatrixAreAllThereAre) {
  const Eigen::Vector3d values(2, 5, 7);
  const auto inverse = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return x.cwiseQuotient(values);
  };
  const auto all = lowest_eigenvalues(inverse, 3, 5);
  ASSERT_EQ(all.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(all[i], values[static_cast<Eigen::Index>(i)], 1e-12);
  EXPECT_NEAR(lowest_eigenvalues(inverse, 3, 1).at(0), 2, 1e-9);
}

TEST(SparseStiffness, IsTheDenseOneWithoutWhatIsHeld) {
  Problem p = small_cube("neo_hookean");
  p.body.fixed = {left_face()};
  LevelProbe<Host> probe(p);
  const auto u = random_field(probe.vertices(), 0.002, 1);
  SparseStiffness K(probe, [](const Point&, int axis) { return axis == 2; });
  K.linearise(u);
  const Eigen::MatrixXd all = probe.stiffness_matrix(u), ours = K.matrix();
  std::vector<int> kept;
  for (const int dof : probe.free())
    if (dof % 3 != 2) kept.push_back(dof);
  EXPECT_LE((ours - all(kept, kept)).cwiseAbs().maxCoeff(),
            round_off<double>(100, all.cwiseAbs().maxCoeff()));
}

TEST(StaticEquilibrium, BalancesALargeLoad) {
  Problem p = small_cube("st_venant_kirchhoff");
  p.body.fixed = {left_face()};
  p.gravity = {0, 0, -40};
  LevelProbe<Host> probe(p);
  const auto u = static_equilibrium(probe, {});
  EXPECT_GT(largest(u), 0.01);
  const auto f = probe.force(u);
  const auto inverse = probe.inverse_mass();
  for (std::size_t a = 0; a < f.size(); ++a)
    if (inverse[a] > 0) {
      EXPECT_LE(f[a].norm(), 1e-9 * 40);
    }
}

}  // namespace
