// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <plica/drivers/run/simulation.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"

// A needle on tissue with a tumour, a tenth of an edge thick.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double side = 0.06, high = 0.03, edge = 5e-3, radius = 0.5e-3, lowered = 6e-3;  // [m]
constexpr int cells = 12;

/// Tissue of 5 kPa with a ball of 100 kPa under the middle of its top.
Problem tissue_with_tumour() {
  TetMesh mesh =
      with_slivers(jittered_box({{0, 0, 0}, {side, side, high}}, {cells, cells, cells / 2}));
  mesh.region_names = {"tissue", "tumour"};
  for (const auto& t : mesh.tets) {
    Point centre = Point::Zero();
    for (const int v : t) centre += mesh.vertices[static_cast<std::size_t>(v)] / 4;
    mesh.region.push_back((centre - Point(side / 2, side / 2, high - 0.011)).norm() < 8e-3);
  }
  Problem p = body_of({std::move(mesh)}, "neo_hookean");
  p.body.element = {"nodal"};
  p.body.material.young_modulus = 5e3, p.body.material.poisson_ratio = 0.45;
  p.body.regions["tumour"].young_modulus = 1e5;
  p.body.damping.mass = 40;
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.body.fixed = {HalfSpaceSelection{{0, 0, 1e-6}, {0, 0, 1}}};
  const Point tip(side / 2 + 0.3 * edge, side / 2 + 0.2 * edge, high + 2 * radius);
  p.contact.obstacles = {{CapsuleOptions{tip, tip + Point(0, 0, 0.1), radius}, 0.3, {}}};
  p.contact.obstacles[0].motion = PathMotion{{{0, {0, 0, 0}}, {0.2, {0, 0, -lowered - radius}}}};
  return p;
}

struct Felt {
  double force, deepest;  ///< on the needle at rest [N], of the needle in the surface [m]
};

Felt felt_by(const std::string& integrator, double step) {
  Problem p = tissue_with_tumour();
  p.integration.integrator = {integrator};
  if (step > 0) p.integration.macro_step = step;
  Simulation<Host> s(p);
  Felt felt{0, 0};
  while (s.time() < 0.5) {
    advance(s, 1);
    felt.deepest = std::max(felt.deepest, s.contact_depths()[0]);
  }
  felt.force = -s.wrenches()[0].force[2];
  return felt;
}

// It dents the tissue and does not pierce it, by long implicit steps as by explicit ones. The hand
// feels the same in all implicit steps, and a little less where sweeps leave contact softer.
TEST(Needle, IsStoppedOverATumourByEveryStep) {
  const Felt by_law = felt_by("implicit_euler", 2e-3), by_sweeps = felt_by("symplectic_euler", 0);
  EXPECT_GT(by_law.force, 0.1);
  EXPECT_GE(by_sweeps.force, 0.96 * by_law.force);
  EXPECT_LE(by_sweeps.force, 1.005 * by_law.force);
  for (const Felt& felt : {by_law, by_sweeps}) EXPECT_LT(felt.deepest, radius / 2);
  for (const auto& [integrator, step] : {std::pair{"implicit_euler", 8e-3}, {"bdf2", 2e-3}}) {
    const Felt felt = felt_by(integrator, step);
    EXPECT_LT(felt.deepest, radius / 2) << integrator;
    EXPECT_NEAR(felt.force, by_law.force, 0.005 * by_law.force) << integrator;
  }
}

}  // namespace
