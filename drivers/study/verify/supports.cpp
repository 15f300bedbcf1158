// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <plica/drivers/study/verify/radial.hpp>
#include <plica/kernels/materials/parameters.hpp>

// Runs of the cycle `rest` with rollers and turned ends, and the forces of these supports.
namespace plica {

namespace {
namespace supports {

FixedVertices along(const Point& point, const Point& normal, const char* axis) {
  FixedVertices held{HalfSpaceSelection{point, normal}};
  held.along = {axis};
  return held;
}

/// Outcome of a run: what supports do, those of body.fixed and then those of body.prescribed, and
/// where the vertices are.
struct Outcome {
  std::vector<Reaction> supports;
  std::vector<Point> positions;
};

/// Runs a problem to equilibrium at 1 s.
Outcome at_rest(Problem p) {
  p.integration.cycle = "rest";
  Simulation<HostBackend> simulation(p);
  while (simulation.time() < 1 - 1e-9) simulation.step();
  require_sound(simulation);
  return {simulation.reactions(), simulation.positions()};
}

VerifyRow row_of_run(const std::string& quantity, const char* unit, double accepted,
                     double tolerance, const std::string& source) {
  VerifyRow row{.quantity = quantity, .unit = unit, .element = "nodal", .accepted = accepted};
  row.source = source, row.judged = Judged::finest, row.tolerance = tolerance;
  return row;
}

/// Adds the forces on a cube of 0.1 m that is pressed between walls to 0.8 of its height.
void add_confined_block(VerifyRows& rows) {
  constexpr double edge_length = 0.1, squeeze = 0.8;
  const Lame<double> c = lame_constants(10e3, 0.3);
  const double kappa = c.lambda + 2 * c.mu / 3, mean = (squeeze * squeeze + 2) / 3,
               shape = c.mu * std::pow(squeeze, -5.0 / 3),
               volume = kappa / 2 * (squeeze - 1 / squeeze);
  const double top = (shape * (squeeze * squeeze - mean) + volume) * edge_length * edge_length,
               wall = (shape * (1 - mean) + volume) * edge_length * edge_length * squeeze;
  Problem p =
      verify_body(jittered_box({{0, 0, 0}, {edge_length, edge_length, edge_length}}, {4, 4, 4}),
                  {"neo_hookean", 10e3, 0.3, 1000});
  p.body.element = {"nodal"};
  p.body.fixed = {
      along(Point::Zero(), Point::UnitX(), "x"), along({edge_length, 0, 0}, -Point::UnitX(), "x"),
      along(Point::Zero(), Point::UnitY(), "y"), along({0, edge_length, 0}, -Point::UnitY(), "y"),
      along(Point::Zero(), Point::UnitZ(), "z")};
  const Point down(0, 0, (squeeze - 1) * edge_length);
  p.body.prescribed = {{HalfSpaceSelection{{0, 0, edge_length}, -Point::UnitZ()},
                        PathMotion{{{0, Point::Zero()}, {1, down}}}}};
  const std::vector<Reaction> found = at_rest(p).supports;
  constexpr const char* source =
      "closed form of the homogeneous deformation (Ogden, Non-Linear Elastic Deformations, 4.2)";
  const std::string what = "block between walls at 0.8 of its height: force of the ";
  rows.push_back(row_of_run(what + "top, prescribed", "N", top, 1e-4, source));
  rows.back().add(cells_text(4, 4, 4), 1, found.at(5).force[2]);
  rows.push_back(row_of_run(what + "wall at x = 0, fixed along x", "N", -wall, 1e-4, source));
  rows.back().add(cells_text(4, 4, 4), 1, found.at(0).force[0]);
  rows.push_back(row_of_run(what + "wall at y = 0.1 m, fixed along y", "N", wall, 1e-4, source));
  rows.back().add(cells_text(4, 4, 4), 1, found.at(3).force[1]);
  for (std::size_t i = rows.size() - 3; i < rows.size(); ++i) rows[i].mesh = "jittered";
}

/// Adds the forces on a quarter of a tube in plane strain under a pressure inside.
void add_tube(VerifyRows& rows) {
  constexpr double mm = 1e-3, tube_length = 0.5 * mm;
  const Lame<double> c = lame_constants(20e3, 0.45);
  const RadialWall wall{1 * mm, 1.5 * mm, false, 1, [=](const Radial& l) {
                          return neo_hookean_stress(l, c.mu, c.lambda + 2 * c.mu / 3);
                        }};
  const RadialState exact = inflated(wall, 1.1);
  TetMesh mesh = grid_mesh({4, 8, 1}, {false, false, false}, [&](const Point& s) {
    const double r = wall.inner + (wall.outer - wall.inner) * s[0],
                 angle = s[1] * std::numbers::pi / 2;
    return Point(r * std::cos(angle), r * std::sin(angle), tube_length * s[2]);
  });
  for (std::size_t a = 0; a < mesh.vertices.size(); ++a)
    if (mesh.vertices[a].head<2>().norm() < (1 + 1e-6) * wall.inner)
      mesh.vertex_sets["inner"].push_back(static_cast<int>(a));
  Problem p = verify_body(mesh, {"neo_hookean", 20e3, 0.45, 1000});
  p.body.element = {"nodal"};
  p.body.fixed = {
      along(Point::Zero(), Point::UnitX(), "x"), along(Point::Zero(), Point::UnitY(), "y"),
      along(Point::Zero(), Point::UnitZ(), "z"), along({0, 0, tube_length}, -Point::UnitZ(), "z")};
  p.body.loads = {
      {GroupSelection{"inner"}, FollowerPressure{exact.pressure}, PolygonCourse{{{0, 0}, {1, 1}}}}};
  const Outcome outcome = at_rest(p);
  const std::vector<Reaction>& found = outcome.supports;
  double open = 0;  // mean of both ends of the line where the inner wall meets x = 0 [m]
  for (const double z : {0.0, tube_length})
    open += outcome.positions[vertex_at(mesh, {0, wall.inner, z})][1] / 2;
  const std::string what = "tube in plane strain under a pressure inside: ",
                    cells = cells_text(4, 8, 1);
  rows.push_back(row_of_run(what + "force of x = 0 over the pressure times the open part of it",
                            "1", -1, 1e-4, "balance of forces"));
  rows.back().add(cells, 1, found.at(0).force[0] / (exact.pressure * open * tube_length));
  rows.push_back(row_of_run(what + "axial force of the ends", "mN", 1e3 * exact.axial, 0.01,
                            "radial equilibrium of the same law, to rounding"));
  rows.back().add(cells, 1, 1e3 * 2 * (found.at(3).force[2] - found.at(2).force[2]));
}

/// Adds the balance of the moments that turn the ends of a cylinder against each other.
void add_turned_end(VerifyRows& rows) {
  constexpr double disc = 0.01, tall = 0.04;
  Problem p = verify_body(cylinder_mesh(Point::Zero(), disc, tall, 4, 8),
                          {"neo_hookean", 10e3, 0.45, 1000});
  p.body.element = {"nodal"};
  p.body.fixed = {HalfSpaceSelection{Point::Zero(), Point::UnitZ()}};
  PrescribedMotion turned;
  turned.where = HalfSpaceSelection{{0, 0, tall}, -Point::UnitZ()};
  turned.rotate = Turn{.angle = PathTurn{{{0, 0}, {1, std::numbers::pi / 2}}}};
  p.body.prescribed = {turned};
  const std::vector<Reaction> found = at_rest(p).supports;
  rows.push_back(
      row_of_run("cylinder turned by a quarter of a turn: torque of the held end over "
                 "that of the other",
                 "1", -1, 1e-3, "balance of moments"));
  rows.back().add(cells_text(4, 4, 8), 1, found.at(0).torque[2] / found.at(1).torque[2]);
}

}  // namespace supports
}  // namespace

VerifyRows forces_of_supports(const VerifyContext& context) {
  VerifyRows rows;
  for (const auto add :
       {supports::add_confined_block, supports::add_tube, supports::add_turned_end}) {
    context.proceed();
    add(rows);
  }
  return rows;
}

}  // namespace plica
