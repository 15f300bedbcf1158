// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/drivers/study/study.hpp>
#include <plica/drivers/study/study_case.hpp>

#include "support/bodies.hpp"

// Variants of cycles, their growth, probes and phase, on a beam small enough for a test.
namespace {

using namespace plica;
using namespace plica::test;

Problem variant_beam() {
  Problem p =
      body_of({box_mesh(beam_box, {8, 2, 2}), box_mesh(beam_box, {4, 1, 1})}, "neo_hookean");
  p.body.material.young_modulus = 1e6;
  p.body.fixed = {left_face()};
  p.gravity = {0, 0, -9.81};
  return p;
}

StudyOptions with_variants(std::vector<std::string> methods) {
  StudyOptions o;
  o.duration = 0.05, o.samples = 10, o.timed_runs = 0;
  o.methods = std::move(methods);
  o.variants["hybrid"].integrator = {"symplectic_euler", "implicit_euler"};
  o.variants["hybrid"].allow_unstable = true;
  o.variants["low"].switch_threshold = 1e-6;
  return o;
}

std::vector<std::string> labels(const StudyOptions& options) {
  std::vector<std::string> found;
  for (const ChosenMethod& c : chosen_methods(variant_beam(), options))
    found.push_back(study_label(c.method, c.distribution, c.variant));
  return found;
}

TEST(StudyVariants, AreOfOneNameOrOfTheFamily) {
  using Labels = std::vector<std::string>;
  EXPECT_EQ(labels(with_variants({"cycle/rs/equal+hybrid"})), Labels({"cycle/rs/equal+hybrid"}));
  EXPECT_EQ(
      labels(with_variants({"cycle/rs+low"})),
      Labels({"cycle/rs/equal+low", "cycle/rs/inverse_elements+low", "cycle/rs/critical+low"}));
  EXPECT_EQ(labels(with_variants({"cycle/rs/equal"})), Labels({"cycle/rs/equal"}))
      << "only where it is named";
  EXPECT_EQ(labels(with_variants({"cycle"})).size(), 5U * 3U * 3U + 2U)
      << "without, hybrid, low; him, auto";
  EXPECT_EQ(labels(with_variants({"cycle+hybrid"})).size(), 5U * 3U);
  EXPECT_EQ(labels(with_variants({"cycle", "cycle/rs/equal+low"})).size(), 5U * 3U * 3U + 2U)
      << "none twice";
}

TEST(StudyVariants, WrongOnesAreRefusedWithTheNearest) {
  const auto message = [](const StudyOptions& options) {
    try {
      check_study(variant_beam(), options);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const auto expect = [&](const StudyOptions& options, const char* words) {
    EXPECT_NE(message(options).find(words), std::string::npos) << message(options);
  };
  expect(with_variants({"cycle/rs+hybird"}), "did you mean 'hybrid'");
  expect(with_variants({"cycle/rvs+hybrid"}), "did you mean 'cycle/rsv'");
  expect(with_variants({"single/rk4+hybrid"}), "only cycles have variants");
  expect(with_variants({"cycle/rs+"}), "variant");
  StudyOptions o = with_variants({"cycle"});
  o.variants["hybrid"].integrator = {"symplectic_euler", "implicit_euler", "rk4"};
  expect(o, "study.variants.hybrid: integration.integrator");
  o = with_variants({"cycle"});
  o.variants["low"].switch_threshold = 0;
  expect(o, "study.variants.low: integration.switch_threshold");
  o = with_variants({"cycle"});
  o.variants["a/b"] = {};
  expect(o, "study.variants.a/b");
  o.variants.clear();
  o.methods = {"cycle/rs+hybrid"};
  expect(o, "study.variants");
}

TEST(StudyVariants, OneThatChangesNothingIsNotRunAgain) {
  const Problem p = variant_beam();
  StudyOptions o = with_variants({"cycle"});
  o.variants["twice"].integrator = {"symplectic_euler", "symplectic_euler"};
  const auto cases = study_cases(p, o, study_levels(p));
  const auto count = [&](const std::string& label) {
    return std::ranges::count_if(cases, [&](const StudyCase& c) { return c.label() == label; });
  };
  EXPECT_EQ(count("cycle/rsv/equal+low"), count("cycle/rsv/equal"));
  EXPECT_EQ(count("cycle/rs/equal+low"), 0) << "rs has no threshold";
  EXPECT_EQ(count("cycle/fas/critical+low"), 0);
  EXPECT_EQ(count("cycle/rs/equal+twice"), 0) << "the same for both levels";
  EXPECT_EQ(count("cycle/rs/equal+hybrid"), count("cycle/rs/equal"));
  EXPECT_GT(count("cycle/rs/equal"), 0);
}

TEST(StudyVariants, AreRun) {
  StudyOptions o = with_variants({"cycle/rsv/equal", "cycle/rsv/equal+hybrid"});
  Problem p = variant_beam();
  p.integration.implicit.matrix = "free";
  o.macro_steps = {study_levels(p)[0].critical_step};
  const auto result = study(p, o);
  ASSERT_EQ(result.rows.size(), 2U);
  EXPECT_EQ(result.rows[0].variant, "");
  EXPECT_EQ(result.rows[1].variant, "hybrid");
  EXPECT_EQ(result.rows[1].label(), "cycle/rsv/equal+hybrid");
  ASSERT_EQ(result.rows[0].status + result.rows[1].status, "completedcompleted");
  EXPECT_NE(*result.rows[0].error, *result.rows[1].error);
  EXPECT_GT(*result.rows[1].work, *result.rows[0].work) << "linear solves are work";
}

TEST(StudyGrowth, IsThatOfTheLinearisedCycleBesideEachRow) {
  Problem p = variant_beam();
  StudyOptions o = with_variants(
      {"single/symplectic_euler", "cycle/rs/equal", "cycle/rsv/equal", "cycle/rv/equal"});
  const double critical = study_levels(p)[0].critical_step;
  o.macro_steps = {critical, 8 * critical};
  o.growth = true;
  p.integration.allow_unstable = true, p.integration.substeps = {1};
  const auto result = study(p, o);
  for (const StudyRow& row : result.rows) {
    EXPECT_EQ(row.spectral_radius.has_value(), row.method != "single/symplectic_euler") << row.key;
    EXPECT_EQ(row.spectral_radius.has_value(),
              row.growth_per_second && row.spectral_radius_uncertainty)
        << row.key;
    if (!row.spectral_radius) continue;
    EXPECT_NEAR(*row.growth_per_second, std::log(*row.spectral_radius) / *row.macro_step,
                1e-9 * std::abs(*row.growth_per_second));
    EXPECT_TRUE(grows(row) || *row.macro_step_over_critical < 7)
        << row.key << " " << *row.spectral_radius;
  }
  const auto of = [&](const std::string& method, std::size_t i) {
    std::vector<const StudyRow*> rows;
    for (const StudyRow& row : result.rows)
      if (row.method == method) rows.push_back(&row);
    return rows.at(i);
  };
  EXPECT_EQ(of("cycle/rsv", 0)->spectral_radius, of("cycle/rv", 0)->spectral_radius) << "one map";
  EXPECT_NE(of("cycle/rs", 0)->spectral_radius, of("cycle/rv", 0)->spectral_radius);
  const auto none = study(p, with_variants({"cycle/rs/equal"}));
  for (const StudyRow& row : none.rows) EXPECT_FALSE(row.spectral_radius) << "nobody asked";
}

TEST(StudyGrowth, IsFoundForRowsFromBeforeAndLeftOutByTheBudget) {
  const Problem p = variant_beam();
  StudyOptions o = with_variants({"cycle/rs/equal"});
  o.macro_steps = {study_levels(p)[0].critical_step};
  StudyResult before = study(p, o);
  ASSERT_EQ(before.rows.size(), 1U);
  o.growth = true, o.budget = 1e-6;
  const auto bounded = study(p, o, {}, before);
  EXPECT_FALSE(bounded.rows.at(0).spectral_radius);
  ASSERT_EQ(bounded.left_out.size(), 1U);
  EXPECT_EQ(bounded.left_out[0].key.find("growth of cycle/rs/equal"), 0U)
      << bounded.left_out[0].key;
  o.budget = {};
  before.rows[0].reason = "from before";
  const auto after = study(p, o, {}, before);
  EXPECT_TRUE(after.rows.at(0).spectral_radius);
  EXPECT_EQ(after.rows[0].reason, "from before") << "run again";
}

TEST(StudyErrors, OfProbesAndThePhaseAreWhatTheyAreDefinedAs) {
  const double pi = std::acos(-1.0), late = 0.01;
  Trajectory reference, behind;
  for (int j = 1; j <= 100; ++j) {
    const double t = 2 * pi * j / 100;
    reference.times.push_back(t);
    reference.u.push_back({Point(std::sin(t), 0, 0), Point::Zero()});
    reference.v.push_back({Point(std::cos(t), 0, 0), Point::Zero()});
    behind.u.push_back({Point(std::sin(t - late), 0, 0), Point::Zero()});
  }
  EXPECT_NEAR(delay_of(behind, reference), late, 1e-4 * late);
  EXPECT_NEAR(delay_of(reference, reference), 0, 1e-15);
  EXPECT_NEAR(error_at(behind, reference, 0).value(), late, 1e-4 * late);
  EXPECT_FALSE(error_at(behind, reference, 1)) << "at rest";
}

TEST(StudyErrors, OfProbesAreThoseOfTheirPoints) {
  StudyOptions o = with_variants({"single/symplectic_euler"});
  o.probes = {{"tip", {0.4, 0.05, 0.05}}, {"held", {0, 0.05, 0.05}}};
  const auto free = study(variant_beam(), o);
  ASSERT_EQ(free.rows.size(), 2U);
  for (const StudyRow& row : free.rows) {
    ASSERT_EQ(row.error_probes.size(), 2U);
    EXPECT_NEAR(row.error_probes.at("tip").value(), *row.error, 0.5 * *row.error) << "it dominates";
    EXPECT_FALSE(row.error_probes.at("held"));
  }
  ASSERT_TRUE(free.rows[0].phase && free.rows[1].phase);
  EXPECT_NEAR(*free.rows[0].phase / *free.rows[1].phase, 0.9 / 0.5, 0.4) << "order 1";
  Problem damped = variant_beam();
  damped.body.damping.mass = 1;
  for (const StudyRow& row : study(damped, o).rows) EXPECT_FALSE(row.phase || row.energy_drift);
}

TEST(StudyReferenceStep, IsHalvedWhereItsErrorIsLarge) {
  StudyOptions o = with_variants({"single/symplectic_euler"});
  o.reference_error = 1;
  const auto rough = study(variant_beam(), o).reference;
  o.reference_error = 0;
  const auto fine = study(variant_beam(), o).reference;
  EXPECT_EQ(fine.macro_step, rough.macro_step / 2);
  EXPECT_LT(fine.own_error, 0.5 * rough.own_error);
}

TEST(StudyReferenceStep, IsHalvedWhereItDiverges) {
  StudyOptions o = with_variants({"single/symplectic_euler"});
  o.reference_integrator = "symplectic_euler", o.reference_step = 1.8, o.reference_error = 1;
  const auto result = study(variant_beam(), o);
  EXPECT_LT(result.reference.macro_step, 0.5 * result.reference.critical_step);
  o.reference_step = 100, o.samples = 1;
  EXPECT_THROW(study(variant_beam(), o), InputError);
}

}  // namespace
