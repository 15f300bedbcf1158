// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/drivers/study/verify/contact_methods.hpp>

namespace plica {

namespace {
namespace sharp {

constexpr double half = 0.02, height = 0.04, fall = 0.02, g = 9.81, density = 1000;  // SI

/// Returns a tetrahedron on its base.
TetMesh spike() {
  TetMesh mesh;
  const double beside = half * std::sqrt(3.0) / 2;
  mesh.vertices = {{half, 0, 0}, {-half / 2, beside, 0}, {-half / 2, -beside, 0}, {0, 0, height}};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

/// Returns a roof whose ridge lies along x.
TetMesh roof() {
  TetMesh mesh;
  mesh.vertices = {{-half, -half, 0}, {half, -half, 0},   {half, half, 0},
                   {-half, half, 0},  {-half, 0, height}, {half, 0, height}};
  mesh.tets = {{0, 1, 2, 5}, {0, 2, 3, 4}, {0, 2, 4, 5}};
  return mesh;
}

/// Returns the shape upside down, with its tip or ridge at z = 0. `across`: the ridge along y.
TetMesh turned_over(TetMesh mesh, bool across) {
  for (Point& x : mesh.vertices)
    x = across ? Point(x[1], x[0], height - x[2]) : Point(x[0], -x[1], height - x[2]);
  return mesh;
}

Body jelly(TetMesh mesh, const Point& at) {
  for (Point& x : mesh.vertices) x += at;
  return touching_body(std::move(mesh), {"neo_hookean", 1e5, 0.3, density}).body;
}

/// A lower body, held at its base, and an upper one that falls on it.
struct Pair {
  const char* name;
  TetMesh under, over;
  double aside;  ///< shift of the upper one along x [m]
};

struct Outcome {
  double surplus = 0;  ///< largest total energy over that at the start, over the fall's, less 1
  double depth = 0;    ///< largest depth of one in the other, over the mean edge
};

Outcome fallen(const Pair& pair, const ContactMethod& method) {
  Body under = jelly(pair.under, Point::Zero()),
       over = jelly(pair.over, {pair.aside, 0, height + 1.005 * fall});
  under.fixed = {HalfSpaceSelection{Point::Zero(), Point::UnitZ()}};
  const double weight = BodySums(over).mass() * g;
  Problem p;
  p.body = join_bodies({{"under", under}, {"over", over}});
  p.gravity = {0, 0, -g};
  p.contact.friction = 0.3;
  method.apply(p);
  Simulation<HostBackend> simulation(p);
  const double start = simulation.energies().total(), edge = simulation.levels()[0].mean_edge;
  Outcome found;
  while (simulation.time() < 0.2) {
    if (simulation.step_checked()) break;  // with the remedies of a run
    found.surplus =
        std::max(found.surplus, (simulation.energies().total() - start) / (weight * fall));
    found.depth = std::max(found.depth, simulation.pair_depth() / edge);
  }
  require_sound(simulation);
  return found;
}

}  // namespace sharp
}  // namespace

VerifyRows ridges(const VerifyContext& context) {
  using namespace sharp;
  VerifyRows rows = {
      {.quantity = "most total energy over that at the start, over the fall's", .unit = "1"},
      {.quantity = "depth of one in the other over an edge", .unit = "1"},
      {.quantity = "most total energy, likewise, by him", .unit = "1"},
      {.quantity = "depth of one in the other over an edge, by him", .unit = "1"}};
  for (VerifyRow& row : rows) row.mesh = "tips and ridges", row.accepted = 0;
  rows[0].source = rows[2].source = "nobody puts energy in";
  rows[1].source = rows[3].source = "they stay outside each other";
  rows[0].judged = rows[1].judged = Judged::size;
  rows[0].tolerance = 0.01, rows[1].tolerance = 0.02;
  rows[2].note = rows[3].note =
      "bodies of one to three tetrahedra are all detail, and him is not for impacts";
  const std::vector<Pair> pairs = {{"tip on tip", spike(), turned_over(spike(), false), half / 4},
                                   {"tip on ridge", roof(), turned_over(spike(), false), half / 4},
                                   {"ridge on tip", spike(), turned_over(roof(), true), 0},
                                   {"ridge across ridge", roof(), turned_over(roof(), true), 0},
                                   {"ridge along ridge", roof(), turned_over(roof(), false), 0}};
  for (const ContactMethod& method :
       {ContactMethod{"symplectic_euler"}, {"him"}, {"implicit_euler", 1e-3}, {"bdf2", 1e-3}}) {
    if (context.small && method.name == "bdf2") break;
    for (const Pair& pair : pairs) {
      context.proceed();
      const Outcome found = fallen(pair, method);
      const std::string of = method.text() + ", " + pair.name;
      const std::size_t first = method.name == "him" ? 2 : 0;
      rows[first].add(of, 1, found.surplus), rows[first + 1].add(of, 1, found.depth);
    }
  }
  return rows;
}

}  // namespace plica
