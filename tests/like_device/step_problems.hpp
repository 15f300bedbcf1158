// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/bodies.hpp"
#include "support/composite_box.hpp"

// What the tests of whole steps step.
namespace plica::test {

/// A cube that is thrown at a plane and slides on it.
inline Problem thrown(const std::string& cycle, int levels, const std::string& element) {
  Problem p = cube_levels(levels, 5, cycle);
  p.body.element = {element};
  p.body.material = {"neo_hookean", 20e3, 0.45, 1000};
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.body.initial.velocity = {0.3, 0, -0.5};
  p.body.initial.angular_velocity = {2, 0, 5};
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, -0.001}, {0, 0, 1}}, 0.3, {}});
  p.integration.macro_step = 5e-4;
  return p;
}

inline Problem viscous() {
  Problem p = thrown("single", 1, "nodal");
  p.body.material.prony = {{0.3, 0.01}, {0.2, 0.1}};
  p.body.damping.stiffness = 1e-4;
  return p;
}

inline Problem by_him() {
  Problem p = thrown("him", 1, "nodal");
  p.body.levels = {jittered_box(decimetre, {7, 7, 7})};
  p.body.coarsen.emplace();
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  return p;
}

/// By matrices; the first step is halved where it must be.
inline Problem implicit(const std::string& element, const std::string& preconditioner) {
  Problem p = thrown("single", 2, element);
  p.integration.cycle = "single", p.integration.integrator = {"implicit_euler"},
  p.integration.macro_step = 2e-3;
  p.integration.implicit.solver = "conjugate_gradients";
  p.integration.implicit.preconditioner = preconditioner;
  // where a solve ends depends on the order of its sums
  p.integration.implicit.relative_residual = 1e-10;
  return p;
}

/// Two cubes that meet, friction between them.
inline Problem collision() {
  std::vector<std::pair<std::string, Body>> cubes;
  for (const bool second : {false, true}) {
    Body one = thrown("rsv", 2, "linear").body;
    if (second)
      for (TetMesh& mesh : one.levels)
        for (Point& x : mesh.vertices) x += Point(0.02, 0.01, 0.101);
    one.surface = boundary_surface(one.levels[0]).surface;
    one.initial.velocity = {0, 0, second ? -1.0 : 1.0};
    cubes.emplace_back(second ? "second" : "first", one);
  }
  Problem p;
  p.body = join_bodies(cubes);
  p.contact.friction = 0.3, p.contact.self = true;
  p.integration.cycle = "rsv", p.integration.macro_step = 5e-4;
  return p;
}

/// All that is given as a function of time: vertices, loads, pressures, and tools that move, turn
/// and are pushed.
inline Problem driven(const std::string& cycle, const std::string& integrator) {
  Problem p = thrown(cycle, 2, "linear");
  p.integration.integrator = {integrator};
  p.body.initial = {};
  const Box left{{-1, -1, -1}, {0.001, 1, 1}}, right{{0.099, -1, -1}, {1, 1, 1}};
  p.body.prescribed = {{left, SineMotion{{0, 0.002, 0}, 50, 0}}};
  p.body.loads = {{right, TotalForce{{0, 0.1, 0}}, RampCourse{0.01}},
                  {right, FollowerPressure{200}, SineCourse{100, 0}}};
  ObstacleOptions turning{CapsuleOptions{{0.06, -0.1, 0.108}, {0.06, 0.2, 0.108}, 0.01}, 0.2,
                          SteadyMotion(Point(0, 0, -0.3))};
  turning.turn =
      Turn{.axis = {0, 0, 1}, .about = {}, .rotation = {0, 0, 0.1}, .angle = SteadyTurn{5}};
  ObstacleOptions heavy{
      SphereOptions{{0.04, 0.04, 0.114}, 0.015}, {}, SteadyMotion(Point(0, 0, -0.2))};
  heavy.mass = 0.05, heavy.coupling.stiffness = 100;
  p.contact.obstacles.push_back(turning), p.contact.obstacles.push_back(heavy);
  return p;
}

/// A beam whose finer half follows the coarser one at their border.
inline Problem pieces() {
  Problem p = thrown("single", 1, "nodal");
  p.body.levels = {composite_beam(false)};
  p.body.surface = boundary_surface(box_mesh(beam_box, {16, 4, 4})).surface;
  return p;
}

struct StepProblem {
  const char* name;
  Problem (*make)();
};

inline std::vector<StepProblem> step_problems() {
  return {{"explicit", [] { return thrown("single", 1, "linear"); }},
          {"viscous", &viscous},
          {"pieces", &pieces},
          {"rsv", [] { return thrown("rsv", 3, "nodal"); }},
          {"fas", [] { return thrown("fas", 3, "linear"); }},
          {"him", &by_him},
          {"implicit", [] { return implicit("linear", "block_jacobi"); }},
          {"multigrid", [] { return implicit("nodal", "multigrid"); }},
          {"collision", &collision},
          {"driven", [] { return driven("rsv", "symplectic_euler"); }},
          {"driven_implicit", [] { return driven("single", "implicit_euler"); }}};
}

}  // namespace plica::test
