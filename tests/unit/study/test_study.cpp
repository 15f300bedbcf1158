// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/drivers/study/study.hpp>

#include "support/bodies.hpp"

// Error against run time, on a beam small enough for a test.
namespace {

using namespace plica;
using namespace plica::test;

Problem beam(int levels = 2) {
  std::vector<TetMesh> meshes = {box_mesh(beam_box, {8, 2, 2}), box_mesh(beam_box, {4, 1, 1})};
  meshes.resize(static_cast<std::size_t>(levels));
  Problem p = body_of(std::move(meshes), "neo_hookean");
  p.body.material.young_modulus = 1e6;
  p.body.fixed = {left_face()};
  p.gravity = {0, 0, -9.81};
  return p;
}

StudyOptions quick(std::vector<std::string> methods) {
  StudyOptions o;
  o.duration = 0.05, o.samples = 10, o.timed_runs = 1;
  o.methods = std::move(methods);
  return o;
}

std::vector<const StudyRow*> rows_of(const StudyResult& result, const std::string& method) {
  std::vector<const StudyRow*> rows;
  for (const StudyRow& row : result.rows)
    if (row.method == method) rows.push_back(&row);
  return rows;
}

TEST(StudyMethods, AreNamedAfterWhatThereIs) {
  const auto methods = study_methods(beam());
  for (const char* name : {"single/symplectic_euler", "single/implicit_euler", "single/rk4",
                           "coarse/1", "cycle/rsv", "cycle/auto"})
    EXPECT_NE(std::ranges::find(methods, name), methods.end()) << name;
  for (const char* name : {"coarse/0", "coarse/2", "cycle/single"})
    EXPECT_EQ(std::ranges::find(methods, name), methods.end()) << name;
  for (const std::string& name : study_methods(beam(1)))
    EXPECT_TRUE(name.starts_with("single/")) << name;
}

TEST(StudyMethods, UnknownOnesGetTheNearest) {
  const auto message = [](const std::string& method) {
    try {
      study(beam(), quick({method}));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(message("cycle/rvs").find("did you mean 'cycle/rsv'"), std::string::npos)
      << message("cycle/rvs");
  EXPECT_NE(message("cycle/rsv/critcal").find("did you mean 'critical'"), std::string::npos);
  EXPECT_NE(message("cycle/auto/acurate").find("did you mean 'accurate'"), std::string::npos);
  EXPECT_NE(message("coarse/2").find("unknown method 'coarse/2'"), std::string::npos);
  EXPECT_NE(message("cycle/rsv/custom").find("integration.distribution"), std::string::npos);
}

TEST(StudyMethods, CoarserLevelsMustBeThere) {
  EXPECT_THROW(study(beam(1), quick({"coarse"})), InputError);
  EXPECT_THROW(study(beam(1), quick({"cycle"})), InputError);
}

TEST(StudyCases, TheDefaultSetHasItsControlsAndEveryCycle) {
  const Problem p = beam();
  const auto levels = study_levels(p);
  StudyOptions o;
  o.duration = 1;
  const auto cases = study_cases(p, o, levels);
  const auto count = [&](const std::string& label) {
    return std::ranges::count_if(cases, [&](const StudyCase& c) { return c.label() == label; });
  };
  EXPECT_EQ(count("single/symplectic_euler"), 2);
  EXPECT_EQ(count("single/implicit_euler"), 3);
  EXPECT_EQ(count("coarse/1"), 1);
  for (const char* cycle : {"rs", "rv", "rsv", "rsv_sv", "fas"})
    for (const char* shares : {"equal", "inverse_elements", "critical"})
      EXPECT_EQ(count(std::string("cycle/") + cycle + "/" + shares), 6);
  EXPECT_EQ(count("cycle/auto/balanced"), 1);
  EXPECT_EQ(count("cycle/auto/accurate"), 0);
  std::vector<std::string> keys;
  for (const StudyCase& c : cases) keys.push_back(c.key());
  std::ranges::sort(keys);
  EXPECT_EQ(std::ranges::adjacent_find(keys), keys.end()) << "a run is repeated";
}

TEST(Study, HalvingTheStepOfAnExplicitMethodLowersItsError) {
  const auto result = study(beam(1), quick({"single/symplectic_euler"}));
  const auto rows = rows_of(result, "single/symplectic_euler");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NEAR(*rows[0]->macro_step_over_critical, 0.9, 1e-6);
  EXPECT_NEAR(*rows[1]->macro_step_over_critical, 0.5, 1e-6);
  EXPECT_NEAR(*rows[0]->work, 1, 1e-12);
  EXPECT_NEAR(*rows[0]->error / *rows[1]->error, 0.9 / 0.5, 0.3) << "order 1";
  EXPECT_LT(std::abs(rows[1]->energy_drift.value()), 0.1);
  EXPECT_TRUE(good_enough(result)) << result.reference.own_error;
}

TEST(Study, CycleAutoIsARowForEachClassThatKeepsItsWord) {
  StudyOptions o = quick({"cycle/auto"});
  o.macro_steps = {1e-4};
  const StudyResult result = study(beam(), o);
  ASSERT_EQ(result.rows.size(), 3u);
  double before = 0;
  for (const auto& [error_class, allowed] :
       {std::pair{"accurate", 0.001}, {"balanced", 0.01}, {"interactive", 0.05}}) {
    const auto row = std::ranges::find(result.rows, error_class, &StudyRow::distribution);
    ASSERT_NE(row, result.rows.end()) << error_class;
    ASSERT_EQ(row->status, "completed") << row->reason;
    EXPECT_TRUE(row->automatic);
    EXPECT_GE(*row->macro_step, before);
    before = *row->macro_step;
    if (*row->macro_step_over_critical > 1) {
      EXPECT_LE(*row->error, 3 * allowed) << error_class;
    }
  }
}

TEST(Study, AMethodThatIsTheReferenceHasNoError) {
  StudyOptions o = quick({"single/rk4"});
  o.macro_steps = {study(beam(1), o).reference.macro_step};
  const auto result = study(beam(1), o);
  const auto row =
      std::ranges::min_element(result.rows, {}, [](const StudyRow& r) { return *r.error; });
  EXPECT_EQ(row->error, 0);
  EXPECT_EQ(row->error_velocity, 0);
  EXPECT_EQ(row->error_worst_vertex, 0);
  EXPECT_GT(result.reference.own_error, 0);
  EXPECT_FALSE(good_enough(result)) << "no reference can tell an error of zero";
}

TEST(Study, ADeliberatelyBadReferenceIsCalledSo) {
  StudyOptions o = quick({"single/symplectic_euler"});
  o.reference_integrator = "symplectic_euler", o.reference_step = 0.9, o.reference_error = 1;
  const auto result = study(beam(1), o);
  EXPECT_FALSE(good_enough(result));
  EXPECT_FALSE(resolves(result.reference, 1e-3));
  EXPECT_GT(result.reference.own_error, 1e-3);
}

TEST(Study, ACoarseLevelAloneIsComparedOnTheFinestMesh) {
  const auto result = study(beam(), quick({"coarse"}));
  ASSERT_EQ(result.rows.size(), 1U);
  const StudyRow& row = result.rows[0];
  EXPECT_EQ(row.method, "coarse/1");
  ASSERT_EQ(row.status, "completed") << row.reason;
  EXPECT_GT(*row.error, 0.01);
  EXPECT_LT(*row.error, 1);
  EXPECT_GT(*row.macro_step_over_critical, 1);
  EXPECT_LT(*row.work, 0.2);
  EXPECT_TRUE(row.pareto);
}

TEST(Study, RowsThatDivergeOrRefuseAreThere) {
  Problem p = beam();
  p.integration.allow_unstable = true;
  p.integration.substeps = {1};
  StudyOptions o = quick({"cycle/rs/equal"});
  const double critical = study_levels(p)[0].critical_step;
  o.macro_steps = {20 * critical};
  const auto diverged = study(p, o);
  ASSERT_EQ(diverged.rows.size(), 1U);
  EXPECT_EQ(diverged.rows[0].status, "diverged");
  EXPECT_NE(diverged.rows[0].reason, "");
  EXPECT_FALSE(diverged.rows[0].error || diverged.rows[0].wall_time || diverged.rows[0].pareto);
  p.integration.allow_unstable = false;
  const auto refused = study(p, o);
  ASSERT_EQ(refused.rows.size(), 1U);
  EXPECT_EQ(refused.rows[0].status, "refused");
  EXPECT_NE(refused.rows[0].reason.find("critical step"), std::string::npos)
      << refused.rows[0].reason;
  EXPECT_FALSE(refused.rows[0].error || refused.rows[0].work || refused.rows[0].pareto);
}

TEST(Study, FinishedRowsAreTakenOverAndTheRestIsRun) {
  const StudyOptions o = quick({"single/symplectic_euler"});
  StudyResult first = study(beam(1), o, [](const StudyProgress& p) { return !p.new_row; });
  EXPECT_TRUE(first.stopped);
  ASSERT_EQ(first.rows.size(), 1U);
  ASSERT_EQ(first.left_out.size(), 1U);
  first.rows[0].reason = "from before";
  bool again = false;
  const auto second = study(
      beam(1), o,
      [&](const StudyProgress& p) {
        again = again || (p.doing == "reference" && !p.new_reference);
        return true;
      },
      first);
  EXPECT_FALSE(again) << "the reference was run again";
  ASSERT_EQ(second.rows.size(), 2U);
  EXPECT_EQ(second.rows[0].reason, "from before");
  EXPECT_FALSE(second.stopped);
  EXPECT_TRUE(second.left_out.empty());
}

TEST(Study, WhatDoesNotFitTheBudgetIsListed) {
  StudyOptions o = quick({});
  o.budget = 1e-9;
  const auto result = study(beam(), o);
  ASSERT_EQ(result.rows.size(), 1U) << "the baseline, whatever it takes";
  EXPECT_EQ(result.rows[0].method, "single/symplectic_euler");
  ASSERT_FALSE(result.left_out.empty());
  EXPECT_EQ(result.left_out[0].key.find("coarse/1"), 0U) << "the most telling first";
  EXPECT_NE(result.left_out[0].reason.find("budget"), std::string::npos);
}

TEST(Study, ControlsComeFirst) {
  StudyOptions o = quick({});
  o.precision = {"double", "float"};
  std::vector<std::string> order;
  const auto cases = study_cases(beam(), o, study_levels(beam()));
  study(beam(), o, [&](const StudyProgress& p) {
    if (p.new_row) order.push_back(p.doing);
    return order.size() < 5;
  });
  std::size_t controls = 0;
  for (const StudyCase& c : cases) controls += c.control ? 1 : 0;
  EXPECT_EQ(controls, 4U) << "explicit, two implicit, one coarser level";
  ASSERT_EQ(order.size(), 5U);
  EXPECT_EQ(order[0].find("single/symplectic_euler, auto, double"), 0U) << order[0];
  EXPECT_EQ(order[1].find("coarse/1, auto, double"), 0U) << order[1];
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto one = std::ranges::find(cases, order[i], &StudyCase::key);
    ASSERT_NE(one, cases.end()) << order[i];
    EXPECT_EQ(one->control, i < controls) << order[i];
  }
}

// Whatever is said to be too long: what the others are compared with is there, with a run less if
// need be.
TEST(Study, TheBaselineIsRunWhileThereIsTime) {
  StudyOptions o = quick({"single/symplectic_euler", "single/implicit_euler", "coarse"});
  o.timed_runs = 3;
  StudyResult before = study(beam(), o, [](const StudyProgress& p) { return !p.new_reference; });
  ASSERT_FALSE(before.reference.trajectory.u.empty());
  o.budget = 1e6;
  before.reference.seconds_per_evaluation = 1e6;  // the slowest of machines
  const StudyResult result = study(beam(), o, {}, before);
  const auto baseline = rows_of(result, "single/symplectic_euler");
  ASSERT_FALSE(baseline.empty());
  EXPECT_NEAR(*baseline[0]->macro_step_over_critical, 0.9, 1e-6);
  EXPECT_EQ(baseline[0]->status, "completed");
  EXPECT_EQ(baseline[0]->timed_runs, 1) << "its only run is timed";
  EXPECT_TRUE(rows_of(result, "coarse/1").empty());
  const auto left_out = std::ranges::count_if(
      result.left_out, [](const LeftOut& l) { return l.key.starts_with("coarse/1"); });
  EXPECT_EQ(left_out, 1);
}

TEST(Study, ControlsMakeDoWithOneRun) {
  StudyOptions o = quick({"coarse"});
  o.timed_runs = 3;
  StudyResult before = study(beam(), o, [](const StudyProgress& p) { return !p.new_reference; });
  const auto coarse = study_cases(beam(), o, study_levels(beam())).at(0);
  o.budget = 1000;
  before.reference.seconds_per_evaluation = 500 / coarse.predicted_evaluations;
  const StudyResult result = study(beam(), o, {}, before);
  ASSERT_EQ(result.rows.size(), 1U);
  EXPECT_EQ(result.rows[0].timed_runs, 1);
}

TEST(Study, AFinerMeshTellsSpaceFromTime) {
  StudyOptions o = quick({"single/symplectic_euler", "coarse"});
  Problem p = beam();
  p.body.levels = {box_mesh(beam_box, {4, 1, 1}), box_mesh(beam_box, {2, 1, 1})};
  o.finer = box_mesh(beam_box, {8, 2, 2});
  const auto result = study(p, o);
  EXPECT_GT(result.reference.space_error.value(), 0.05) << "in space the mesh is bad";
  for (const StudyRow* row : rows_of(result, "single/symplectic_euler")) {
    EXPECT_LT(*row->error, 0.05) << "in time it is not";
    EXPECT_NEAR(*row->error_finer, *result.reference.space_error, 0.05);
  }
}

TEST(Study, NothingThatMovesIsSaid) {
  Problem p = beam(1);
  p.gravity = Point::Zero();
  EXPECT_THROW(study(p, quick({})), InputError);
}

TEST(Pareto, IsWhatNothingBeats) {
  const auto row = [](double error, double time) {
    StudyRow r;
    r.status = "completed", r.error = error, r.wall_time = time;
    return r;
  };
  std::vector<StudyRow> rows = {row(0.1, 1),   row(0.01, 2),  row(0.05, 3),
                                row(0.1, 1.5), row(0.001, 9), row(0.1, 1)};
  rows.push_back({});
  mark_pareto(rows);
  std::vector<bool> marks;
  for (const StudyRow& r : rows) marks.push_back(r.pareto);
  EXPECT_EQ(marks, (std::vector<bool>{true, true, false, false, true, true, false}));
  EXPECT_EQ(fastest_below(rows, 0.05), &rows[1]);
  EXPECT_EQ(fastest_below(rows, 1e-4), nullptr);
  EXPECT_EQ(smallest_error(rows), 0.001);
}

TEST(Trajectory, CubicsInTimeAreExactBetweenSteps) {
  const auto cubic = [](double t) { return Point(1 + t, t * t, t * t * t - 2 * t); };
  for (const long steps : {3L, 4L, 11L}) {
    const double step = 1.0 / static_cast<double>(steps);
    TrajectorySampler sampler(sampling_times(1, 7), step, steps);
    for (long n = 0; n <= steps; ++n)
      if (sampler.wants(n)) {
        const Point x = cubic(static_cast<double>(n) * step);
        sampler.add(n, {x}, {2 * x});
      }
    const Trajectory t = sampler.take();
    for (std::size_t j = 0; j < t.times.size(); ++j) {
      EXPECT_NEAR((t.u[j][0] - cubic(t.times[j])).norm(), 0, 1e-13);
      EXPECT_NEAR((t.v[j][0] - 2 * cubic(t.times[j])).norm(), 0, 1e-13);
    }
  }
}

}  // namespace
