// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

namespace plica {

namespace {
namespace colliding {

constexpr double radius = 0.05, speed = 0.5, askew = 0.01, duration = 0.08;  // SI

Body flying(const Point& from, const Point& velocity, int cells) {
  Body body = verify_body(ball_mesh(from, radius, cells), {"neo_hookean", 20e3, 0.35, 1000}).body;
  body.surface = boundary_surface(body.levels[0]).surface;
  body.initial.velocity = velocity;
  return body;
}

struct BallMomenta {
  Point momentum = Point::Zero(), spin = Point::Zero(), left = Point::Zero();
};

/// Returns linear and angular momentum of all vertices, and the linear momentum of the left ball.
/// The left ball has the first half of the vertices.
BallMomenta momenta_of_balls(const Simulation<HostBackend>& simulation,
                             const std::vector<double>& mass) {
  BallMomenta sums;
  const auto x = simulation.positions(), v = simulation.velocities();
  for (std::size_t a = 0; a < mass.size(); ++a) {
    sums.momentum += mass[a] * v[a], sums.spin += mass[a] * x[a].cross(v[a]);
    if (a < mass.size() / 2) sums.left += mass[a] * v[a];
  }
  return sums;
}

}  // namespace colliding
}  // namespace

VerifyRows collision(const VerifyContext& context) {
  using namespace colliding;
  VerifyRows rows = {
      {.quantity = "change of both balls' momentum, over one ball's", .unit = "1", .accepted = 0},
      {.quantity = "change of their angular momentum, over one ball's momentum times its radius",
       .unit = "1",
       .accepted = 0},
      {.quantity = "energy at the end over that at the start, less 1", .unit = "1", .accepted = 0},
      {.quantity = "momentum of the first ball along x afterwards, over that before", .unit = "1"}};
  rows[0].source = rows[1].source = "action is reaction, along one line";
  rows[0].judged = rows[1].judged = Judged::size, rows[0].tolerance = rows[1].tolerance = 1e-12;
  rows[2].source = "what contact's damping takes",
  rows[3].source = "-1 without vibrations and damping, head-on";
  for (const int n : {6, 10}) {
    if (context.small && n > 6) break;
    context.proceed();
    Problem p;
    p.body = join_bodies({{"left", flying({-1.01 * radius, 0, 0}, {speed, 0, 0}, n)},
                          {"right", flying({1.01 * radius, askew, 0}, {-speed, 0, 0}, n)}});
    Simulation<HostBackend> simulation(p);
    const std::vector<double> mass =
        lumped_masses(p.body.levels[0], region_densities(p.body, p.body.levels[0]));
    const BallMomenta before = momenta_of_balls(simulation, mass);
    const double energy = simulation.energies().total(), one = before.left.norm();
    while (simulation.time() < duration) simulation.step();
    require_sound(simulation);
    const BallMomenta after = momenta_of_balls(simulation, mass);
    rows[0].add(cells_text(n, n, n), 1.0 / n, (after.momentum - before.momentum).norm() / one);
    rows[1].add(cells_text(n, n, n), 1.0 / n, (after.spin - before.spin).norm() / (one * radius));
    rows[2].add(cells_text(n, n, n), 1.0 / n, simulation.energies().total() / energy - 1);
    rows[3].add(cells_text(n, n, n), 1.0 / n, after.left[0] / before.left[0]);
  }
  return rows;
}

}  // namespace plica
