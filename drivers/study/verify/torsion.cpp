// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

namespace {
namespace torsion {

constexpr double radius = 0.01, height = 0.04;  // [m]
constexpr double c10 = 4e3, c01 = 1e3;          // [Pa]
constexpr double angle = std::numbers::pi;      // turn of the upper end [rad]
constexpr double twist = angle / height;        // [rad/m]
constexpr double stiff = 500;                   // kappa over mu

/// Torque and force along the axis at the upper end.
struct EndLoad {
  double torque = 0;  ///< [N m]
  double force = 0;   ///< above 0 it pulls the end away [N]
};

/// Returns the reaction of an incompressible cylinder of Mooney and Rivlin's law.
EndLoad by_rivlin() {
  const double fourth = std::pow(radius, 4);
  return {std::numbers::pi * fourth * twist * (c10 + c01),
          -std::numbers::pi / 2 * fourth * twist * twist * (c10 + 2 * c01)};
}

/// Returns what turns the upper end of a cylinder by half a turn and keeps its length. The ends
/// turn as rigid discs.
/// @param n  cells per radius
EndLoad half_a_turn(const std::string& element, int n) {
  MaterialOptions material{"mooney_rivlin"};
  material.parameters = {{"c10", c10}, {"c01", c01}, {"bulk_modulus", stiff * 2 * (c10 + c01)}};
  Problem p = verify_body(cylinder_mesh(Point::Zero(), radius, height, 2 * n, 4 * n), material);
  p.body.element = {element};
  p.body.fixed = {HalfSpaceSelection{Point::Zero(), Point::UnitZ()},
                  HalfSpaceSelection{{0, 0, height}, -Point::UnitZ()}};
  const std::vector<Point>& X = p.body.levels[0].vertices;
  LevelProbe<HostBackend> probe(p);
  StaticOptions options;
  options.start = probe.zero();
  constexpr int steps = 8;
  for (int i = 0; i < steps; ++i) {
    for (std::size_t a = 0; a < X.size(); ++a) {
      const Eigen::AngleAxisd turn(angle / steps * X[a][2] / height, Point::UnitZ());
      options.start[a] = turn * (X[a] + options.start[a]) - X[a];
    }
    options.start = static_equilibrium(probe, options);
  }
  const auto force = probe.force(options.start);
  EndLoad reaction;
  for (std::size_t a = 0; a < X.size(); ++a)
    if (X[a][2] > height - 1e-9) {
      reaction.torque -= (X[a] + options.start[a]).cross(force[a])[2];
      reaction.force -= force[a][2];
    }
  return reaction;
}

}  // namespace torsion
}  // namespace

VerifyRows turned_cylinder(const VerifyContext& context) {
  VerifyRows rows;
  const torsion::EndLoad known = torsion::by_rivlin();
  for (const std::string element : {"linear", "nodal"}) {
    VerifyRow torque{.quantity = "torque of half a turn, length twice the diameter",
                     .unit = "mN m",
                     .element = element,
                     .accepted = 1e3 * known.torque};
    VerifyRow force{.quantity = "force along the axis that keeps the length (Poynting's effect)",
                    .unit = "mN",
                    .element = element,
                    .accepted = 1e3 * known.force};
    for (VerifyRow* row : {&torque, &force}) {
      row->source =
          "pi a^4 t (c10 + c01) and -pi a^4 t^2/2 (c10 + 2 c01), t the angle per length, a "
          "the radius at rest (Rivlin, Phil. Trans. R. Soc. A 242, 1949)";
      row->judged = element == "nodal" ? Judged::finest : Judged::nothing;
      row->tolerance = (context.small ? 0.15 : 0.08) * (row == &force ? 2 : 1);
      row->note = element == "nodal" ? "theirs is incompressible; here kappa is 500 times mu"
                                     : "linear tetrahedra lock near nu = 0.5";
    }
    for (const int n : context.small ? std::vector{2, 3} : std::vector{2, 4}) {
      context.proceed();
      const torsion::EndLoad found = torsion::half_a_turn(element, n);
      const std::string cells = cells_text(2 * n, 2 * n, 4 * n);
      torque.add(cells, 1.0 / n, 1e3 * found.torque);
      force.add(cells, 1.0 / n, 1e3 * found.force);
    }
    rows.push_back(torque), rows.push_back(force);
  }
  return rows;
}

}  // namespace plica
