// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

namespace plica {

namespace {
namespace incline {

constexpr double friction = 0.3, g = 10, size = 0.1, duration = 0.3;

double along(const Simulation<HostBackend>& simulation) {
  double sum = 0;
  const auto v = simulation.velocities();
  for (const Point& one : v) sum += one[0] / static_cast<double>(v.size());
  return sum;
}

/// Returns whether a block gains speed on a slope of this tangent, after the first impact.
bool slides(int n, double tangent) {
  Problem p = verify_body(box_mesh({{0, 0, 0}, {size, size, size}}, {n, n, n}),
                          {"corotational", 2e5, 0.3, 1000});
  const double angle = std::atan(tangent);
  p.gravity = g * Point(std::sin(angle), 0, -std::cos(angle));
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.contact.obstacles.push_back({PlaneOptions{}, friction, {}});
  Simulation<HostBackend> simulation(p);
  while (simulation.time() < duration) simulation.step();
  const double before = along(simulation), start = simulation.time();
  while (simulation.time() < 2 * duration) simulation.step();
  require_sound(simulation);
  return along(simulation) - before > 0.01 * g * tangent * (simulation.time() - start);
}

/// Returns the smallest tangent at which the block slides, by bisection.
double slips_at(int n) {
  double holds = 0.5 * friction, slips = 2 * friction;
  while (slips - holds > 1e-3 * friction) {
    const double middle = (holds + slips) / 2;
    (slides(n, middle) ? slips : holds) = middle;
  }
  return slips;
}

}  // namespace incline
}  // namespace

VerifyRows friction_on_a_slope(const VerifyContext& context) {
  VerifyRow row{.quantity = "tangent of the slope on which a block slips, friction 0.3",
                .unit = "1",
                .accepted = incline::friction};
  row.source = "Coulomb's law: tan(angle) = mu";
  row.judged = Judged::finest, row.tolerance = 0.02;
  row.note =
      "it slips where from 0.3 to 0.6 s it gains 1 % of the speed of free fall along the slope";
  for (const int n : {3, 6}) {
    context.proceed();
    row.add(cells_text(n, n, n), 1.0 / n, incline::slips_at(n));
    if (context.small) break;
  }
  return {row};
}

}  // namespace plica
