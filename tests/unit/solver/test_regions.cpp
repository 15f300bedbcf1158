// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/materials/material.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/gradients.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Regions of a mesh with constants of their own.
namespace {

using namespace plica;
using namespace plica::test;

Problem two_halves() {
  Problem p = body_of({with_regions(box_mesh(decimetre, {4, 4, 4}), 0.05, "stiff", "soft")}, "linear");
  p.body.regions["stiff"].young_modulus = 2e6;
  p.body.regions["stiff"].poisson_ratio = 0.1;
  return p;
}

template <class B>
class Regions : public testing::Test {};
TYPED_TEST_SUITE(Regions, EachBackend);

TYPED_TEST(Regions, HaveTheirOwnStress) {
  using Real = typename TypeParam::Real;
  const Problem p = two_halves();
  LevelProbe<TypeParam> probe(p);
  const double strain = 0.01, volume = 0.5e-3;
  std::vector<Point> u;
  for (const Point& x : p.body.levels[0].vertices) u.push_back({strain * x[0], 0, 0});
  const auto energy = [&](double E, double nu) {
    const auto c = lame_constants(E, nu);
    return (0.5 * c.lambda + c.mu) * strain * strain * volume;
  };
  const double want = energy(2e6, 0.1) + energy(20e3, 0.35);
  EXPECT_NEAR(probe.elastic_energy(u), want, round_off<Real>(5e3, want));
}

TYPED_TEST(Regions, PatchesDoNotSpanThem) {
  const Problem p = two_halves();
  LevelProbe<TypeParam> probe(p);
  const auto& patches = probe.at(0).model.patches;
  const auto host = [](const auto& view) { return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view); };
  const auto first = host(patches.first_pack), element = host(patches.element);
  std::vector<int> seen(p.body.levels[0].tets.size(), 0);
  for (int patch = 0; patch < patches.count; ++patch) {
    int region = -1;
    for (int slot = first(patch) * TypeParam::lanes; slot < first(patch + 1) * TypeParam::lanes; ++slot) {
      if (element(slot) < 0) continue;
      const auto e = static_cast<std::size_t>(element(slot));
      ++seen[e];
      if (region < 0) region = p.body.levels[0].region[e];
      EXPECT_EQ(region, p.body.levels[0].region[e]);
    }
  }
  for (int count : seen) EXPECT_EQ(count, 1);
}

// In series under one load each half stretches by its own modulus.
TEST(Regions, SoftHalfTakesTheStretch) {
  Problem p = body_of({with_regions(box_mesh(beam_box, {8, 2, 2}), 0.2, "stiff", "soft")}, "linear");
  p.body.material.poisson_ratio = 0;
  p.body.regions["stiff"].young_modulus = 80e3;
  p.body.fixed = {left_face()};
  p.body.prescribed = {{Box{{0.4, 0, 0}, {0.4, 0.1, 0.1}}, Point(0.01, 0, 0)}};
  p.body.damping.mass = 5;
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 0.1;
  Simulation<Host> simulation(p);
  advance(simulation, 10);  // pulled slowly to 10 mm within 1 s
  const auto u = displacements(simulation, p.body.levels[0]);
  double middle = 0;
  int count = 0;
  for (std::size_t a = 0; a < u.size(); ++a)
    if (std::abs(p.body.levels[0].vertices[a][0] - 0.2) < 1e-9) middle += u[a][0], ++count;
  EXPECT_NEAR(middle / count, 0.01 * 0.2, 2e-5);  // 1 : 4
}

TEST(Regions, GroupsSelectVertices) {
  Problem p = two_halves();
  p.body.levels[0].vertex_sets["corner"] = {0, 1, 7};
  p.body.fixed = {RegionSelection{"soft"}, GroupSelection{"corner"}};
  LevelProbe<Host> probe(p);
  const auto inverse = probe.inverse_mass();
  const auto& mesh = p.body.levels[0];
  for (std::size_t a = 0; a < inverse.size(); ++a) {
    const bool fixed = mesh.vertices[a][0] > 0.05 - 1e-9 || a == 0 || a == 1 || a == 7;
    if (std::abs(mesh.vertices[a][0] - 0.05) > 1e-9) {
      EXPECT_EQ(inverse[a] == 0, fixed) << a;
    }
  }
  p.body.fixed = {GroupSelection{"sofd"}};
  try {
    LevelProbe<Host> unknown(p);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean 'soft'?"), std::string::npos) << e.what();
  }
  p.body.fixed = {Box{{1, 1, 1}, {2, 2, 2}}};
  try {
    LevelProbe<Host> nothing(p);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("selects no vertex on level 0"), std::string::npos) << e.what();
  }
}

}  // namespace
