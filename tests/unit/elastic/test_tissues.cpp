// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/drivers/study/sample_bodies.hpp>

#include "support/backends.hpp"

// Tissues by name against what their sources print.
namespace {

using namespace plica;
using namespace plica::test;

/// Returns the tissue with fibres along x and sheets along y, where its law has fibres.
MaterialOptions tissue_along_x(const std::string& name) {
  MaterialOptions m = tissue_material(name);
  if (find_material(m.model)->has_fibres) m.fibres = FibreOptions{Point::UnitX(), Point::UnitY()};
  return m;
}

/// Returns the stress of a small shear y += shear z of a box, over the shear [Pa].
double modulus_of_shear(MaterialOptions material) {
  material.prony.clear();
  Problem p = verify_body(box_mesh({{0, 0, 0}, {0.1, 0.1, 0.1}}, {2, 2, 2}), {});
  p.body.material = material;
  constexpr double shear = 1e-4, volume = 1e-3;
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(1, 2) = shear;
  LevelProbe<Host> probe(p);
  const TetMesh& mesh = p.body.levels[0];
  return virial(probe.force(affine_field(mesh, F, Point::Zero())), mesh)(1, 2) / (volume * shear);
}

struct Printed {
  const char* tissue;
  double shear_modulus;  ///< at rest, across the fibres [Pa]
  double density;        ///< [kg/m^3]
};

TEST(Tissues, HaveThePrintedShearModulusAtRest) {
  constexpr Printed all[] = {{"heart_muscle", 2000 * 2.0 / 2, 1000},  // a b_sn / 2
                             {"artery_adventitia", 7640, 1000},       // c
                             {"liver", 2000, 1060},
                             {"kidney", 4900, 1050},
                             {"fat", 530, 950},
                             {"brain", 842, 1040},
                             {"skin", 2 * 9400, 1090}};  // 2 (c10 + c01)
  std::vector<std::string> known;
  for (const Printed& printed : all) {
    SCOPED_TRACE(printed.tissue);
    known.push_back(printed.tissue);
    const MaterialOptions m = tissue_along_x(printed.tissue);
    EXPECT_NEAR(modulus_of_shear(m), printed.shear_modulus, 1e-6 * printed.shear_modulus);
    EXPECT_EQ(m.density, printed.density);
    EXPECT_EQ(m.tissue, printed.tissue);
  }
  EXPECT_EQ(known, names(tissues()));
}

// A body of each passes the checks of a run, and hardly changes its volume.
TEST(Tissues, AreAcceptedAndNearlyIncompressible) {
  for (const Choice& tissue : tissues()) {
    Body body;
    body.material = tissue_along_x(tissue.name);
    const MaterialInfo& info = *find_material(body.material.model);
    EXPECT_NO_THROW(check_parameters(info, body)) << tissue.name;
    const Lame<double> rest = info.small_strains(parameter_values(info, body.material, {}));
    EXPECT_GT((rest.lambda + 2 * rest.mu / 3) / rest.mu, 49) << tissue.name;
  }
}

// After a step of strain a part of 1 - sum of alpha is left in the end.
TEST(Tissues, RelaxByThePrintedParts) {
  const auto left = [](const char* tissue) {
    double part = 1;
    for (const PronyTerm& term : tissue_material(tissue).prony) part -= term.alpha;
    return part;
  };
  EXPECT_NEAR(left("fat"), 0.61, 1e-12);
  EXPECT_NEAR(left("brain"), 0.185, 1e-12);
  EXPECT_EQ(left("liver"), 1);
  EXPECT_EQ(tissue_material("fat").prony.at(0).tau, 700);
  EXPECT_EQ(tissue_material("brain").prony.at(1).tau, 50);
}

}  // namespace
