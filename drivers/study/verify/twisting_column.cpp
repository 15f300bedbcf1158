// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>
#include <plica/drivers/solver/simulation.hpp>
#include <plica/drivers/study/sparse_stiffness.hpp>
#include <plica/drivers/study/verify/bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <stdexcept>

namespace plica {

namespace {

constexpr double height = 6, duration = 0.25, spin = 105,
                 steps_below_limit = 0.5;  // m, s, rad/s, stiffening stays below it

struct Twist {
  double largest = 0, when = 0, energy = 0;
};

Twist twist(int n) {
  Problem p =
      verify_body(box_mesh({{-0.5, 0, -0.5}, {0.5, height, 0.5}}, {n, 6 * n, n}), {"neo_hookean", 17e6, 0.45, 1100});
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {0, 1, 0}}};
  p.integration.macro_step = steps_below_limit * Simulation<HostBackend>(p).levels()[0].critical_step;
  Simulation<HostBackend> simulation(p);
  const TetMesh& mesh = p.body.levels[0];
  std::vector<Point> v;
  for (const Point& X : mesh.vertices)
    v.push_back(Point(0, spin * std::sin(std::numbers::pi * X[1] / (2 * height)), 0).cross(X));
  simulation.set_state(std::vector<Point>(v.size(), Point::Zero()), v);
  const Point corner(0.5, height, 0.5);
  const std::size_t probe = vertex_at(mesh, corner);
  const auto u = simulation.displacement();
  const double start = simulation.energies().total();
  Twist found;
  double angle = 0;
  for (long i = 0; simulation.time() < duration; ++i) {
    simulation.step();
    Kokkos::fence("plica::twisting_column");
    const double x = corner[0] + u(probe, 0), z = corner[2] + u(probe, 2);
    const double turned = std::atan2(corner[2], corner[0]) - std::atan2(z, x);  // about y, from z to x
    angle += std::remainder(turned - angle, 2 * std::numbers::pi);
    if (angle > found.largest) found.largest = angle, found.when = simulation.time();
    if (const auto bad = i % 50 == 0 ? simulation.check() : std::nullopt) throw std::runtime_error(bad->text());
  }
  found.energy = simulation.energies().total() / start - 1;
  return found;
}

}  // namespace

VerifyRows twisting_column(const VerifyContext& context) {
  VerifyRows rows = {{.quantity = "largest rotation of the top", .unit = "rad"},
                     {.quantity = "time of that", .unit = "s"},
                     {.quantity = "energy at 0.25 s over that at the start, less 1", .unit = "1", .accepted = 0}};
  rows[0].source = rows[1].source = "none: its own finest mesh";
  rows[0].note = rows[1].note =
      "E 17 MPa, nu 0.45: linear tetrahedra are too stiff, so it turns further as the mesh is refined";
  rows[2].source = "no outside work", rows[2].judged = Judged::size, rows[2].tolerance = 0.01;
  for (const int n : context.refined(4)) {
    context.proceed();
    const Twist found = twist(n);
    const std::string cells = cells_text(n, 6 * n, n);
    rows[0].add(cells, 1.0 / n, found.largest);
    rows[1].add(cells, 1.0 / n, found.when);
    rows[2].add(cells, 1.0 / n, found.energy);
  }
  return rows;
}

}  // namespace plica
