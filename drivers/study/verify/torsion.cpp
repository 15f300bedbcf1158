// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

namespace {
namespace torsion {

constexpr double radius = 0.01, height = 0.04;  // [m]
constexpr double c10 = 4e3, c01 = 1e3;          // [Pa]
constexpr double angle = std::numbers::pi;      // turn of the upper end [rad]

/// Torque and force along the axis at the upper end.
struct EndLoad {
  double torque = 0;  ///< [N m]
  double force = 0;   ///< above 0 it pulls the end away [N]
};

/// Returns the load of an incompressible cylinder of Mooney and Rivlin's law.
EndLoad by_rivlin() {
  const double fourth = std::pow(radius, 4), twist = angle / height;
  return {std::numbers::pi * fourth * twist * (c10 + c01),
          -std::numbers::pi / 2 * fourth * twist * twist * (c10 + 2 * c01)};
}

/// Returns what turns the upper end of a cylinder by half a turn and keeps its length, in a run of
/// the cycle `rest`. The ends stay discs.
/// @param n  cells per radius
EndLoad half_a_turn(int n) {
  MaterialOptions material{"mooney_rivlin"};
  material.parameters = {{"c10", c10}, {"c01", c01}, {"bulk_modulus", 500 * 2 * (c10 + c01)}};
  Problem p = verify_body(cylinder_mesh(Point::Zero(), radius, height, 2 * n, 4 * n), material);
  p.body.element = {"nodal"};
  p.body.fixed = {HalfSpaceSelection{Point::Zero(), Point::UnitZ()}};
  PrescribedMotion turned;
  turned.where = HalfSpaceSelection{{0, 0, height}, -Point::UnitZ()};
  turned.rotate = Turn{.angle = PathTurn{{{0, 0}, {1, angle}}}};
  p.body.prescribed = {turned};
  p.integration.cycle = "rest";
  Simulation<HostBackend> simulation(p);
  while (simulation.time() < 1 - 1e-9) simulation.step();
  require_sound(simulation);
  const Reaction end = simulation.reactions().at(1);
  return {end.torque[2], end.force[2]};
}

}  // namespace torsion
}  // namespace

VerifyRows turned_cylinder(const VerifyContext& context) {
  const torsion::EndLoad known = torsion::by_rivlin();
  VerifyRow torque{.quantity = "torque of half a turn, length twice the diameter",
                   .unit = "mN m",
                   .element = "nodal",
                   .accepted = 1e3 * known.torque};
  VerifyRow force{.quantity = "force along the axis that keeps the length (Poynting's effect)",
                  .unit = "mN",
                  .element = "nodal",
                  .accepted = 1e3 * known.force};
  for (VerifyRow* row : {&torque, &force}) {
    row->source =
        "pi a^4 t (c10 + c01) and -pi a^4 t^2/2 (c10 + 2 c01), t the angle per length, a the "
        "radius at rest (Rivlin, Phil. Trans. R. Soc. A 242, 1949)";
    row->judged = Judged::finest, row->tolerance = context.small ? 0.08 : 0.05;
    row->note = "theirs is incompressible; here kappa is 500 times mu";
  }
  for (const int n : context.small ? std::vector{2, 3} : std::vector{2, 4}) {
    context.proceed();
    const torsion::EndLoad found = torsion::half_a_turn(n);
    const std::string cells = cells_text(2 * n, 2 * n, 4 * n);
    torque.add(cells, 1.0 / n, 1e3 * found.torque);
    force.add(cells, 1.0 / n, 1e3 * found.force);
  }
  return {torque, force};
}

}  // namespace plica
