// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <plica/meshes/generators.hpp>

namespace plica {

// Solves a bar in tension. The deformation is affine, so that every mesh gives it exactly, also an
// irregular one.
VerifyRows uniaxial_tension(const VerifyContext& context) {
  context.proceed();
  const double E = 20e3, nu = 0.3, p_over_E = 1e-3, L = 0.4, w = 0.1;
  const int n = context.small ? 2 : 4;
  Problem p =
      verify_body(jittered_box({{0, 0, 0}, {L, w, w}}, {4 * n, n, n}), {"linear", E, nu, 1000});
  p.body.loads = {{HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}, Traction{{-p_over_E * E, 0, 0}}, {}},
                  {HalfSpaceSelection{{L, 0, 0}, {-1, 0, 0}}, Traction{{p_over_E * E, 0, 0}}, {}}};
  const auto held = [=](const Point& X, int axis) {  // fixes rigid motion, at three corners
    if (X.norm() < 1e-9) return true;
    return ((X - Point(L, 0, 0)).norm() < 1e-9 && axis > 0) ||
           ((X - Point(0, 0, w)).norm() < 1e-9 && axis == 1);
  };
  LevelProbe<HostBackend> probe(p);
  const SparseStiffness K(probe, held);
  const auto u = K.equilibrium(probe.force(probe.zero()));
  const Point corner = u[vertex_at(p.body.levels[0], {L, w, w})];
  VerifyRows rows = {
      {.quantity = "strain along", .unit = "1", .accepted = p_over_E, .source = "p/E (Hooke)"},
      {.quantity = "strain across",
       .unit = "1",
       .accepted = -nu * p_over_E,
       .source = "-nu p/E (Hooke)"}};
  const double ours[] = {corner[0] / L, corner[1] / w};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].judged = Judged::finest, rows[i].tolerance = 1e-10;
    rows[i].add(cells_text(4 * n, n, n) + ", irregular", 1, ours[i]);
  }
  return rows;
}

namespace {

// Returns Cook's membrane in plane strain, 1 mm thick, with one layer of cells. Its corners are
// (0,0) (48,44) (48,60) (0,44) mm
Problem membrane(int n) {
  constexpr double mm = 1e-3, mu = 422.5e3, nu = 0.3;
  TetMesh mesh = grid_mesh({n, n, 1}, {false, false, false}, [](const Point& s) {
    const double low = 44 * s[0], high = 44 + 16 * s[0];
    return Point(48 * mm * s[0], mm * (low + (high - low) * s[1]), mm * s[2]);
  });
  Problem p = verify_body(std::move(mesh), {"neo_hookean", 2 * mu * (1 + nu), nu, 1000});
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  p.body.loads = {{HalfSpaceSelection{{48 * mm, 0, 0}, {-1, 0, 0}},
                   Traction{{0, 1 / (16e-3 * 1e-3), 0}}, PolygonCourse{{{0, 0}, {1, 1}}}}};
  return p;
}

}  // namespace

VerifyRows cook_membrane(const VerifyContext& context) {
  VerifyRow row{.quantity = "u_y at (48, 52) mm under 1 N upward", .unit = "mm", .accepted = 14.74};
  row.source =
      "converged value for this energy (Simo & Hughes, Computational Inelasticity, eq. 9.2.6); Q1 "
      "with 2 to 64 cells "
      "an edge: "
      "8.638 12.07 13.86 14.49 14.67 14.72";
  row.judged = Judged::limit, row.tolerance = 0.01, row.power = -1;
  row.note =
      "from below: linear tetrahedra are stiff in bending and lock at low resolution; its "
      "stiffness is extrapolated";
  for (const int n : context.refined(16)) {
    context.proceed();
    const Problem p = membrane(n);
    LevelProbe<HostBackend> probe(p);
    StaticOptions options;
    options.held = [](const Point&, int axis) { return axis == 2; };
    options.load_steps = 4;
    const auto u = static_equilibrium(probe, options);
    double sum = 0;
    for (const double z : {0.0, 1e-3})
      sum += u[vertex_at(p.body.levels[0], {48e-3, 52e-3, z})][1] / 2;
    row.add(cells_text(n, n, 1), 1.0 / n, 1e3 * sum);
  }
  return {row};
}

namespace {

constexpr double pillar_young = 2e11, nu = 0.3, rho = 7800, g = 9.81, length = 3, half = 0.5;

// Returns a quarter of a hanging bar, between its planes of symmetry. A uniform traction carries it
// at its upper end, z = L.
Problem bar(int n) {
  Problem p = verify_body(box_mesh({{0, 0, 0}, {half, half, length}}, {n, n, 6 * n}),
                          {"linear", pillar_young, nu, rho});
  p.gravity = {0, 0, -g};
  p.body.loads = {
      {HalfSpaceSelection{{0, 0, length}, {0, 0, -1}}, Traction{{0, 0, rho * g * length}}, {}}};
  return p;
}

bool held(const Point& X, int axis) {
  return axis < 2 ? X[axis] < 1e-9 : X.head<2>().norm() < 1e-9 && X[2] > length - 1e-9;
}

Point exact(const Point& X) {
  const double k = rho * g / pillar_young;
  return {-nu * k * X[0] * X[2], -nu * k * X[1] * X[2],
          k / 2 * (X[2] * X[2] + nu * (X[0] * X[0] + X[1] * X[1]) - length * length)};
}

}  // namespace

VerifyRows hanging_bar(const VerifyContext& context) {
  constexpr const char* source =
      "w = rho g z^2/2E + nu rho g (x^2 + y^2)/2E - rho g L^2/2E (Timoshenko & Goodier, Theory of "
      "Elasticity, art. 96; "
      "VPCS SSLV07)";
  VerifyRows rows = {
      {.quantity = "deflection of the lower end on the axis", .unit = "m", .source = source},
      {.quantity = "lateral contraction at the upper end's edge", .unit = "m", .source = source},
      {.quantity = "error of the displacement, without vertical translation, L2 relative",
       .unit = "1",
       .source = source}};
  rows[0].accepted = exact({0, 0, 0})[2], rows[0].judged = Judged::finest,
  rows[0].tolerance = context.small ? 0.01 : 0.005;
  rows[1].accepted = exact({half, 0, length})[0], rows[1].judged = Judged::finest,
  rows[1].tolerance = 0.02;
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
