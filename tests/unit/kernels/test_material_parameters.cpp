// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <string>
#include <vector>

#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/three_constants.hpp"

namespace {

using namespace plica;
using namespace plica::test;

std::string refusal_of(const MaterialInfo& info, const Body& body) {
  return refusal([&] { check_parameters(info, body); });
}

TEST(MaterialParameters, AreTheRegionsThenTheBodysThenTheStandard) {
  Body body;
  body.material.parameters = {{"c1", 10}, {"c2", 20}};
  RegionOptions region;
  region.parameters = {{"c2", 30}};
  EXPECT_EQ(parameter_values(three_constants(), body.material, region),
            (std::vector<double>{10, 30, 30e3}));
  body.material.young_modulus = 5, region.poisson_ratio = 0.3;
  EXPECT_EQ(parameter_values(*find_material("linear"), body.material, region),
            (std::vector<double>{5, 0.3}));
}

TEST(MaterialParameters, AreRefusedOutOfTheirRangeAndByAWrongName) {
  Body body;
  EXPECT_EQ(refusal_of(three_constants(), body), "");
  body.material.parameters = {{"c1", 0}};
  EXPECT_EQ(refusal_of(three_constants(), body),
            "body.material.c1 is 0 Pa; expected a pressure (Pa) > 0");
  body.material.parameters = {{"c2", 2e6}};
  EXPECT_EQ(refusal_of(three_constants(), body),
            "body.material.c2 is 2000000 Pa; expected a pressure (Pa) in [0, 1e+06] Pa");
  body.material.parameters = {{"blk", 1}};
  EXPECT_EQ(refusal_of(three_constants(), body),
            "body.material.blk: unknown parameter of three_constants 'blk'; did you mean 'bulk'? "
            "(choices: c1, c2, bulk)");
  body.material.parameters.clear(), body.regions["liver"].parameters = {{"bulk", -1}};
  EXPECT_EQ(refusal_of(three_constants(), body),
            "body.regions.liver.bulk is -1 Pa; expected a pressure (Pa) > 0");
  EXPECT_EQ(refusal_of(*find_material("linear"), body),
            "body.regions.liver.bulk: unknown parameter of linear 'bulk' (choices: young_modulus, "
            "poisson_ratio)");
}

// A scene has one key of a name: laws that share it share its range, its help and its standard
// value
TEST(MaterialParameters, OfOneNameAreOne) {
  const std::vector<MaterialParameter> keys = material_parameters();
  for (const MaterialInfo& info : material_list())
    for (const MaterialParameter& p : info.parameters)
      for (const MaterialParameter& key : keys)
        if (std::string(p.name) == key.name) {
          EXPECT_STREQ(p.help, key.help) << info.name << " " << p.name;
          EXPECT_EQ(p.kind.type_text(), key.kind.type_text()) << info.name << " " << p.name;
          EXPECT_EQ(p.standard, key.standard) << info.name << " " << p.name;
        }
}

TEST(MaterialParameters, OfRelaxationAreRefusedWhereNothingWouldBeLeft) {
  Body body;
  const auto with = [&](const char* model, const std::vector<PronyTerm>& prony) {
    body.material.prony = prony;
    return refusal_of(*find_material(model), body);
  };
  EXPECT_EQ(with("neo_hookean", {{0.3, 1}, {0.69, 0.1}}), "");
  EXPECT_EQ(with("neo_hookean", {{0.3, 1}, {0.7, 0.1}}),
            "body.material.prony: the sum of alpha is 1; expected one below 1: what is left of 1 "
            "is the part that never "
            "relaxes");
  EXPECT_EQ(with("mooney_rivlin", {{0.3, 0}}),
            "body.material.prony.0.tau is 0 s; expected a time (s) > 0");
  EXPECT_EQ(with("mooney_rivlin", {{0.3, 1}, {-0.1, 1}}),
            "body.material.prony.1.alpha is -0.1; expected a number in (0, 1)");
  EXPECT_EQ(with("neo_hookean", std::vector<PronyTerm>(7, {0.1, 1})),
            "body.material.prony: 7 terms; expected 1 to 6");
  EXPECT_EQ(with("corotational", {{0.3, 1}}).substr(0, 130),
            "body.material.prony: corotational does not split shape from volume, and only shape "
            "relaxes; expected no "
            "prony, or one of the model");
}

TEST(MaterialParameters, OfTissueAreRefusedWhereTheyDoNotMakeABody) {
  Body body;
  const auto with = [&](const char* model, const MaterialOptions& options) {
    body.material = options;
    return refusal_of(*find_material(model), body);
  };
  EXPECT_EQ(with("mooney_rivlin", {.parameters = {{"c10", 1000}, {"c01", -1000}}}),
            "body.material, as the shear stiffness of mooney_rivlin at rest, is 0 Pa; expected a "
            "pressure (Pa) in [1e-06, 1e+15] Pa");
  EXPECT_EQ(with("transversely_isotropic", {}),
            "body.fibres is missing; expected the direction of the fibres of "
            "transversely_isotropic, such as {axis: [0, "
            "0, 1]}, of the body or of every region");
  EXPECT_EQ(with("holzapfel_gasser_ogden", {.fibres = FibreOptions{}}),
            "body.fibres.sheet is missing; holzapfel_gasser_ogden differs across its fibres: "
            "expected a direction across "
            "them");
  EXPECT_EQ(with("costa", {.fibres = FibreOptions{Point::UnitX(), Point(2 * Point::UnitX())}}),
            "body.fibres.sheet is along the axis; expected a direction across it");
  EXPECT_EQ(with("mooney_rivlin", {.fibres = FibreOptions{}}),
            "body.fibres: mooney_rivlin has none");
  EXPECT_EQ(
      with("ogden", {.terms = {{1e3, 2}}}),
      "body.material.convention is missing; ogden has no standard one, expected mu_over_alpha2 | "
      "mu_over_alpha | two_mu_over_alpha2");
  EXPECT_EQ(
      with("ogden", {.convention = "mu_over_alpha"}),
      "body.material.terms is missing; expected those of ogden, such as [{mu: 1 kPa, alpha: 2}]");
  EXPECT_EQ(with("ogden", {.convention = "mu_over_alpha", .terms = {{1e3, 0}}}),
            "body.material.terms.0.alpha is 0; expected a number other than 0");
  EXPECT_EQ(with("linear", {.volume = "quadratic"}),
            "body.material.volume is quadratic; linear has its own; remove this key");
  EXPECT_EQ(
      with("costa", {.fibres = FibreOptions{.sheet = Point::UnitX(), .around = FibreWinding{}}}),
      "body.fibres.sheet: fibres around a line have their sheets on cylinders about it; remove "
      "this "
      "key");
  EXPECT_EQ(with("costa", {.fibres = FibreOptions{.around = FibreWinding{}}}), "");
  EXPECT_EQ(with("costa", complete({.model = "costa"})), "");
  body.material = {}, body.regions["wall"].fibres = FibreOptions{Point::UnitX(), Point::UnitY()};
  EXPECT_EQ(refusal_of(*find_material("costa"), body), "");  // every region has its own
}

}  // namespace
