// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/lattice.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Elements that the body fills in part: what follows their part, and what does not.
namespace {

using namespace plica;
using namespace plica::test;

const Box beam_of_20_cm{Point::Zero(), {0.2, 0.05, 0.05}};

Problem clamped(std::vector<TetMesh> levels, const std::string& element, const std::string& cycle) {
  Problem p = body_of(std::move(levels), "neo_hookean");
  p.body.element = {element};
  p.body.fixed = {Box{Point::Constant(-0.1), {0.001, 0.2, 0.2}}};
  p.gravity = {0, 0, -9.81};
  p.integration.cycle = cycle;
  return p;
}

/// How all elements of half a body move is how all of a whole one do.
void expect_same_motion(const std::string& element, const std::string& cycle,
                        const std::string& integrator) {
  Problem whole = clamped({box_mesh(beam_of_20_cm, {8, 2, 2}), box_mesh(beam_of_20_cm, {4, 1, 1})},
                          element, cycle);
  whole.integration.integrator = {integrator};
  whole.integration.macro_step = 1e-3;
  whole.integration.implicit.relative_residual = 1e-12;
  Problem half = whole;
  for (TetMesh& mesh : half.body.levels) mesh.filled.assign(mesh.tets.size(), 0.5);
  Simulation<Host> a(whole), b(half);
  const auto &levels_a = a.levels(), &levels_b = b.levels();
  EXPECT_NEAR(levels_b[0].mass, levels_a[0].mass / 2, 1e-12);
  EXPECT_NEAR(levels_b[0].critical_step, levels_a[0].critical_step,
              1e-3 * levels_a[0].critical_step);
  EXPECT_EQ(levels_b[0].kind, LevelKind::lattice);
  EXPECT_NEAR(levels_b[0].filled, 0.5, 1e-12);
  advance(a, 40), advance(b, 40);
  const TetMesh& mesh = whole.body.levels[0];
  const double sag = largest(displacements(a, mesh));
  EXPECT_GT(sag, 1e-3);
  EXPECT_LT(largest_difference(a.positions(), b.positions()), 1e-7 * sag)
      << element << " " << cycle << " " << integrator;
  EXPECT_NEAR(b.energies().elastic, a.energies().elastic / 2, 1e-6 * a.energies().elastic);
  EXPECT_NEAR(b.energies().kinetic, a.energies().kinetic / 2, 1e-6 * a.energies().kinetic);
  const ElementFields fields_a = a.element_fields(0), fields_b = b.element_fields(0);
  for (std::size_t e = 0; e < fields_a.J.size(); ++e) {
    EXPECT_NEAR(fields_b.J[e], fields_a.J[e], 1e-8);
    EXPECT_NEAR(fields_b.von_mises[e], fields_a.von_mises[e], 1e-6 * 20e3);
  }
}

TEST(WeightedElements, HalfABodyMovesLikeAWholeOne) {
  for (const char* element : {"linear", "nodal"}) {
    for (const char* cycle : {"single", "rsv", "him"})
      expect_same_motion(element, cycle, "symplectic_euler");
    expect_same_motion(element, "single", "implicit_euler");
  }
}

// 28 cells of 9 mm long, between 5 and 6 across
const Box clamped_beam{{-0.051, 0, 0}, {0.201, 0.05, 0.05}};

TriangleSurface beam_surface() {
  return boundary_surface(box_mesh(clamped_beam, {1, 1, 1})).surface;
}

/// The lowest place of a beam's free end in the first 0.2 s, after half a period [m].
double deepest_sag(const TetMesh& mesh) {
  Problem p = clamped({mesh}, "nodal", "single");
  p.body.fixed = {Box{Point::Constant(-0.1), {-0.0059, 0.2, 0.2}}};  // four planes of vertices
  p.body.material.young_modulus = 200e3;
  p.body.surface = beam_surface();
  p.surface_forces = true;  // embeds it
  Simulation<Host> simulation(p);
  double lowest = 0;
  while (simulation.time() < 0.2) {
    advance(simulation, 1);
    lowest = std::min(
        lowest, simulation.surface_positions().back()[2] - p.body.surface->vertices.back()[2]);
  }
  return -lowest;
}

TEST(WeightedElements, ALatticeSagsLikeAMeshThatFits) {
  const TetMesh fits = box_mesh(clamped_beam, {28, 6, 6});
  WeightedLattice lattice = weighted_lattice(beam_surface(), 0.009);
  const double expected = deepest_sag(fits), weighted = deepest_sag(lattice.mesh);
  EXPECT_NEAR(weighted / expected, 1, 0.02);
  lattice.mesh.filled.clear();
  const double whole = deepest_sag(lattice.mesh);  // all of its cells: too thick
  EXPECT_LT(whole / expected, 0.9);
}

TEST(WeightedElements, DoNotShortenTheStep) {
  for (const char* element : {"linear", "nodal"}) {
    TetMesh mesh = weighted_lattice(beam_surface(), 0.009).mesh;
    const auto step = [&] {
      return Simulation<Host>(clamped({mesh}, element, "single")).levels()[0].critical_step;
    };
    const double weighted = step();
    mesh.filled.clear();
    EXPECT_GT(weighted, 0.95 * step()) << element;
  }
}

TEST(WeightedElements, FacesOfCellsAreNotTheBodys) {
  Problem p = clamped({weighted_lattice(beam_surface(), 0.01).mesh}, "nodal", "single");
  p.body.loads = {{Box{{0.1, -1, 0.04}, {1, 1, 1}}, Traction{{0, 0, 10}}, {}}};
  EXPECT_NE(refusal([&] { Simulation<Host>{p}; }).find("body.loads.0: "), std::string::npos);
  p.body.loads = {};
  p.body.levels[0].filled.back() = 0;
  EXPECT_NE(refusal([&] { Simulation<Host>{p}; }).find("is filled to 0; expected a part in (0, 1]"),
            std::string::npos);
}

}  // namespace
