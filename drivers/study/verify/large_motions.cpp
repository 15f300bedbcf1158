// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/core/text.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/sample_gradients.hpp>
#include <plica/drivers/study/verify/box_meshes.hpp>
#include <plica/drivers/study/verify/list.hpp>

// Large motions in which nodal elements would fail if they had modes without energy.
namespace plica {

namespace {

Problem soft_cube(const std::string& element, const std::string& kind, int n, double nu) {
  Problem p = verify_body(box_of(kind, {{0, 0, 0}, {0.1, 0.1, 0.1}}, {n, n, n}),
                          {"neo_hookean", 20e3, nu, 1000});
  p.body.element = {element};
  return p;
}

}  // namespace

VerifyRows free_spin(const VerifyContext& context) {
  VerifyRows rows = {{.quantity = "largest change of the energy over the run, relative"},
                     {.quantity = "change of the angular momentum, relative"}};
  for (VerifyRow& row : rows)
    row.unit = "1", row.element = "nodal", row.mesh = "jittered", row.judged = Judged::size;
  rows[0].source =
      "no outside work: symplectic_euler keeps the energy but for a bounded oscillation";
  rows[1].source = "no outside moment: symplectic_euler conserves it";
  rows[0].tolerance = 0.01, rows[1].tolerance = 1e-9;
  const int steps = context.small ? 2000 : 28000;
  Problem p = soft_cube("nodal", "jittered", 4, 0.49);
  p.body.initial.angular_velocity = {3, 5, 20};  // [rad/s]
  Simulation<HostBackend> simulation(p);
  const auto mass = LevelProbe<HostBackend>(p).mass();
  const auto spin = [&] {
    const auto x = simulation.positions(), v = simulation.velocities();
    Point sum = Point::Zero();
    for (std::size_t a = 0; a < mass.size(); ++a) sum += mass[a] * x[a].cross(v[a]);
    return sum;
  };
  const Point before = spin();
  const double energy = simulation.energies().total();
  double worst = 0;
  for (int i = 1; i <= steps; ++i) {
    simulation.step();
    if (i % 100 != 0) continue;
    context.proceed();
    require_sound(simulation);
    worst = std::max(worst, std::abs(simulation.energies().total() / energy - 1));
  }
  rows[0].add(cells_text(4, 4, 4), 1, worst);
  rows[1].add(cells_text(4, 4, 4), 1, (spin() - before).norm() / before.norm());
  for (VerifyRow& row : rows) row.note = std::to_string(steps) + " steps";
  return rows;
}

namespace {

/// Returns the stretch across at which a body with the stretch `along` has no stress across, by
/// bisection.
double stretch_across(double along, const Lame<double>& c) {
  double low = 1, high = 1 / along;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    const Eigen::Matrix3d F = Eigen::Vector3d(middle, middle, along).asDiagonal();
    (eigen(NeoHookean::stress(mat3<double>(F), c))(0, 0) > 0 ? high : low) = middle;
  }
  return (low + high) / 2;
}

/// Returns the least height, over that at rest, down to which a cube between lubricated plates
/// keeps the affine solution. The height falls by steps of 0.025 to 0.4, and the cube is disturbed
/// before each step. The mesh is a quarter of the cube, between its planes of symmetry.
double least_height(const Problem& p, int n) {
  constexpr double side = 0.1, step = 0.025, last = 0.4;
  const std::vector<Point>& X = p.body.levels[0].vertices;
  LevelProbe<HostBackend> probe(p);
  StaticOptions options;
  options.held = [](const Point& x, int axis) {
    return x[axis] < 1e-9 || (axis == 2 && x[2] > side - 1e-9);
  };
  options.start = probe.zero();
  const MaterialOptions& m = p.body.material;
  double kept = 1;
  for (double height = 1 - step; height > last - step / 2; height -= step) {
    const auto disorder =
        random_field(X.size(), 0.01 * side / n, static_cast<unsigned>(1000 * height));
    for (std::size_t a = 0; a < X.size(); ++a) {
      options.start[a][2] = height / kept * (X[a][2] + options.start[a][2]) - X[a][2];
      for (int k = 0; k < 3; ++k)
        if (!options.held(X[a], k)) options.start[a][k] += disorder[a][k];
    }
    try {
      options.start = static_equilibrium(probe, options);
    } catch (const std::runtime_error&) {
      break;  // no equilibrium near the affine one
    }
    const double across = stretch_across(height, lame_constants(m.young_modulus, m.poisson_ratio));
    for (std::size_t a = 0; a < X.size(); ++a)
      if ((X[a] + options.start[a] - X[a].cwiseProduct(Point(across, across, height))).norm() >
          1e-7 * side)
        return kept;
    kept = height;
  }
  return kept;
}

}  // namespace

VerifyRows squash(const VerifyContext& context) {
  VerifyRows rows;
  const int n = context.small ? 4 : 6;
  for (const std::string element : {"linear", "nodal"})
    for (const double nu : {0.3, 0.45})
      for (const std::string kind : mesh_kinds) {
        context.proceed();
        VerifyRow row{.quantity = text(
                          "least height, over that at rest, to which the answer stays affine, nu ",
                          number(nu, 2))};
        row.unit = "1", row.source = "no stress across, from the law's own stress; tried to 0.4";
        row.element = element, row.mesh = kind, row.judged = Judged::size, row.tolerance = 0.65;
        if (element == "nodal")
          row.note = "below, other shapes balance, too; with a larger body.stabilisation later";
        row.add(cells_text(n, n, n), 1, least_height(soft_cube(element, kind, n, nu), n));
        rows.push_back(row);
      }
  return rows;
}

}  // namespace plica
