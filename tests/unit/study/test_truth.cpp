// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <plica/core/error.hpp>
#include <plica/drivers/study/study.hpp>
#include <plica/drivers/study/truth.hpp>
#include <plica/meshes/jitter.hpp>

#include "support/bodies.hpp"

// The limit of refined meshes, and errors against it.
namespace {

using namespace plica;
using namespace plica::test;

// u + C h^order + D h^4 on edges of length h
Trajectory motion(double h, double order, double next = 0) {
  Trajectory t;
  t.times = {1, 2};
  for (const double time : t.times) {
    auto &u = t.u.emplace_back(), &v = t.v.emplace_back();
    for (int a = 0; a < 3; ++a) {
      u.push_back(Point(1, 2, a) * time + std::pow(h, order) * Point(0.3, a, -0.2) +
                  next * std::pow(h, 4) * Point(a, 1, 0));
      v.push_back(u.back() / time);
    }
  }
  return t;
}

const std::vector<int> all = {0, 1, 2};

TEST(RichardsonLimit, IsExactForOnePower) {
  for (const double order : {1.0, 1.5, 2.0}) {
    const Trajectory coarsest = motion(0.4, order);
    const Limit limit = richardson_limit(motion(0.1, order), motion(0.2, order), &coarsest, all);
    EXPECT_NEAR(*limit.order, order, 1e-9);
    EXPECT_NEAR(errors_of(limit.trajectory, motion(0, order)).displacement, 0, 1e-12);
    EXPECT_NEAR(errors_of(limit.trajectory, motion(0, order)).velocity, 0, 1e-12);
    EXPECT_NEAR(limit.own_error, 0, 1e-12);
    EXPECT_NEAR(limit.correction, errors_of(motion(0.1, order), motion(0, order)).displacement,
                1e-12);
  }
}

TEST(RichardsonLimit, ItsOwnErrorBoundsWhatTheNextPowerLeaves) {
  const Trajectory coarsest = motion(0.4, 2, 0.5);
  const Limit limit = richardson_limit(motion(0.1, 2, 0.5), motion(0.2, 2, 0.5), &coarsest, all);
  const double error = errors_of(limit.trajectory, motion(0, 2)).displacement;
  EXPECT_GT(error, 1e-6);
  EXPECT_GT(limit.own_error, error);
  EXPECT_LT(limit.own_error, limit.correction);
}

TEST(RichardsonLimit, AtVerticesThatTheCoarsestMeshHas) {
  Trajectory coarsest = motion(0.4, 2);
  for (auto* fields : {&coarsest.u, &coarsest.v})
    for (auto& field : *fields) field = {field[2], field[0]};
  EXPECT_NEAR(*richardson_limit(motion(0.1, 2), motion(0.2, 2), &coarsest, {2, 0}).order, 2, 1e-9);
}

TEST(RichardsonLimit, SaysWhereItIsNotToBeTrusted) {
  const Limit two = richardson_limit(motion(0.1, 2), motion(0.2, 2), nullptr, {});
  EXPECT_FALSE(two.order);
  EXPECT_EQ(two.own_error, two.correction);
  const Trajectory slow = motion(0.4, 0.3);
  const Limit limit = richardson_limit(motion(0.1, 0.3), motion(0.2, 0.3), &slow, all);
  EXPECT_NEAR(*limit.order, 0.3, 1e-9);
  EXPECT_EQ(limit.used_order, 1);
  EXPECT_EQ(limit.own_error, limit.correction);
  const Trajectory same = motion(0, 2);
  EXPECT_EQ(richardson_limit(same, same, &same, all).used_order, 2) << "no order at all";
}

// Vertex 0 is where no mesh has an error: its order is 0 / 0
TEST(RichardsonLimit, TrustsNoOrderThatIsNotANumber) {
  Trajectory fine = motion(0.1, 2), coarse = motion(0.2, 2), coarsest = motion(0.4, 2);
  for (Trajectory* each : {&fine, &coarse, &coarsest})
    for (auto& u : each->u) u[0] = Point(1, 0, 0);
  for (auto* fields : {&coarsest.u, &coarsest.v})
    for (auto& field : *fields) field.resize(1);
  const Limit limit = richardson_limit(fine, coarse, &coarsest, {0});
  EXPECT_TRUE(std::isnan(*limit.order));
  EXPECT_GT(limit.correction, 0);
  EXPECT_EQ(limit.own_error, limit.correction);
}

TEST(Truth, IsAsUncertainAsWhatItsCheckDoesNotExplain) {
  Truth truth;
  truth.family.own_error = 0.01, truth.check.own_error = 0.02, truth.difference = 0.025,
  truth.time_error = 0.001;
  EXPECT_DOUBLE_EQ(truth.error(), 0.011);
  truth.difference = 0.08;
  EXPECT_DOUBLE_EQ(truth.error(), 0.061);
  truth.difference = std::nan("");
  EXPECT_TRUE(std::isnan(truth.error())) << "a check that came to nothing explains nothing";
}

constexpr double bar_length = 0.4, bar_modulus = 1e4, bar_density = 1000, bar_load = 0.01;

// A bar that does not contract sideways, held at one end, under a load along it that is there at
// once
Problem bar() {
  Problem p = body_of({box_mesh({{0, 0, 0}, {bar_length, 0.1, 0.1}}, {8, 2, 2}),
                       box_mesh({{0, 0, 0}, {bar_length, 0.1, 0.1}}, {4, 1, 1})},
                      "linear");
  p.body.material.young_modulus = bar_modulus, p.body.material.poisson_ratio = 0;
  p.body.material.density = bar_density;
  p.body.fixed = {left_face()};
  p.gravity = {bar_load, 0, 0};
  return p;
}

// u = sum of a sin(kx) (1 - cos(wt)) over k = (2n - 1) pi / 2L, w = k sqrt(E/rho), a = 2 g / (L k
// w^2)
double exact_on_bar(double x, double t) {
  double u = 0;
  for (int n = 1; n < 400; ++n) {
    const double k = (2 * n - 1) * std::numbers::pi / (2 * bar_length),
                 w = k * std::sqrt(bar_modulus / bar_density);
    u += 2 * bar_load / (bar_length * k * w * w) * std::sin(k * x) * (1 - std::cos(w * t));
  }
  return u;
}

Trajectory exact_motion(const Problem& p, const std::vector<double>& times) {
  Trajectory t;
  t.times = times;
  for (const double time : times) {
    auto& u = t.u.emplace_back();
    for (const Point& x : p.body.levels[0].vertices)
      u.emplace_back(exact_on_bar(x.x(), time), 0, 0);
  }
  return t;
}

StudyOptions against_truth(std::vector<std::string> methods) {
  StudyOptions o;
  o.duration = 0.5, o.samples = 20, o.timed_runs = 1;  // a period of the first mode
  o.methods = std::move(methods);
  o.truth = TruthOptions{};
  o.truth->refinements = 1;
  return o;
}

TEST(Truth, IsNearTheKnownMotionOfABar) {
  const Problem p = bar();
  const StudyReference found = make_truth(p, against_truth({}), {}, {});
  const Trajectory exact = exact_motion(p, found.trajectory.times);
  const double error = difference(found.trajectory, exact, exact);
  const Truth& truth = found.truth.value();
  ASSERT_EQ(truth.family.meshes.size(), 2u);
  EXPECT_EQ(truth.family.meshes[1].tets, 8 * 6 * 8 * 2 * 2);
  EXPECT_TRUE(truth.converges()) << *truth.family.order;
  EXPECT_LT(error, truth.family.meshes[1].error) << "better than the finest mesh";
  EXPECT_LT(error, 1.5 * found.own_error) << "as uncertain as it says";
  EXPECT_LT(truth.time_error, 0.3 * truth.family.meshes[1].error);
  EXPECT_EQ(truth.family.name, "nodal");
  EXPECT_EQ(truth.check.name, "linear");
  ASSERT_EQ(found.meshes.size(), 4u) << "two levels, two kinds of elements";
  for (const MeshReference& mesh : found.meshes) {
    EXPECT_NEAR(mesh.error_space, difference(mesh.trajectory, exact, exact), 2 * found.own_error);
    EXPECT_LT(mesh.own_error, 0.01);
  }
  for (const std::size_t finest : {0, 2}) {
    EXPECT_EQ(found.meshes[finest].level, 0);
    EXPECT_GT(found.meshes[finest + 1].error_space, 1.5 * found.meshes[finest].error_space);
  }
}

TEST(Truth, WithoutACoarserMeshNoOrderIsObserved) {
  Problem p = bar();
  p.body.levels.resize(1);
  StudyOptions o = against_truth({"single/symplectic_euler"});
  const StudyResult result = study(p, o);
  const Truth& truth = result.reference.truth.value();
  EXPECT_FALSE(truth.family.order);
  EXPECT_FALSE(truth.converges());
  EXPECT_GE(result.reference.own_error, truth.family.correction);
  EXPECT_FALSE(good_enough(result)) << "a whole correction is no tenth of an error";
  o.truth->refinements = 2;
  const StudyReference three = make_truth(p, o, {}, {});
  EXPECT_TRUE(three.truth->family.order);
  EXPECT_LT(three.own_error, result.reference.own_error);
  o.truth->jitter = 0.2, o.truth->refinements = 1;
  EXPECT_EQ(make_truth(p, o, {}, {}).truth->check.name, "nodal, jittered");
}

TEST(Truth, RowsHaveTheirErrorInSpaceAndInTime) {
  StudyOptions o =
      against_truth({"single/symplectic_euler", "single/implicit_euler", "coarse", "coarse/1/rk4"});
  o.probes["end"] = {bar_length, 0.05, 0.05};
  const StudyResult result = study(bar(), o);
  ASSERT_EQ(result.rows.size(), 12u);
  for (const StudyRow& row : result.rows) {
    ASSERT_EQ(row.status, "completed") << row.reason;
    EXPECT_LE(*row.total_error, (*row.space_error + *row.error) * (1 + 1e-9)) << row.key;
    EXPECT_GE(*row.total_error, std::abs(*row.space_error - *row.error) * (1 - 1e-9)) << row.key;
    EXPECT_TRUE(row.error_probes.at("end"));
    for (const MeshReference& mesh : result.reference.meshes)
      if (mesh.element == row.element && (mesh.level == 0) == row.method.starts_with("single/")) {
        EXPECT_EQ(row.space_error, mesh.error_space);
      }
  }
  const auto row_of = [&](const std::string& method) {
    return *std::ranges::find(result.rows, method, &StudyRow::method);
  };
  EXPECT_LT(*row_of("single/symplectic_euler").error,
            *row_of("single/symplectic_euler").space_error);
  EXPECT_GT(*row_of("single/implicit_euler").error, *row_of("single/implicit_euler").space_error);
  EXPECT_LT(*row_of("coarse/1/rk4").error, 0.1 * *row_of("coarse/1").error) << "order 4 against 1";
}

TEST(Truth, EveryLevelIsRunByEveryIntegrator) {
  StudyOptions o = against_truth({});
  const auto cases = study_cases(bar(), o, study_levels(bar()));
  const auto has = [&](const std::string& method) {
    return std::ranges::find(cases, method, &StudyCase::method) != cases.end();
  };
  for (const char* method : {"single/central_difference", "single/bdf2", "single/v_cycle_euler",
                             "coarse/1", "coarse/1/rk4", "coarse/1/newmark", "cycle/him"})
    EXPECT_TRUE(has(method)) << method;
  for (const char* method : {"single/euler", "coarse/1/rk2", "coarse/1/symplectic_euler"})
    EXPECT_FALSE(has(method)) << method;
}

// Whatever the truth has left of the budget
TEST(Truth, TheBaselineIsNeverLeftOut) {
  StudyOptions o = against_truth({});
  StudyResult before;
  before.reference = make_truth(bar(), o, {}, {});
  o.budget = 1e-9;
  const StudyResult result = study(bar(), o, {}, before);
  ASSERT_EQ(result.rows.size(), 2u);
  EXPECT_EQ(result.rows[0].element, "linear");
  EXPECT_EQ(result.rows[1].element, "nodal");
  for (const StudyRow& row : result.rows) {
    EXPECT_EQ(row.method, "single/symplectic_euler");
    EXPECT_EQ(row.timed_runs, 1);
  }
}

TEST(Truth, WhatTheBudgetCannotBuyIsSaid) {
  StudyOptions o = against_truth({});
  o.truth->refinements.reset(), o.budget = 1e-6;
  try {
    study(bar(), o);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("left of the budget"), std::string::npos)
        << error.what();
  }
  o = against_truth({});
  o.truth->refinements = 0;
  EXPECT_THROW(study(bar(), o), InputError);
  o = against_truth({});
  o.elements = {"linaer"};
  EXPECT_THROW(study(bar(), o), InputError);
}

TEST(Truth, IsStoppedByTheWatch) {
  const StudyReference none =
      make_truth(bar(), against_truth({}), {}, [](const std::string&, double) { return false; });
  EXPECT_TRUE(none.trajectory.u.empty());
}

}  // namespace
