// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/drivers/study/verify/box_meshes.hpp>
#include <plica/drivers/study/verify/contact_methods.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/generators.hpp>

namespace plica {

namespace {
namespace falling {

constexpr double height = 0.5, g = 9.81, density = 1000, young = 1e6;

/// Returns a soft block of 1 m above a plate that is 10 000 times as stiff.
Problem over_a_plate(const ContactMethod& method) {
  Body block = verify_body(box_mesh({{4.5, 4.5, height}, {5.5, 5.5, height + 1}}, {3, 3, 3}),
                           {"neo_hookean", young, 0, density})
                   .body;
  Body plate = verify_body(box_mesh({{0, 0, -2}, {10, 10, 0}}, {2, 2, 2}),
                           {"neo_hookean", 1e4 * young, 0, density})
                   .body;
  plate.fixed = {HalfSpaceSelection{{0, 0, -2}, {0, 0, 1}}};
  for (Body* body : {&block, &plate}) body->surface = boundary_surface(body->levels[0]).surface;
  Problem p;
  p.body = join_bodies({{"block", block}, {"plate", plate}});
  p.gravity = {0, 0, -g};
  method.apply(p);
  return p;
}

struct Impact {
  double peak = 0, impulse = 0, most = 0;
};

Impact impact(const ContactMethod& method) {
  const Problem p = over_a_plate(method);
  const auto mass = lumped_masses(p.body.levels[0], region_densities(p.body, p.body.levels[0]));
  const std::size_t own = 4 * 4 * 4;  // vertices of the block
  Simulation<HostBackend> simulation(p);
  const auto momentum = [&] {
    double sum = 0;
    const auto v = simulation.velocities();
    for (std::size_t a = 0; a < own; ++a) sum += mass[a] * v[a][2];
    return sum;
  };
  const double start = simulation.energies().total(), put_in = density * g * height,
               before = momentum();
  double pushed = 0;
  Impact found;
  run_until(simulation, 0.6, [&](const auto& s) {
    const double force = s.wrenches()[0].force[2];
    found.peak = std::max(found.peak, force), pushed += force * s.macro_step();
    found.most = std::max(found.most, (s.energies().total() - start) / put_in);
  });
  const double gained = momentum() - before + density * g * simulation.time();
  found.impulse = pushed / gained - 1;
  return found;
}

}  // namespace falling
}  // namespace

VerifyRows impact_on_a_plate(const VerifyContext& context) {
  using namespace falling;
  const double speed = std::sqrt(2 * g * height), front = std::sqrt(young * density) * speed,
               weight = density * g;
  VerifyRows rows = {
      {.quantity = "peak force over rho c v A + weight, less 1", .unit = "1"},
      {.quantity = "impulse over the change of momentum, less 1", .unit = "1"},
      {.quantity = "most total energy over that at the start, over the fall's", .unit = "1"},
      {.quantity = "peak force over rho c v A + weight, less 1, by other steps", .unit = "1"}};
  for (VerifyRow& row : rows) row.accepted = 0, row.judged = Judged::size;
  rows[0].source =
      "wave in a bar that meets a rigid wall, c = sqrt(E/rho) (Graff, Wave Motion in Elastic "
      "Solids, 2.4)";
  rows[1].source = "Newton's second law", rows[2].source = "nobody puts energy in",
  rows[3].source = rows[0].source;
  rows[0].tolerance = 0.22, rows[1].tolerance = 0.01, rows[2].tolerance = 1e-3;
  rows[0].note = "the block has three cells an edge";
  rows[3].judged = Judged::nothing;
  rows[3].note =
      "steps much shorter than the impact, or of second order, see the stiffness of contact on a "
      "coarse mesh";
  for (const ContactMethod& method : {ContactMethod{"implicit_euler", 5e-3},
                                      {"implicit_euler", 10e-3},
                                      {"bdf2", 5e-3},
                                      {"bdf2", 10e-3},
                                      {"sdirk2", 5e-3},
                                      {"central_difference"}}) {
    context.proceed();
    const Impact found = impact(method);
    rows[method.name == "implicit_euler" ? 0 : 3].add(method.text(), 1,
                                                      found.peak / (front + weight) - 1);
    rows[1].add(method.text(), 1, found.impulse);
    rows[2].add(method.text(), 1, found.most);
  }
  return rows;
}

namespace {
namespace thrown {

/// Returns the maximum increase of a thrown cube's total energy, over the kinetic energy at the
/// start. The cube hits a floor.
double surplus(const ContactMethod& method, double friction) {
  Problem p = touching_body(box_of("delaunay", {{0, 0, 0.01}, {0.1, 0.1, 0.11}}, {4, 4, 4}),
                            {"neo_hookean", 5e4, 0.4, 1000});
  p.body.initial.velocity = {0.5, 0.1, -1};
  p.body.initial.angular_velocity = {1, 2, 3};
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({PlaneOptions{}, friction, {}});
  method.apply(p);
  Simulation<HostBackend> simulation(p);
  const Energies at_start = simulation.energies();
  double most = 0;
  run_until(simulation, 0.4, [&](const auto& s) {
    most = std::max(most, (s.energies().total() - at_start.total()) / at_start.kinetic);
  });
  return most;
}

}  // namespace thrown
}  // namespace

VerifyRows thrown_cube(const VerifyContext& context) {
  VerifyRows rows;
  for (const double friction : {0.0, 0.5}) {
    VerifyRow row{
        .quantity =
            std::string(
                "most total energy over that at the start, over the throw's, less 1, friction ") +
            (friction > 0 ? "0.5" : "0"),
        .unit = "1"};
    row.mesh = "delaunay", row.accepted = 0, row.judged = Judged::size, row.tolerance = 0.01;
    row.source = "nobody puts energy in: contact at the end of the step (Kane et al. 1999)";
    for (const ContactMethod& method : {ContactMethod{"symplectic_euler"},
                                        {"newmark", 2e-3},
                                        {"newmark", 5e-3},
                                        {"implicit_euler", 5e-3},
                                        {"bdf2", 5e-3},
                                        {"sdirk2", 5e-3},
                                        {"generalized_alpha", 5e-3},
                                        {"him"}}) {
      if (context.small && method.name == "implicit_euler") break;
      context.proceed();
      row.add(method.text(), 1, thrown::surplus(method, friction));
    }
    rows.push_back(row);
  }
  return rows;
}

namespace {
namespace reacting {

/// Returns the largest force that wrenches and gravity leave unexplained, over the largest force of
/// floor and tool. It is the change of the cube's momentum in a step, over the step, less the
/// forces of floor, tool and gravity.
double unexplained(const ContactMethod& method) {
  Problem p = touching_body(box_of("delaunay", {{0, 0, 0}, {0.1, 0.1, 0.1}}, {4, 4, 4}),
                            {"neo_hookean", 2e4, 0.4, 1000});
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({PlaneOptions{}, 0.5, {}});
  p.contact.obstacles.push_back({SphereOptions{{0.05, 0.05, 0.131}, 0.03}, 0.3, {}});
  p.contact.obstacles[1].motion =
      PathMotion{{{0.0333, {0, 0, 0}}, {0.1217, {0.01, 0, -0.02}}, {0.2009, {0, 0, 0}}}};
  method.apply(p);
  p.integration.implicit.relative_residual = 1e-10;
  const BodySums sums(p.body);
  Simulation<HostBackend> simulation(p);
  Point before = sums.of(simulation.velocities());
  double most = 0, largest = 0;
  run_until(simulation, 0.25, [&](const auto& s) {
    const Point after = sums.of(s.velocities());
    Point force = sums.mass() * p.gravity;
    for (const Wrench& w : s.wrenches())
      force += w.force, largest = std::max(largest, w.force.norm());
    most = std::max(most, ((after - before) / s.macro_step() - force).norm());
    before = after;
  });
  return most / largest;
}

}  // namespace reacting
}  // namespace

VerifyRows reactions(const VerifyContext& context) {
  const auto row = [](const std::string& quantity, double tolerance) {
    VerifyRow made{.quantity = quantity, .unit = "1", .mesh = "delaunay", .accepted = 0};
    made.source = "Newton's second and third law";
    made.judged = Judged::size, made.tolerance = tolerance;
    return made;
  };
  const std::string start =
      "forces of floor and tool less what the momentum gains, most of all steps, over the "
      "largest: ";
  VerifyRows rows = {row(start + "explicit", 1e-9), row(start + "implicit", 0.01)};
  for (const ContactMethod& method :
       {ContactMethod{"symplectic_euler"}, {"central_difference"}, {"rk4"}, {"him"}}) {
    context.proceed();
    rows[0].add(method.text(), 1, reacting::unexplained(method));
  }
  rows[1].note =
      "what a step leaves unbalanced, at most 0.003 of the forces there are, is in no force";
  for (const ContactMethod& method : {ContactMethod{"implicit_euler", 5e-3},
                                      {"newmark", 5e-3},
                                      {"bdf2", 5e-3},
                                      {"sdirk2", 5e-3},
                                      {"generalized_alpha", 5e-3}}) {
    context.proceed();
    rows[1].add(method.text(), 1, reacting::unexplained(method));
  }
  return rows;
}

}  // namespace plica
