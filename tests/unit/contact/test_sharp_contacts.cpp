// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/meshes/boundary_triangles.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"

// Tips and ridges that fall on tips and ridges, exactly aligned: contacts without a good normal
// (K. Erleben, Methodology for assessing mesh-based contact point methods, ACM Trans. Graph. 37,
// 2018).
namespace {

using namespace plica;
using namespace plica::test;

constexpr double half = 0.02, height = 0.04;  // of the bases and shapes [m]

/// A tetrahedron on its base.
TetMesh spike() {
  TetMesh mesh;
  const double beside = half * std::sqrt(3.0) / 2;
  mesh.vertices = {{half, 0, 0}, {-half / 2, beside, 0}, {-half / 2, -beside, 0}, {0, 0, height}};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

/// A roof whose ridge lies along x.
TetMesh roof() {
  TetMesh mesh;
  mesh.vertices = {{-half, -half, 0}, {half, -half, 0},   {half, half, 0},
                   {-half, half, 0},  {-half, 0, height}, {half, 0, height}};
  mesh.tets = {{0, 1, 2, 5}, {0, 2, 3, 4}, {0, 2, 4, 5}};
  return mesh;
}

/// The shape upside down, with its tip or ridge at z = 0. `across`: its x and y exchanged, which
/// keeps orientation; else y is reversed with z.
TetMesh turned_over(TetMesh mesh, bool across) {
  for (Point& x : mesh.vertices)
    x = across ? Point(x[1], x[0], height - x[2]) : Point(x[0], -x[1], height - x[2]);
  return mesh;
}

Body jelly(TetMesh mesh, const Point& at) {
  for (Point& x : mesh.vertices) x += at;
  Body body = body_of({std::move(mesh)}, "neo_hookean").body;
  body.element = {"linear"};
  body.material.young_modulus = 1e5, body.material.poisson_ratio = 0.3;
  body.surface = boundary_surface(body.levels[0]).surface;
  return body;
}

struct Sharp {
  const char* name;
  TetMesh under, over;
  double aside;  ///< of the upper one along x [m]
};

/// The upper body falls 2 cm onto the lower one, whose base is held.
Problem falling(const Sharp& one, const std::string& integrator, double step) {
  Body under = jelly(one.under, Point::Zero());
  under.fixed = {HalfSpaceSelection{Point::Zero(), Point::UnitZ()}};
  Problem p;
  p.body =
      join_bodies({{"under", under}, {"over", jelly(one.over, {one.aside, 0, height + 0.0201})}});
  p.gravity = {0, 0, -9.81};
  p.contact.friction = 0.3;
  p.integration.integrator = {integrator};
  p.integration.macro_step = step;
  return p;
}

const std::vector<Sharp>& all_sharp() {
  static const std::vector<Sharp> all = {
      {"tip on tip", spike(), turned_over(spike(), false), half / 4},
      {"tip on ridge", roof(), turned_over(spike(), false), half / 4},
      {"ridge on tip", spike(), turned_over(roof(), true), 0},
      {"ridge across ridge", roof(), turned_over(roof(), true), 0},
      {"ridge along ridge", roof(), turned_over(roof(), false), 0}};
  return all;
}

// Nothing is put in, and damping of contact takes some: the sum of all energies never grows.
TEST(SharpContacts, MakeNoEnergyInImplicitSteps) {
  for (const Sharp& one : all_sharp())
    for (const auto& [integrator, step] : std::vector<std::pair<std::string, double>>{
             {"implicit_euler", 1e-3}, {"implicit_euler", 4e-3}, {"bdf2", 1e-3}}) {
      SCOPED_TRACE(one.name);
      SCOPED_TRACE(integrator + " " + std::to_string(step));
      Simulation<Host> s(falling(one, integrator, step));
      const double start = s.energies().total(),
                   fall = 9.81 * 0.02 * 7e-3;  // of a body of some 7 g [J]
      double most = start;
      while (s.time() < 0.2) {
        ASSERT_FALSE(s.step_checked()) << s.time();
        most = std::max(most, s.energies().total());
      }
      EXPECT_LE(most - start, 1e-3 * fall);
    }
}

// Depths of explicit steps follow the way that sites come and go: a site that counts as far inside
// by another face stores nothing. Their energy oscillates a little.
TEST(SharpContacts, MakeNoEnergyInExplicitSteps) {
  for (const Sharp& one : all_sharp()) {
    SCOPED_TRACE(one.name);
    Problem p = falling(one, "symplectic_euler", 0);
    p.integration.macro_step.reset();
    Simulation<Host> s(p);
    const double start = s.energies().total(), fall = 9.81 * 0.02 * 7e-3;  // [J]
    double most = start;
    while (s.time() < 0.2) {
      ASSERT_FALSE(s.step_checked()) << s.time();
      most = std::max(most, s.energies().total());
    }
    EXPECT_LE(most - start, 0.01 * fall);
  }
}

}  // namespace
