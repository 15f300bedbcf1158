// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/drivers/study/verify/box_meshes.hpp>
#include <plica/drivers/study/verify/contact_methods.hpp>
#include <plica/kernels/contact/shapes.hpp>

namespace plica {

namespace {
namespace pressed {

constexpr double side = 0.1, depth = 0.01, rest = 1.2;  // SI

/// Returns a cube on a floor with a ball above its top, which is pressed in.
Problem between(const ContactMethod& method, const std::string& element, int cells) {
  Problem p =
      touching_body(box_of("delaunay", {{0, 0, 0}, {side, side, side}}, {cells, cells, cells}),
                    {"neo_hookean", 2e4, 0.45, 1000});
  p.body.element = {element};
  p.body.damping.mass = 30;
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles = {{PlaneOptions{}, 0.5, {}},
                         {SphereOptions{{0.051, 0.048, side + 0.0305}, 0.03}, 0.3, {}}};
  p.contact.obstacles[1].motion = PathMotion{{{0, {0, 0, 0}}, {0.3, {0, 0, -depth}}}};
  method.apply(p);
  p.integration.implicit.relative_residual = 1e-8;
  return p;
}

struct Forces {
  double floor, ball, weight;  ///< upwards and downwards on the cube [N]
};

Forces at_rest(const Problem& p) {
  const BodySums sums(p.body);
  Simulation<HostBackend> simulation(p);
  run_until(simulation, rest, [](const auto&) {});
  const auto wrenches = simulation.wrenches();
  return {wrenches[0].force[2], -wrenches[1].force[2], 9.81 * sums.mass()};
}

}  // namespace pressed
}  // namespace

VerifyRows pressed_ball(const VerifyContext& context) {
  using namespace pressed;
  VerifyRows rows;
  for (const char* element : {"linear", "nodal"}) {
    VerifyRow balance{.quantity =
                          "force of a ball at rest over that of the floor less the weight, "
                          "less 1",
                      .unit = "1"};
    VerifyRow same{.quantity = "force of the ball over that of explicit steps, less 1",
                   .unit = "1"};
    VerifyRow by_him{.quantity = "the same by him", .unit = "1"};
    for (VerifyRow* row : {&balance, &same, &by_him})
      row->element = element, row->mesh = "delaunay", row->accepted = 0, row->judged = Judged::size;
    balance.source = "a body at rest: all forces are in balance", balance.tolerance = 0.02;
    balance.note = "implicit steps leave up to 0.003 of the forces unbalanced";
    same.source = by_him.source = "an equilibrium does not depend on the integrator";
    same.tolerance = 0.02, by_him.tolerance = 0.06;
    by_him.note = "its sweeps leave contact softer than the law";
    double by_explicit = 0;
    for (const ContactMethod& method : {ContactMethod{"symplectic_euler"},
                                        {"him"},
                                        {"implicit_euler", 20e-3},
                                        {"bdf2", 10e-3},
                                        {"sdirk2", 10e-3}}) {
      if (context.small && (method.name == "bdf2" || method.name == "sdirk2")) break;
      context.proceed();
      const Forces found = at_rest(between(method, element, context.small ? 4 : 6));
      if (by_explicit == 0) by_explicit = found.ball;
      balance.add(method.text(), 1, found.ball / (found.floor - found.weight) - 1);
      (method.name == "him" ? by_him : same).add(method.text(), 1, found.ball / by_explicit - 1);
    }
    rows.push_back(balance), rows.push_back(same), rows.push_back(by_him);
  }
  return rows;
}

}  // namespace plica
