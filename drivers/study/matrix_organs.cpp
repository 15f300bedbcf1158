// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/text.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/drivers/study/stability_matrix.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/jitter.hpp>
#include <plica/meshes/organs.hpp>

// Organs with tools in the stability matrix: irregular meshes, friction, thin tools, folds. Every
// stepper must complete each run, at steps of 1 to 10 ms.
namespace plica {

namespace {

constexpr double rough = 0.3;  // coefficient of friction

struct OrganRun {
  Problem problem;
  double duration;  ///< [s]
};

Body organ_of(const TetMesh& regular, double young_modulus) {
  Body body;
  body.levels = {jittered(regular, 0.2)};
  body.material.model = "neo_hookean";
  body.material.young_modulus = young_modulus, body.material.density = 1050;
  body.damping.mass = 20;
  body.surface = boundary_surface(body.levels[0]).surface;
  return body;
}

/// Returns a liver, 16 cm long.
Body liver() { return organ_of(blob_mesh({0, 0, 0}, 0.16, 8), 2e3); }

Body held_liver() {
  Body body = liver();
  body.fixed = {HalfSpaceSelection{{0, 0, 0}, {0, 0, 1}}};
  return body;
}

Problem of_body(Body body) {
  Problem p;
  p.body = std::move(body);
  return p;
}

constexpr double above = 2e-3;  // distance of tools from the organ at the start [m]
const Point spot = {-0.01, 0.005, 0};

/// Returns the largest z of the organ within 15 mm of `spot` [m].
double top_of(const Body& body) {
  double highest = 0;
  for (const Point& x : body.levels[0].vertices)
    if (std::hypot(x.x() - spot.x(), x.y() - spot.y()) < 0.015) highest = std::max(highest, x.z());
  return highest;
}

/// Returns a fixed liver and a rod above it that moves along a path.
OrganRun under_a_rod(double radius, const std::vector<PathMotion::Knot>& knots) {
  Problem p = of_body(held_liver());
  const Point tip = spot + Point(0, 0, top_of(p.body) + above + radius);
  p.contact.obstacles = {
      {CapsuleOptions{tip, tip + Point(0, 0, 0.15), radius}, rough, PathMotion{knots}}};
  return {p, knots.back().time};
}

OrganRun drop() {
  Problem p = of_body(liver());
  double lowest = 0;
  for (const Point& x : p.body.levels[0].vertices) lowest = std::min(lowest, x.z());
  p.contact.obstacles = {{PlaneOptions{{0, 0, lowest - 1e-3}}, rough, {}}};
  p.body.initial.velocity = {0, 0, -1.2};
  p.gravity = {0, 0, -9.81};
  return {p, 0.15};
}

OrganRun poke() {
  return under_a_rod(
      8e-3, {{0, {0, 0, 0}}, {0.1, {0, 0, -0.012}}, {0.15, {0, 0, -0.012}}, {0.2, {0, 0, 0}}});
}
OrganRun drag() {
  return under_a_rod(4e-3, {{0, {0, 0, 0}}, {0.1, {0, 0, -0.012}}, {0.2, {0.02, 0, -0.012}}});
}
OrganRun needle() {
  return under_a_rod(5e-4, {{0, {0, 0, 0}}, {0.1, {0, 0, -0.008}}, {0.2, {0.01, 0, -0.008}}});
}

OrganRun grasp() {
  OrganRun run = under_a_rod(5e-3, {{0, {0, 0, 0}}, {0.05, {0, 0, 0}}, {0.2, {0.01, 0, 0.02}}});
  GraspOptions grasper;
  grasper.from = {0.02}, grasper.reach = 0.012;
  run.problem.contact.obstacles[0].grasp = grasper;
  return run;
}

OrganRun swing() {
  Problem p = of_body(liver());
  p.body.fixed = {HalfSpaceSelection{{-0.04, 0, 0}, {1, 0, 0}}};
  p.gravity = {9.81, 0, 0};
  return {p, 0.2};
}

OrganRun two_organs() {
  const Body lower = held_liver();
  Body ball = organ_of(ball_mesh({0, 0, 0}, 0.02, 6), 10e3);
  ball.initial.position = spot + Point(0, 0, top_of(lower) + above + 0.02),
  ball.initial.velocity = {0, 0, -0.5};
  Problem p = of_body(join_bodies({{"liver", lower}, {"ball", ball}}));
  p.gravity = {0, 0, -9.81}, p.contact.friction = rough;
  return {p, 0.15};
}

/// Returns a loop of gut that falls on its fixed end.
OrganRun folded_tube() {
  Problem p = of_body(organ_of(tube_mesh({.radius = 7e-3,
                                          .wall = 3e-3,
                                          .length = 0.2,
                                          .bend = 5.8,
                                          .around = 12,
                                          .across = 1,
                                          .along = 40}),
                               10e3));
  p.body.fixed = {GroupSelection{"inlet"}};
  p.gravity = {0, 0, 9.81};
  p.contact.self = true, p.contact.friction = rough;
  return {p, 0.2};
}

struct OrganScene {
  const char* name;
  OrganRun (*make)();
};
const OrganScene organ_scenes[] = {{"drop", drop},
                                   {"poke", poke},
                                   {"drag", drag},
                                   {"needle", needle},
                                   {"grasp", grasp},
                                   {"swing", swing},
                                   {"two organs", two_organs},
                                   {"folded tube", folded_tube}};

/// A method at a macro step [s].
struct OrganMethod {
  std::string name;  ///< name of a method, see StudyCase::method
  double step;
};

std::vector<OrganMethod> organ_methods(MatrixSize size) {
  const std::vector<double> steps = size == MatrixSize::small
                                        ? std::vector<double>{5e-3}
                                        : std::vector<double>{1e-3, 2e-3, 5e-3, 10e-3};
  std::vector<OrganMethod> all = {{"single/symplectic_euler", 1e-3}, {"cycle/him", 1e-3}};
  for (const char* integrator :
       {"implicit_euler", "bdf2", "sdirk2", "newmark", "generalized_alpha"})
    for (const double step : steps) all.push_back({std::string("single/") + integrator, step});
  return all;
}

void set_ratio(Body& body, double ratio) {
  body.material.poisson_ratio = ratio;
  for (auto& [name, region] : body.regions) region.poisson_ratio = ratio;
}

MatrixRow run_organ(const OrganScene& scene, const std::string& element, double ratio,
                    const OrganMethod& method) {
  OrganRun run = scene.make();
  Problem& p = run.problem;
  p.body.element = {element};
  set_ratio(p.body, ratio);
  p.integration.macro_step = method.step;  // sub-steps are automatic
  const std::string last = method.name.substr(method.name.find('/') + 1);
  if (last == "him")
    p.integration.cycle = last;
  else
    p.integration.integrator = {last};
  return run_case({text(scene.name, ", nu = ", number(ratio), ", ", number(1e3 * method.step),
                        " ms, ", element),
                   method.name,
                   p,
                   0,
                   std::lround(run.duration / method.step),
                   {},
                   {.complete = true}});
}

}  // namespace

std::vector<std::function<MatrixRow()>> organ_cases(MatrixSize size) {
  const bool small = size == MatrixSize::small;
  std::vector<std::function<MatrixRow()>> cases;
  for (const OrganScene& scene : organ_scenes)
    for (const char* element : {"linear", "nodal"})
      for (const double ratio :
           small ? std::vector<double>{0.49} : std::vector<double>{0.3, 0.45, 0.49})
        for (const OrganMethod& method : organ_methods(size))
          cases.push_back([=] { return run_organ(scene, element, ratio, method); });
  return cases;
}

}  // namespace plica
