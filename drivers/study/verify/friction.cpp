// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>
#include <plica/drivers/study/verify/box_meshes.hpp>
#include <plica/drivers/study/verify/contact_methods.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/generators.hpp>

namespace plica {

namespace {
namespace slope {

constexpr double friction = 0.5, g = 9.81, degree = std::numbers::pi / 180;

/// Returns a block of soft tissue on a plane, in the plane's axes, with stiffness damping. Without
/// damping it would flutter as it slides, while Coulomb's slope is about rigid bodies. Cycle `him`
/// has no stiffness damping: it gets `mass_damping` [1/s] instead.
Problem block(const ContactMethod& method, double angle, double mass_damping = 0) {
  Problem p = touching_body(box_of("delaunay", {{0, 0, 0}, {0.1, 0.1, 0.05}}, {4, 4, 2}),
                            {"neo_hookean", 5e4, 0.4, 1000});
  p.gravity = g * Point(std::sin(angle), 0, -std::cos(angle));
  if (method.name == "him")
    p.body.damping.mass = mass_damping;
  else
    p.body.damping.stiffness = 2e-3;
  p.contact.obstacles.push_back({PlaneOptions{}, friction, {}});
  method.apply(p);
  return p;
}

/// Returns the largest speed of a vertex in the last 0.1 s [m/s].
double speed_at_rest(const ContactMethod& method, double angle, double duration) {
  Simulation<HostBackend> simulation(block(method, angle, 20));
  double largest = 0;
  run_until(simulation, duration - 0.1, [](const auto&) {});
  run_until(simulation, duration,
            [&](const auto& s) { largest = std::max(largest, largest_length(s.velocities())); });
  return largest;
}

/// Returns the mean acceleration along the slope from 0.2 s to 0.7 s over g (sin - mu cos), less 1.
double error_of_acceleration(const ContactMethod& method, double angle) {
  const Problem p = block(method, angle);
  const BodySums sums(p.body);
  Simulation<HostBackend> simulation(p);
  run_until(simulation, 0.2, [](const auto&) {});
  const double start = simulation.time(), before = sums.of(simulation.velocities())[0];
  run_until(simulation, 0.7, [](const auto&) {});
  const double gained =
      (sums.of(simulation.velocities())[0] - before) / sums.mass() / (simulation.time() - start);
  return gained / (g * (std::sin(angle) - friction * std::cos(angle))) - 1;
}

VerifyRow row(const std::string& quantity, const std::string& unit, double tolerance) {
  VerifyRow made{.quantity = quantity, .unit = unit, .mesh = "delaunay", .accepted = 0};
  made.source = "Coulomb's law: sticks where tan(angle) < mu, else g (sin - mu cos); friction 0.5";
  made.judged = Judged::size, made.tolerance = tolerance;
  return made;
}

}  // namespace slope
}  // namespace

VerifyRows sticking_and_slipping(const VerifyContext& context) {
  using namespace slope;
  const double limit = std::atan(friction), near = 0.3 * degree;
  VerifyRows rows = {
      row("largest speed after 1.5 s, 0.3 degrees below the friction angle", "m/s", 1e-6),
      row("acceleration 0.3 degrees above it over what Coulomb's law says, less 1", "1", 0.02),
      row("acceleration at 30 degrees, likewise", "1", 0.005),
      row("largest speed after 2 s at 10 degrees", "m/s", 1e-5),
      row("acceleration at 30 degrees over what Coulomb's law says, less 1", "1", 0.2)};
  for (const ContactMethod& method :
       {ContactMethod{"symplectic_euler"}, {"implicit_euler", 5e-3}, {"bdf2", 5e-3}}) {
    if (context.small && method.name == "bdf2") break;
    context.proceed();
    rows[0].add(method.text(), 1, speed_at_rest(method, limit - near, 1.5));
    rows[1].add(method.text(), 1, error_of_acceleration(method, limit + near));
    rows[2].add(method.text(), 1, error_of_acceleration(method, 30 * degree));
  }
  context.proceed();
  const ContactMethod him{"him"};
  rows[3].add("him", 1, speed_at_rest(him, 10 * degree, 2));
  rows[4].add("him", 1, error_of_acceleration(him, 30 * degree));
  rows[4].note = "undamped it flutters, and is carried less while a part of it is off the plane";
  return rows;
}

namespace {
namespace jaws {

constexpr double side = 0.05, lift = 0.1, squeeze = 3e-3;

ObstacleOptions jaw(double inward, double at) {
  ObstacleOptions o{BlockOptions{{at, side / 2, side / 2}, {0.02, 0.08, 0.08}}, 0.6, {}};
  const Point closed(inward * squeeze, 0, 0);
  o.motion = PathMotion{
      {{0.05, {0, 0, 0}}, {0.2, closed}, {0.25, closed}, {0.75, closed + Point(0, 0, lift)}}};
  return o;
}

/// Returns a cube between two jaws that close and lift it from the floor.
Problem gripped(const ContactMethod& method) {
  Problem p = touching_body(box_of("delaunay", {{0, 0, 0}, {side, side, side}}, {4, 4, 4}),
                            {"neo_hookean", 5e4, 0.45, 1000});
  p.gravity = {0, 0, -9.81};
  p.body.damping.mass = 20;
  p.contact.obstacles = {{PlaneOptions{}, 0.6, {}}, jaw(1, -0.01), jaw(-1, side + 0.01)};
  method.apply(p);
  return p;
}

}  // namespace jaws
}  // namespace

VerifyRows grip_and_lift(const VerifyContext& context) {
  using namespace jaws;
  VerifyRows rows = {{.quantity = "rise of the centre, less that of the jaws", .unit = "mm"},
                     {.quantity = "drift of the centre from 1.5 to 2.5 s", .unit = "mm"},
                     {.quantity = "force of the jaws over the weight, less 1", .unit = "1"}};
  for (VerifyRow& row : rows) {
    row.mesh = "delaunay", row.accepted = 0, row.judged = Judged::size;
    row.source =
        "Coulomb's law: 2 mu times the pressing force bears 16 times the weight, so it sticks; "
        "friction 0.6";
  }
  rows[0].tolerance = 1, rows[1].tolerance = 1e-3, rows[2].tolerance = 1e-3;
  rows[0].note = "it sags by its own weight between the jaws";
  for (const ContactMethod& method :
       {ContactMethod{"symplectic_euler"}, {"implicit_euler", 5e-3}, {"bdf2", 5e-3}}) {
    if (context.small && method.name == "bdf2") break;
    context.proceed();
    const Problem p = gripped(method);
    const BodySums sums(p.body);
    Simulation<HostBackend> simulation(p);
    const auto height = [&] { return sums.of(simulation.positions())[2] / sums.mass(); };
    const double start = height();
    run_until(simulation, 1.5, [](const auto&) {});
    const double held = height();
    run_until(simulation, 2.5, [](const auto&) {});
    const auto wrenches = simulation.wrenches();
    rows[0].add(method.text(), 1, 1e3 * (height() - start - lift));
    rows[1].add(method.text(), 1, 1e3 * (height() - held));
    rows[2].add(method.text(), 1,
                (wrenches[1].force + wrenches[2].force)[2] / (9.81 * sums.mass()) - 1);
  }
  return rows;
}

namespace {
namespace table {

constexpr double side = 0.06, quarter = std::numbers::pi / 2, shear = 1e-3;

/// Returns a cube on a table that a plate presses down and shears. Then table and plate turn by 90
/// degrees about the same axis.
Problem sheared(const ContactMethod& method) {
  Problem p = touching_body(box_of("delaunay", {{0, 0, 0}, {side, side, side}}, {4, 4, 4}),
                            {"neo_hookean", 5e4, 0.4, 1000});
  p.body.damping.mass = 20;
  const Point centre(side / 2, side / 2, 0), pressed(0, 0, -3e-3), along(shear, 0, 0);
  const PathTurn turned{{{1.3, 0}, {2.3, quarter}}};
  ObstacleOptions floor{PlaneOptions{centre, {0, 0, 1}}, 0.5, {}},
      plate{PlaneOptions{{0, 0, side}, {0, 0, -1}}, 0.5, {}};
  floor.turn = Turn{{0, 0, 1}, centre, {0, 0, 0}, turned};
  // the plate's axis moves with the plate, to the table's axis
  plate.turn = Turn{{0, 0, 1}, Point(centre - along), {0, 0, 0}, turned};
  plate.motion = PathMotion{{{0.1, {0, 0, 0}}, {0.3, pressed}, {0.5, pressed + along}}};
  p.contact.obstacles = {floor, plate};
  method.apply(p);
  return p;
}

}  // namespace table
}  // namespace

VerifyRows stuck_on_a_turntable(const VerifyContext& context) {
  using namespace table;
  VerifyRows rows = {
      {.quantity = "angle by which the cube has turned over that of the table, less 1",
       .unit = "1"},
      {.quantity = "friction of the table less the turned one of before, over it", .unit = "1"},
      {.quantity = "pressing force of the table over that before, less 1", .unit = "1"}};
  for (VerifyRow& row : rows) {
    row.mesh = "delaunay", row.accepted = 0, row.judged = Judged::size, row.tolerance = 0.01;
    row.source =
        "all turns as one rigid body: what sticks turns along, and its force with it; friction 0.5";
  }
  rows[1].tolerance = 0.02;
  rows[1].note = "some points at the rim slip";
  for (const ContactMethod& method :
       {ContactMethod{"symplectic_euler"}, {"implicit_euler", 5e-3}, {"bdf2", 5e-3}}) {
    if (context.small && method.name == "bdf2") break;
    context.proceed();
    const Problem p = sheared(method);
    const BodySums sums(p.body);
    Simulation<HostBackend> simulation(p);
    run_until(simulation, 1.25, [](const auto&) {});
    const Point before = simulation.wrenches()[0].force,
                from = sums.of(simulation.positions()) / sums.mass();
    const auto start = simulation.positions();
    run_until(simulation, 3, [](const auto&) {});
    const Point after = simulation.wrenches()[0].force,
                to = sums.of(simulation.positions()) / sums.mass();
    const auto end = simulation.positions();
    double sine = 0, cosine = 0;
    for (std::size_t a = 0; a < end.size(); ++a) {
      const Point r = start[a] - from, x = end[a] - to;
      cosine += r[0] * x[0] + r[1] * x[1], sine += r[0] * x[1] - r[1] * x[0];
    }
    rows[0].add(method.text(), 1, std::atan2(sine, cosine) / quarter - 1);
    rows[1].add(method.text(), 1,
                std::hypot(after[0] + before[1], after[1] - before[0]) / before.head<2>().norm());
    rows[2].add(method.text(), 1, after[2] / before[2] - 1);
  }
  return rows;
}

}  // namespace plica
