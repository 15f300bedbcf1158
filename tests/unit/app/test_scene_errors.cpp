// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/run/registry.hpp>
#include <string>

#include "unit/app/scene_text.hpp"

// One damage of a sound scene each, and what is said of it.
namespace plica::app::test {
namespace {

struct Damage {
  const char* name;
  const char* piece;
  const char* replacement;
  const char* message;  // all of it, or its beginning; SHAPES: the obstacles' shapes
};

class SceneError : public testing::TestWithParam<Damage> {};

TEST_P(SceneError, SaysWhereWhatAndWhatInstead) {
  const auto& [name, piece, replacement, message] = GetParam();
  std::string expected = message, shapes;
  for (const std::string& shape : names(obstacle_shapes()))
    shapes += (shapes.empty() ? "" : ", ") + shape;
  if (const auto at = expected.find("SHAPES"); at != std::string::npos)
    expected.replace(at, 6, shapes);
  EXPECT_EQ(error_of(damaged(piece, replacement)).substr(0, expected.size()), expected);
}

const Damage damages[] = {
    {"UnknownKey", "material:", "materal:",
     "a.yaml:7: body: unknown key 'materal'; did you mean 'material'? (choices: "},
    {"UnknownTopLevelKey",
     "gravity:", "gravty:", "a.yaml:2: unknown key 'gravty'; did you mean 'gravity'? (choices: "},
    {"MisplacedKey", "gravity: [0, 0, -9.81]", "young_modulus: 3",
     "a.yaml:2: unknown key 'young_modulus'; it belongs in body.material or body.regions.<name>"},
    {"MisplacedBelow", "macro_step: 1 ms", "gravity: [0, 0, -9.81]",
     "a.yaml:11: integration: unknown key 'gravity'; it belongs in the top level"},
    {"DuplicateKey", "gravity: [0, 0, -9.81]", "gravity: [0, 0, -9.81]\ngravity: [0, 0, 0]",
     "a.yaml:3: duplicate key 'gravity'; the first is in line 2"},
    {"MissingKey", "duration: 1 s", "name: x", "a.yaml:1: the key 'duration' is missing"},
    {"MissingKeyBelow", "radius: 4 cm, ", "",
     "a.yaml:8: body.surface.sphere: the key 'radius' is missing"},
    {"WrongDimension", "50 kPa", "4 cm",
     "a.yaml:7: body.material.young_modulus: expected a pressure (Pa) in [1e-06, 1e+15] Pa, got '4 "
     "cm', a length"},
    {"StifferThanAnyMaterial", "50 kPa", "1e300 Pa",
     "a.yaml:7: body.material.young_modulus: expected a pressure (Pa) in [1e-06, 1e+15] Pa, got "
     "'1e300 Pa'"},
    {"UnknownUnit", "50 kPa", "50 kpa",
     "a.yaml:7: body.material.young_modulus: expected a pressure (Pa) in [1e-06, 1e+15] Pa, got "
     "'50 kpa', unknown "
     "unit 'kpa'; did you "
     "mean "
     "'kPa'?"},
    {"NotANumber", "1 s", "long",
     "a.yaml:1: duration: expected a time (s) > 0, got 'long', not a number"},
    {"NotFinite", "1 s", ".inf",
     "a.yaml:1: duration: expected a time (s) > 0, got '.inf', not a number"},
    {"OutOfRange", "1 s", "-1 s", "a.yaml:1: duration: expected a time (s) > 0, got '-1 s'"},
    {"PoissonRatio", "young_modulus: 50 kPa", "poisson_ratio: 0.5",
     "a.yaml:7: body.material.poisson_ratio: expected a number in [0, 0.5), got '0.5'"},
    {"StiffnessOfAnotherLaw", "neo_hookean", "mooney_rivlin",
     "a.yaml:7: body.material.young_modulus: unknown parameter of mooney_rivlin 'young_modulus'; "
     "did you mean "
     "'bulk_modulus'? (choices: c10, c01, bulk_modulus)"},
    {"NoStiffnessAtRest", "{model: neo_hookean, young_modulus: 50 kPa}",
     "{model: mooney_rivlin, c10: -1 kPa}",
     "a.yaml:7: body.material, as the shear stiffness of mooney_rivlin at rest, is 0 Pa; expected "
     "a pressure (Pa) in [1e-06, 1e+15] Pa"},
    {"OgdensAlpha", "{model: neo_hookean, young_modulus: 50 kPa}",
     "{model: ogden, convention: mu_over_alpha, terms: [{mu: 1 kPa, alpha: 0}]}",
     "a.yaml:7: body.material.terms.0.alpha is 0; expected a number other than 0"},
    {"NoFibres", "{model: neo_hookean, young_modulus: 50 kPa}", "{tissue: heart_muscle}",
     "a.yaml:3: body.fibres is missing; expected the direction of the fibres of costa, such as "
     "{axis: [0, 0, 1]}, of "
     "the body or of every region"},
    {"FibreOfNoLength", "{model: neo_hookean, young_modulus: 50 kPa}",
     "{tissue: heart_muscle}\n  fibres: {axis: [0, 0, 0]}",
     "a.yaml:8: body.fibres.axis: expected a direction, got "},
    {"FibresTwice", "{model: neo_hookean, young_modulus: 50 kPa}",
     "{tissue: heart_muscle}\n  fibres: {axis: [0, 0, 1], field: a}", "a.yaml:8: body.fibres: "},
    {"PronySum", "young_modulus: 50 kPa", "prony: [{alpha: 0.6, tau: 1 s}, {alpha: 0.5, tau: 2 s}]",
     "a.yaml:7: body.material.prony: the sum of alpha is 1.1; expected one below 1"},
    {"PronyTime", "young_modulus: 50 kPa", "prony: [{alpha: 0.6, tau: 0 s}]",
     "a.yaml:7: body.material.prony.0.tau: expected a time (s) > 0, got '0 s'"},
    {"PronyOfALawWithoutShape", "neo_hookean", "corotational, prony: [{alpha: 0.6, tau: 1 s}]",
     "a.yaml:7: body.material.prony: corotational does not split shape from volume"},
    {"PronyOfARegion", "  material:",
     "  regions: {half: {where: {half_space: {}}, prony: [{alpha: 0.6, tau: 1 s}, {alpha: 0.5, "
     "tau: 2 "
     "s}]}}\n  material:",
     "a.yaml:7: body.regions.half.prony: the sum of alpha is 1.1; expected one below 1"},
    {"FibresFromNowhere", "{model: neo_hookean, young_modulus: 50 kPa}",
     "{tissue: heart_muscle}\n  fibres: {from: {group: base}, to: {group: apex}}",
     "a.yaml:8: body.fibres.from.group: there is no group 'base': the meshes name none"},
    {"FibresWithoutEnd", "{model: neo_hookean, young_modulus: 50 kPa}",
     "{tissue: heart_muscle}\n  fibres: {from: {half_space: {}}}",
     "a.yaml:8: body.fibres.to is missing; fibres run from one set of vertices to another, "
     "expected both"},
    {"UnknownPreset", "gravity: [0, 0, -9.81]", "preset: led",
     "a.yaml:2: preset: unknown preset 'led'; did you mean 'tled'? (choices: tled)"},
    {"UnknownTissue", "{model: neo_hookean, young_modulus: 50 kPa}", "{tissue: heart}",
     "a.yaml:7: body.material.tissue: unknown tissue 'heart' (choices: heart_muscle, "
     "artery_adventitia, liver, kidney, fat, brain, skin)"},
    {"UnknownVolume", "{model: neo_hookean, young_modulus: 50 kPa}",
     "{model: mooney_rivlin, volume: log}",
     "a.yaml:7: body.material.volume: unknown volume 'log' (choices: simo_hughes, logarithmic, "
     "quadratic)"},
    {"Nothing", "1 s", "", "a.yaml:1: duration: expected a time (s) > 0, got nothing"},
    {"ScalarForList", "[0, 0, -9.81]", "-9.81",
     "a.yaml:2: gravity: expected a list of 3 accelerations (m/s^2), got '-9.81'"},
    {"ListLength", "[0, 0, -9.81]", "[0, -9.81]",
     "a.yaml:2: gravity: expected a list of 3 accelerations (m/s^2), got a list of 2"},
    {"ListEntry", "[0, 0, -9.81]", "[0, x, -9.81]",
     "a.yaml:2: gravity.1: expected an acceleration (m/s^2), got 'x', not a number"},
    {"MapForScalar", "1 s", "{s: 1}", "a.yaml:1: duration: expected a time (s) > 0, got a map (s)"},
    {"ScalarForMap", "{model: neo_hookean, young_modulus: 50 kPa}", "soft",
     "a.yaml:7: body.material: expected a map of keys, got 'soft'"},
    {"FractionalCount", "[4, 4, 4]", "[4, 4.5, 4]",
     "a.yaml:5: body.levels.0.box.cells.1: expected a whole number >= 1, got '4.5'"},
    {"CountTooSmall", "[2, 2, 2]", "[2, 2, 0]",
     "a.yaml:6: body.levels.1.box.cells.2: expected a whole number >= 1, got '0'"},
    {"CountTooLarge", "[2, 2, 2]", "[2000, 2000, 2000]",
     "a.yaml:6: body.levels.1: a mesh this fine makes the scene take about 1.68e+04 GB of memory; "
     "this machine has "},
    {"SubdividedTooOften", "subdivisions: 1", "subdivisions: 2000000000",
     "a.yaml:8: body.surface: a mesh this fine makes the scene take about "},
    {"TooFewPoints", "{box: {size: [10 cm, 10 cm, 10 cm], cells: [2, 2, 2]}}", "{coarsen: 20}",
     "a.yaml:6: body.levels.1.coarsen: expected a whole number >= 30, got '20'"},
    {"CoarsenFirst", "{box: {size: [0.1, 0.1, 0.1], cells: [4, 4, 4]}}", "{coarsen: auto}",
     "a.yaml:5: body.levels.0: coarsen makes coarse spaces of the mesh before it; expected a mesh "
     "first"},
    {"CoarsenInAPaperCycle", "{box: {size: [10 cm, 10 cm, 10 cm], cells: [2, 2, 2]}}",
     "{coarsen: auto}",
     "a.yaml:4: body.levels: coarsen makes spaces without elements, but cycle rsv integrates its "
     "coarser levels"},
    {"NotAFlag", "macro_step: 1 ms", "allow_unstable: yes",
     "a.yaml:11: integration.allow_unstable: expected true or false, got 'yes'"},
    {"UnknownName", "neo_hookean", "neohookean",
     "a.yaml:7: body.material.model: unknown material 'neohookean'; did you mean 'neo_hookean'? "
     "(choices: "},
    {"TwoAlternatives", "{plane: {point: [0, 0, -0.1]}, ", "{plane: {}, sphere: {radius: 1}, ",
     "a.yaml:14: contact.obstacles.0: expected only one of SHAPES, got a map (plane, sphere, "
     "friction)"},
    {"NoAlternative", "{plane: {point: [0, 0, -0.1]}, friction: 0.2}", "{friction: 0.2}",
     "a.yaml:14: contact.obstacles.0: expected one of SHAPES, got a map (friction)"},
    {"NoLevels",
     "    - {box: {size: [0.1, 0.1, 0.1], cells: [4, 4, 4]}}\n    - {box: {size: [10 cm, 10 cm, 10 "
     "cm], cells: [2, 2, "
     "2]}}\n",
     "    []\n", "a.yaml:5: body.levels: expected at least one entry, got a list of 0"},
    {"AutoMisspelt", "1 ms", "automatic",
     "a.yaml:11: integration.macro_step: expected a time (s) > 0, or auto, got 'automatic', not a "
     "number"},
    {"Substeps", "macro_step: 1 ms", "substeps: 0",
     "a.yaml:11: integration.substeps: expected a whole number >= 1, got '0'"},
    {"SubstepsPerLevel", "macro_step: 1 ms", "substeps: [auto, 2, 3]",
     "a.yaml:11: integration.substeps: expected one for all or one for each level (2 in "
     "body.levels), got a list of 3"},
    {"IntegratorPerLevel", "macro_step: 1 ms", "integrator: [rk4, rk4, rk4]",
     "a.yaml:11: integration.integrator: expected one for all or one for each level (2 in "
     "body.levels), got a list of "
     "3"},
    {"SharesPerLevel", "macro_step: 1 ms", "distribution: [1]",
     "a.yaml:11: integration.distribution: expected one for each level (2 in body.levels), got a "
     "list of 1"},
    {"SharesSum", "macro_step: 1 ms", "distribution: [0.5, 0.6]",
     "a.yaml:11: integration.distribution: the shares must add up to 1, got 1.1"},
    {"RimAboveRadius", "plane: {point: [0, 0, -0.1]}", "bowl: {radius: 1, rim: 2}",
     "a.yaml:14: contact.obstacles.0.bowl.rim is 2 m; expected at most the radius, 1 m"},
    {"NoNormal", "point: [0, 0, -0.1]", "normal: [0, 0, 0]",
     "a.yaml:14: contact.obstacles.0.plane.normal: expected a direction, got [0, 0, 0]"},
    {"BoxUpsideDown", "material:", "fixed: [{box: {min: [0, 0, 1], max: [1, 1, 0]}}]\n  material:",
     "a.yaml:7: body.fixed.0.box.min is [0, 0, 1] m; expected at most max, [1, 1, 0] m"},
    {"ScaleWithoutFile", "cells: [4, 4, 4]}}", "cells: [4, 4, 4]}, scale: 2}",
     "a.yaml:5: body.levels.0.scale: only a file has one"},
    {"MergeWithoutFile", "cells: [4, 4, 4]}}", "cells: [4, 4, 4]}, merge_duplicates: 0}",
     "a.yaml:5: body.levels.0.merge_duplicates: only a file has one"},
    {"LeaveOutWithoutFile", "cells: [4, 4, 4]}}", "cells: [4, 4, 4]}, leave_out: [0]}",
     "a.yaml:5: body.levels.0.leave_out: only a file has one"},
    {"SurfaceScaleWithoutFile", "subdivisions: 1}", "subdivisions: 1}, scale: 2",
     "a.yaml:8: body.surface.scale: only a file has one"},
    {"NoSurfaceKind", "sphere: {radius: 4 cm, subdivisions: 1}", "boundary: false",
     "a.yaml:8: body.surface.boundary: expected true, got 'false'; leave body.surface out to have "
     "none"},
    {"UnknownGroup", "material:", "fixed: [{group: left}]\n  material:",
     "a.yaml:7: body.fixed.0.group: there is no group 'left': the meshes name none"},
    {"MaterialOfARegion",
     "material:", "regions: {tumour: {material: {young_modulus: 1 kPa}}}\n  material:",
     "a.yaml:7: body.regions.tumour: unknown key 'material'; a region has the parameters of "
     "body.material's law without it, such as young_modulus"},
    {"UnknownRegion", "material:", "regions: {tumour: {density: 1}}\n  material:",
     "a.yaml:7: body.regions.tumour: there is no region 'tumour': the meshes name none"},
    {"MissingMesh", "{box: {size: [0.1, 0.1, 0.1], cells: [4, 4, 4]}}", "{file: nowhere.msh}",
     "a.yaml:5: there is no mesh file 'nowhere.msh' (its name is relative to the scene)"},
    {"StepOverDuration", "macro_step: 1 ms", "macro_step: 10 s",
     "a.yaml:11: integration.macro_step is 10 s; expected at most the duration, 1 s"},
    {"TooManyHalvings", "macro_step: 1 ms", "on_failure: {halvings: 11}",
     "a.yaml:11: integration.on_failure.halvings: expected a whole number in [0, 10], got '11'"},
    {"NotYaml", "gravity: [0, 0, -9.81]", "gravity: [0, 0, -9.81",
     "a.yaml:3: not YAML: a bracket is still open ("},
    {"Nul", "duration: 1 s", "name: \"a\\0b\"",
     "a.yaml:1: a text has the character NUL; expected text to read"},
    {"EscapeSequence",
     "gravity:", "gra\x1b[31mvty:", "a.yaml:2: unknown key 'gra\xef\xbf\xbd[31mvty'"},
    {"OpenQuote", "duration: 1 s", "duration: 1 s\nname: \"my run\"\nnotes: \"a \\\" b",
     "a.yaml:3: not YAML: a quote is not closed"},
    {"OpenSingleQuote", "duration: 1 s", "name: 'it''s mine",
     "a.yaml:1: not YAML: a quote is not closed"},
    {"Tab",
     "  material:", "\tmaterial:", "a.yaml:7: not YAML: a tab begins the line; expected spaces ("},
    {"Colon", "duration: 1 s", "name: soft: ball",
     "a.yaml:1: not YAML: expected quotes around a text with ': ' in it, and all keys of a map in "
     "one column ("},
    {"TwoDocuments",
     "gravity:", "---\ngravity:", "a.yaml:2: a second YAML document begins here; a scene is one"},
    {"StrayBrace", "duration: 1 s", "}", "a.yaml:"},
    {"AliasOfItself", "duration: 1 s", "duration: &a [*a]", "a.yaml:1: nested more than 50 deep"},
};

INSTANTIATE_TEST_SUITE_P(All, SceneError, testing::ValuesIn(damages),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace plica::app::test
