// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/study/static_equilibrium.hpp>
#include <plica/drivers/study/verify/bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

namespace {

constexpr double E = 2e11, nu = 0.3, rho = 7800, g = 9.81, length = 3, half = 0.5;

// Hung at its upper end, z = L, where a uniform traction carries it; a quarter, between its planes of symmetry.
Problem bar(int n) {
  Problem p = verify_body(box_mesh({{0, 0, 0}, {half, half, length}}, {n, n, 6 * n}), {"linear", E, nu, rho});
  p.gravity = {0, 0, -g};
  p.body.loads = {{HalfSpaceSelection{{0, 0, length}, {0, 0, -1}}, Traction{{0, 0, rho * g * length}}, {}}};
  return p;
}

bool held(const Point& X, int axis) {
  return axis < 2 ? X[axis] < 1e-9 : X.head<2>().norm() < 1e-9 && X[2] > length - 1e-9;
}

Point exact(const Point& X) {
  const double k = rho * g / E;
  return {-nu * k * X[0] * X[2], -nu * k * X[1] * X[2],
          k / 2 * (X[2] * X[2] + nu * (X[0] * X[0] + X[1] * X[1]) - length * length)};
}

}  // namespace

VerifyRows hanging_bar(const VerifyContext& context) {
  constexpr const char* source =
      "w = rho g z^2/2E + nu rho g (x^2 + y^2)/2E - rho g L^2/2E (Timoshenko & Goodier, Theory of Elasticity, art. 96; "
      "VPCS SSLV07)";
  VerifyRows rows = {{.quantity = "deflection of the lower end on the axis", .unit = "m", .source = source},
                     {.quantity = "lateral contraction at the upper end's edge", .unit = "m", .source = source},
                     {.quantity = "displacement off the exact field but for a vertical translation, L2 relative",
                      .unit = "1",
                      .source = source}};
  rows[0].accepted = exact({0, 0, 0})[2], rows[0].judged = Judged::finest,
  rows[0].tolerance = context.small ? 0.01 : 0.005;
  rows[1].accepted = exact({half, 0, length})[0], rows[1].judged = Judged::finest, rows[1].tolerance = 0.02;
  rows[2].accepted = 2, rows[2].judged = Judged::order, rows[2].tolerance = 0.3;
  for (const int n : context.refined(2)) {
    context.proceed();
    const Problem p = bar(n);
    const TetMesh& mesh = p.body.levels[0];
    LevelProbe<HostBackend> probe(p);
    const SparseStiffness K(probe, held);
    auto u = K.equilibrium(probe.force(probe.zero()));
    std::vector<Point> want;
    for (const Point& X : mesh.vertices) want.push_back(exact(X));
    const auto m = probe.mass();
    double rise = 0, mass = 0;
    for (std::size_t a = 0; a < u.size(); ++a) rise += m[a] * (u[a] - want[a])[2], mass += m[a];
    rise /= mass;
    const std::string cells = cells_text(n, n, 6 * n);
    rows[0].add(cells, 1.0 / n, u[vertex_at(mesh, {0, 0, 0})][2]);
    rows[1].add(cells, 1.0 / n, u[vertex_at(mesh, {half, 0, length})][0]);
    for (Point& displacement : u) displacement[2] -= rise;
    rows[2].add(cells, 1.0 / n, distance(u, want, m) / distance(want, probe.zero(), m));
  }
  return rows;
}

}  // namespace plica
