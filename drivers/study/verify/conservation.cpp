// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/solver/simulation.hpp>
#include <plica/drivers/study/sparse_stiffness.hpp>
#include <plica/drivers/study/verify/bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <stdexcept>

namespace plica {

namespace {

constexpr int macro_steps = 50;

// A free cube that spins, moves and shakes, without loads
Problem free_body(const std::string& cycle, const std::string& integrator) {
  Problem p = irregular_cube("st_venant_kirchhoff", 4);
  if (cycle != "single") {
    p.body.levels.push_back(irregular_cube("", 3).body.levels[0]);
    p.body.levels.push_back(irregular_cube("", 2).body.levels[0]);
  }
  p.integration.cycle = cycle, p.integration.integrator = {integrator};
  p.integration.macro_step = 2e-4;
  p.integration.allow_unstable = true;  // euler always is; so short a run shows little of it
  p.integration.implicit.relative_residual = 1e-13, p.integration.implicit.newton_iterations = 10;
  p.integration.implicit.newton_tolerance = 1e-12;
  return p;
}

struct Budget {
  Point linear = Point::Zero(), angular = Point::Zero();
  double energy = 0;
};

// Changes over the run: of the linear and angular momentum over the sum of m |v| and m |x| |v|, of the energy over the kinetic
std::array<double, 3> changes(const Problem& p) {
  const TetMesh& mesh = p.body.levels[0];
  Problem alone = p;
  alone.integration.cycle = "single", alone.body.levels.resize(1);
  const std::vector<double> m = LevelProbe<HostBackend>(alone).mass();
  Simulation<HostBackend> simulation(p);
  auto v = random_field(mesh.vertices.size(), 0.05, 3);
  double impulse = 0;
  for (std::size_t a = 0; a < v.size(); ++a) {
    v[a] += Point(0.1, 0.2, -0.1) + Point(2, -1, 3).cross(mesh.vertices[a]);
    impulse += m[a] * v[a].norm();
  }
  simulation.set_state(std::vector<Point>(v.size(), Point::Zero()), v);
  const auto take = [&] {
    Budget now;
    const auto x = simulation.positions(), w = simulation.velocities();
    for (std::size_t a = 0; a < x.size(); ++a) now.linear += m[a] * w[a], now.angular += m[a] * x[a].cross(w[a]);
    now.energy = simulation.energies().total();
    return now;
  };
  const Budget before = take();
  for (int i = 0; i < macro_steps; ++i) simulation.step();
  if (const auto bad = simulation.check()) throw std::runtime_error(bad->text());
  const Budget after = take();
  return {(after.linear - before.linear).norm() / impulse, (after.angular - before.angular).norm() / (0.1 * impulse),
          after.energy / before.energy - 1};
}

}  // namespace

VerifyRows conservation(const VerifyContext& context) {
  VerifyRows rows = {{.quantity = "change of linear momentum over the sum of m |v|"},
                     {.quantity = "change of angular momentum over 0.1 m times that"},
                     {.quantity = "change of energy, relative"}};
  for (VerifyRow& row : rows) row.unit = "1", row.accepted = 0, row.source = "Newton's third law; no outside force";
  rows[0].judged = Judged::size, rows[0].tolerance = 1e-11;
  rows[1].note = "conserved by symplectic_euler; reported of the others";
  rows[2].note = "dissipative and growing integrators among them: reported";
  const auto add = [&](const std::string& name, const Problem& p) {
    context.proceed();
    const auto found = changes(p);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].add(name, 1, found[i]);
  };
  for (const std::string& integrator : names(integrators()))
    add("single/" + integrator, free_body("single", integrator));
  for (const char* cycle : {"fas", "him"}) add(std::string("cycle/") + cycle, free_body(cycle, "symplectic_euler"));
  return rows;
}

}  // namespace plica
