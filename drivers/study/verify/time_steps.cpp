// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/small_motion.hpp>
#include <plica/drivers/study/stability.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

namespace {

constexpr double duration = 0.016;  // [s]

std::vector<Point> positions_at_end(const std::string& integrator, double step) {
  Problem p = irregular_cube("neo_hookean", 2);
  p.integration.integrator = {integrator};
  p.integration.macro_step = step, p.integration.substeps = {1},
  p.integration.allow_unstable = true;
  p.integration.implicit.relative_residual = 1e-12;
  p.integration.implicit.newton_iterations = 10, p.integration.implicit.newton_tolerance = 1e-11;
  p.body.damping.mass = 20;
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  std::vector<Point> v;
  for (const Point& X : p.body.levels[0].vertices) v.push_back(X[0] * Point(0.5, 1, -2));
  Simulation<HostBackend> simulation(p);
  simulation.set_state(std::vector<Point>(v.size(), Point::Zero()), v);
  for (long i = std::lround(duration / step); i > 0; --i) simulation.step();
  require_sound(simulation);
  return simulation.positions();
}

}  // namespace

VerifyRows time_order(const VerifyContext& context) {
  VerifyRows rows;
  const auto reference = positions_at_end("rk4", duration / 640);
  const std::vector<double> alike(reference.size(), 1 / static_cast<double>(reference.size()));
  Integrators::for_each([&](auto integrator) {
    using Kind = decltype(integrator);
    const std::string name = Kind::name;
    context.proceed();
    VerifyRow row{
        .quantity =
            name + ": difference of positions from rk4 with steps of 1/640 of the time, rms",
        .unit = "m"};
    row.accepted = Kind::order, row.judged = Judged::order, row.tolerance = 0.1 * *row.accepted;
    row.source = "as `plica list integrators` states (Hairer & Wanner, Solving ODEs I and II)";
    const int most =
        *row.accepted > 2 ? 80 : 320;  // steps that are neither too coarse nor limited by round-off
    for (int steps = most / 4; steps <= most; steps *= 2)
      row.add(std::to_string(steps) + " steps", duration / steps,
              distance(positions_at_end(name, duration / steps), reference, alike));
    rows.push_back(row);
  });
  return rows;
}

namespace {

Problem at_any_step(int cells, const std::string& integrator) {
  Problem p = irregular_cube("linear", cells);
  p.integration.integrator = {integrator};
  p.integration.substeps = {1}, p.integration.allow_unstable = true,
  p.integration.macro_step = 1e-7;
  return p;
}

// Compares the critical step with eigenvalues of the dense matrix M^-1/2 K M^-1/2
VerifyRow against_eigenvalues(int cells) {
  LevelProbe<HostBackend> probe(at_any_step(cells, "symplectic_euler"));
  const Eigen::MatrixXd S = probe.scaled_by_mass(probe.stiffness_matrix(probe.zero()));
  const double w2 = symmetric_eigenvalues(S).maxCoeff();
  VerifyRow row{.quantity = "predicted critical step, symplectic_euler",
                .unit = "s",
                .accepted = 2 / std::sqrt(w2)};
  row.source =
      "2/w_max, dense eigenvalues of the same matrices (Hughes, The Finite Element Method, 9.2)";
  row.judged = Judged::finest, row.tolerance = 0.02;
  row.note = "too small by up to 1e-3, which is added to the eigenvalue for safety";
  row.add(cells_text(cells, cells, cells) + ", irregular", 1, probe.built.reports[0].critical_step);
  return row;
}

VerifyRow against_runs(const std::string& integrator, double predicted, int cells) {
  const auto stable = [&](double t) {
    Problem p = at_any_step(cells, integrator);
    p.integration.macro_step = t;
    auto built = build_hierarchy<HostBackend>(p, {});
    return small_motion(built, t, {2000, {}}).bounded;
  };
  VerifyRow row{
      .quantity = "largest stable step of runs, " + integrator, .unit = "s", .accepted = predicted};
  row.source =
      "its own prediction before the run; the scalar test equation (Hairer & Wanner, Solving ODEs "
      "II, IV.2)";
  row.judged = Judged::finest, row.tolerance = 0.02;
  const LargestStep found =
      largest_stable({0.97 * predicted, 0.5 * predicted, 2 * predicted, 1.02, 0.002}, stable);
  row.add(cells_text(cells, cells, cells) + ", irregular", 1, found.step);
  return row;
}

}  // namespace

VerifyRows critical_steps(const VerifyContext& context) {
  const int cells = context.small ? 3 : 4;
  context.proceed();
  VerifyRows rows = {against_eigenvalues(cells)};
  for (const std::string& integrator : names(integrators())) {
    context.proceed();
    const LevelReport report =
        LevelProbe<HostBackend>(at_any_step(cells, integrator)).built.reports[0];
    if (report.explicit_integrator &&
        report.critical_step > 0)  // euler has no limit without damping
      rows.push_back(against_runs(integrator, report.critical_step, cells));
  }
  return rows;
}

namespace {

constexpr int bit_steps = 50;

// Returns a free cube without loads, which will spin, move and vibrate
Problem free_body(const std::string& cycle, const std::string& integrator) {
  Problem p = irregular_cube("st_venant_kirchhoff", 4);
  if (cycle != "single") {
    p.body.levels.push_back(irregular_cube("", 3).body.levels[0]);
    p.body.levels.push_back(irregular_cube("", 2).body.levels[0]);
  }
  p.integration.cycle = cycle, p.integration.integrator = {integrator};
  p.integration.macro_step = 2e-4;
  p.integration.allow_unstable = true;  // euler always is unstable; a short run grows little
  p.integration.implicit.relative_residual = 1e-13, p.integration.implicit.newton_iterations = 10;
  p.integration.implicit.newton_tolerance = 1e-12;
  return p;
}

struct Budget {
  Point linear = Point::Zero(), angular = Point::Zero();
  double energy = 0;
};

// Returns three changes over the run. Linear momentum is taken over the sum of m |v|, angular
// momentum over 0.1 m times that sum, and energy over the energy at the start
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
    for (std::size_t a = 0; a < x.size(); ++a)
      now.linear += m[a] * w[a], now.angular += m[a] * x[a].cross(w[a]);
    now.energy = simulation.energies().total();
    return now;
  };
  const Budget before = take();
  for (int i = 0; i < bit_steps; ++i) simulation.step();
  require_sound(simulation);
  const Budget after = take();
  return {(after.linear - before.linear).norm() / impulse,
          (after.angular - before.angular).norm() / (0.1 * impulse),
          after.energy / before.energy - 1};
}

}  // namespace

VerifyRows conservation(const VerifyContext& context) {
  VerifyRows rows = {{.quantity = "change of linear momentum over the sum of m |v|"},
                     {.quantity = "change of angular momentum over 0.1 m times that"},
                     {.quantity = "change of energy, relative"}};
  for (VerifyRow& row : rows)
    row.unit = "1", row.accepted = 0, row.source = "Newton's third law; no outside force";
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
  for (const char* cycle : {"fas", "him"})
    add(std::string("cycle/") + cycle, free_body(cycle, "symplectic_euler"));
  return rows;
}

}  // namespace plica
