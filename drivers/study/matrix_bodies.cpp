// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/drivers/study/stability_matrix.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <random>

// Bodies of the stability matrix, and the lines of properties that vary.
namespace plica {

namespace {

const Box beam_box{{0, 0, 0}, {0.4, 0.1, 0.1}};
constexpr double earth = 9.81;

double length_of(const MatrixBody& body) {
  const Box box = bounding_box(body.problem.body.levels.front().vertices);
  return (box.max - box.min).maxCoeff();
}

/// Sets the start: level 0's vertices are at to(rest), and no load acts.
template <class To>
void start_at(MatrixBody& body, MatrixBody::Start start, const To& to) {
  body.displacement.clear();
  for (const Point& p : body.problem.body.levels.front().vertices)
    body.displacement.push_back(to(p) - p);
  body.load_ratio = 0, body.start = start;
}

void put_on_earth(MatrixBody& body, double factor) {
  const MaterialOptions& m = body.problem.body.material;
  body.load_ratio = m.density * factor * earth * length_of(body) / m.young_modulus;
}

}  // namespace

void MatrixBody::load() {
  const MaterialOptions& m = problem.body.material;
  if (load_ratio > 0)
    problem.gravity = {0, 0, -load_ratio * m.young_modulus / (m.density * length_of(*this))};
}

MatrixBody clamped_beam() {
  MatrixBody body;
  Body& b = body.problem.body;
  b.levels = {box_mesh(beam_box, {8, 2, 2}), box_mesh(beam_box, {4, 1, 1})};
  b.element = {"linear"};
  b.material = {"", 1e5, 0.4, 1000};
  b.fixed = {HalfSpaceSelection{Point::Zero(), Point::UnitX()}};
  return body;
}

void set_slivers(MatrixBody& body, double ratio) {
  for (Point& p : body.problem.body.levels.front().vertices)
    if (std::abs(p.x() - 0.2) < 1e-9) p.x() = 0.15 + 0.05 / ratio;
}

namespace {

MaterialOptions& material_of(MatrixBody& body) { return body.problem.body.material; }

void set_young_modulus(MatrixBody& body, double E) { material_of(body).young_modulus = E; }
void set_poisson_ratio(MatrixBody& body, double nu) { material_of(body).poisson_ratio = nu; }
void set_density(MatrixBody& body, double density) { material_of(body).density = density; }
void set_step(MatrixBody& body, double over_critical) { body.step = over_critical; }
void set_unstable_step(MatrixBody& body, double step) { body.step = step, body.unstable = true; }
void set_young_modulus_on_earth(MatrixBody& body, double E) {
  set_young_modulus(body, E), put_on_earth(body, 1);
}

void set_size(MatrixBody& body, double length) {
  const double scale = length / length_of(body);
  for (TetMesh& mesh : body.problem.body.levels)
    for (Point& p : mesh.vertices) p *= scale;
}

void set_stretch(MatrixBody& body, double factor) {
  start_at(body, MatrixBody::Start::stretched,
           [=](const Point& p) { return Point(factor * p.x(), p.y(), p.z()); });
}

/// Starts with the thickness along z multiplied by a factor: 0 flattens, below 0 inverts.
void set_thickness(MatrixBody& body, double factor) {
  using Start = MatrixBody::Start;
  const Start start = factor > 0     ? Start::thin
                      : factor == 0  ? Start::flat
                      : factor == -1 ? Start::mirrored
                                     : Start::turned;
  start_at(body, start,
           [=](const Point& p) { return Point(p.x(), p.y(), 0.05 + factor * (p.z() - 0.05)); });
}

void set_random(MatrixBody& body, double seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::uniform_real_distribution<double> within(0, 1);
  start_at(body, MatrixBody::Start::random, [&](const Point&) {
    const double x = within(random), y = within(random), z = within(random);
    return Point(beam_box.max.cwiseProduct(Point(x, y, z)));
  });
}

/// Lets the free body fall flat on a plane at this speed [m/s].
void set_impact(MatrixBody& body, double speed) {
  Body& b = body.problem.body;
  b.fixed.clear();
  const TetMesh& mesh = b.levels.front();
  b.surface = boundary_surface(mesh).surface;
  b.initial.velocity = {0, 0, -speed};
  b.initial.position = Point(0.2, 0.05, 0.051);
  body.problem.contact.obstacles = {{PlaneOptions{}, 0.3, {}}};
  body.load_ratio = 0;
  // impact speed over wave speed, about equal to the strain
  body.impact = speed / std::sqrt(b.material.young_modulus / b.material.density);
}

/// Makes the outer half `ratio` times as stiff as the inner one.
void set_contrast(MatrixBody& body, double ratio) {
  RegionOptions& stiff = body.problem.body.regions["stiff"];
  stiff.where = HalfSpaceSelection{{0.2, 0, 0}, -Point::UnitX()};
  stiff.young_modulus = ratio * body.problem.body.material.young_modulus;
}

void set_one_tetrahedron(MatrixBody& body, double edge) {
  TetMesh mesh;
  mesh.vertices = {{0, 0, 0}, {edge, 0, 0}, {0, edge, 0}, {0, 0, edge}};
  mesh.tets = {{0, 1, 2, 3}};
  body.problem.body.levels = {mesh};
  body.problem.body.fixed.clear();
}

void set_levels(MatrixBody& body, double count) {
  const std::array<int, 3> cells[] = {{12, 3, 3}, {10, 3, 3}, {8, 2, 2},
                                      {6, 2, 2},  {4, 1, 1},  {2, 1, 1}};
  body.problem.body.levels.clear();
  for (int i = 0; i < static_cast<int>(count); ++i)
    body.problem.body.levels.push_back(box_mesh(beam_box, cells[i]));
}

/// Moves level 1 along x by this number of beam lengths.
void set_overlap(MatrixBody& body, double lengths) {
  for (Point& p : body.problem.body.levels[1].vertices) p.x() += lengths * 0.4;
  body.apart = true;
  body.problem.body.fixed.clear();
}

}  // namespace

const std::vector<MatrixLine>& matrix_lines() {
  using Of = MatrixLine::Of;
  static const std::vector<MatrixLine> lines = {
      {"E = %g Pa", {1e2, 1e4, 1e6, 1e8, 1e10}, set_young_modulus},
      {"E = %g Pa on Earth", {1e10, 1e8, 1e6, 1e4, 1e2}, set_young_modulus_on_earth},
      {"nu = %g", {0, 0.3, 0.45, 0.49, 0.499}, set_poisson_ratio},
      {"density %g kg/m^3", {2e4, 1e3, 1}, set_density},
      {"length %g m", {1, 1e-2, 1e3, 1e-4}, set_size},
      {"%g x gravity", {1, 10, 100, 1000}, put_on_earth},
      {"%g x critical", {0.1, 1, 10, 100, 1000}, set_step, Of::implicit_alone},
      {"%g x critical", {1, 2, 4, 8, 16, 32, 64}, set_step, Of::him},
      {"%g x critical, refused", {1.01, 2, 100}, set_step, Of::explicit_alone},
      {"%g x critical, allowed", {1.05, 2, 10}, set_unstable_step, Of::explicit_alone},
      {"slivers 1 : %g", {10, 100, 1000}, set_slivers},
      {"stretched x %g", {2, 5}, set_stretch},
      {"flattened to %g", {0.01, 0}, set_thickness},
      {"turned inside out x %g", {-0.5, -1}, set_thickness},
      {"vertices at random, seed %g", {1, 2}, set_random},
      {"impact at %g m/s", {0.1, 1, 10, 50, 200}, set_impact},
      {"stiffness 1 : %g", {1e2, 1e4, 1e6}, set_contrast},
      {"one tetrahedron, edge %g m", {1e-3, 1}, set_one_tetrahedron},
      {"%g levels", {1, 2, 3, 4, 5, 6}, set_levels},
      {"levels %g lengths apart", {0.5, 0.9, 0.99}, set_overlap}};
  return lines;
}

}  // namespace plica
