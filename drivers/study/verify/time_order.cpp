// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/drivers/solver/simulation.hpp>
#include <plica/drivers/study/sparse_stiffness.hpp>
#include <plica/drivers/study/verify/bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <stdexcept>

namespace plica {

namespace {

constexpr double duration = 0.016;  // [s]

std::vector<Point> positions_at_end(const std::string& integrator, double step) {
  Problem p = irregular_cube("neo_hookean", 2);
  p.integration.integrator = {integrator};
  p.integration.macro_step = step, p.integration.substeps = {1}, p.integration.allow_unstable = true;
  p.integration.implicit.relative_residual = 1e-12;
  p.integration.implicit.newton_iterations = 10, p.integration.implicit.newton_tolerance = 1e-11;
  p.body.damping.mass = 20;
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  std::vector<Point> v;
  for (const Point& X : p.body.levels[0].vertices) v.push_back(X[0] * Point(0.5, 1, -2));
  Simulation<HostBackend> simulation(p);
  simulation.set_state(std::vector<Point>(v.size(), Point::Zero()), v);
  for (long i = std::lround(duration / step); i > 0; --i) simulation.step();
  if (const auto bad = simulation.check()) throw std::runtime_error(bad->text());
  return simulation.positions();
}

// The order that the family's list states
double stated_order(const Choice& integrator) {
  const std::string words = "order ";
  const std::size_t at = integrator.summary.find(words);
  if (at == std::string::npos) throw std::runtime_error(integrator.name + " does not state its order");
  return std::stod(integrator.summary.substr(at + words.size()));
}

}  // namespace

VerifyRows time_order(const VerifyContext& context) {
  VerifyRows rows;
  const auto reference = positions_at_end("rk4", duration / 640);
  const std::vector<double> alike(reference.size(), 1 / static_cast<double>(reference.size()));
  for (const Choice& integrator : integrators()) {
    context.proceed();
    VerifyRow row{.quantity = integrator.name + ": positions off rk4's at 1/640 of the time, rms", .unit = "m"};
    row.accepted = stated_order(integrator), row.judged = Judged::order, row.tolerance = 0.1 * *row.accepted;
    row.source = "as `plica list integrators` states (Hairer & Wanner, Solving ODEs I and II)";
    const int most = *row.accepted > 2 ? 80 : 320;  // between coarse steps and round-off
    for (int steps = most / 4; steps <= most; steps *= 2)
      row.add(std::to_string(steps) + " steps", duration / steps,
              distance(positions_at_end(integrator.name, duration / steps), reference, alike));
    rows.push_back(row);
  }
  return rows;
}

}  // namespace plica
