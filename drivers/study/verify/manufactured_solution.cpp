// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>
#include <plica/drivers/solver/simulation.hpp>
#include <plica/drivers/study/sample_gradients.hpp>
#include <plica/drivers/study/sparse_stiffness.hpp>
#include <plica/drivers/study/verify/bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <stdexcept>

namespace plica {

namespace {

// u(X, t) = d sin(w t) phi(X), phi = sin(pi X) sin(pi Y) sin(pi Z) on the unit cube, whose boundary is fixed
constexpr double pi = std::numbers::pi, omega = 2 * pi, duration = 0.3, rho = 1000;
const Point direction(0.06, -0.04, 0.05);
const MaterialOptions soft_matter{NeoHookean::name, 20e3, 0.3, rho};

struct Phi {
  double value;
  Point slope;
  Eigen::Matrix3d curvature;
};

Phi phi_at(const Point& X) {
  const Point s = (pi * X).array().sin(), c = pi * (pi * X).array().cos();
  Phi phi{s.prod(), Point(c[0] * s[1] * s[2], s[0] * c[1] * s[2], s[0] * s[1] * c[2]), {}};
  phi.curvature << 0, c[0] * c[1] * s[2], c[0] * s[1] * c[2], 0, 0, s[0] * c[1] * c[2], 0, 0, 0;
  phi.curvature += Eigen::Matrix3d(phi.curvature.transpose());
  phi.curvature.diagonal().setConstant(-pi * pi * phi.value);
  return phi;
}

// b = rho0 u'' - Div P(I + grad u) [N/m^3], Div P_i = sum_k (dP/dF : dF/dX_k)_ik
Point body_force(const Phi& phi, double t) {
  const Lame<double> c = lame_constants(soft_matter.young_modulus, soft_matter.poisson_ratio);
  const double s = std::sin(omega * t);
  const Mat3<double> F = mat3<double>(Eigen::Matrix3d::Identity() + s * direction * phi.slope.transpose());
  Point b = -rho * omega * omega * s * phi.value * direction;
  for (int k = 0; k < 3; ++k) {
    const Mat3<double> dF = mat3<double>(s * direction * phi.curvature.col(k).transpose());
    const Mat3<double> dP = NeoHookean::stress_change(F, dF, c);
    for (int i = 0; i < 3; ++i) b[i] -= dP[i][k];
  }
  return b;
}

Problem cube(int n) {
  Problem p = verify_body(jittered_box({{0, 0, 0}, {1, 1, 1}}, {n, n, n}, 0.1), soft_matter);
  for (int k = 0; k < 3; ++k) {
    p.body.fixed.push_back(HalfSpaceSelection{Point::Zero(), Point::Unit(k)});
    p.body.fixed.push_back(HalfSpaceSelection{Point::Ones(), -Point::Unit(k)});
  }
  p.integration.integrator = {"rk4"};  // its error in time is far below that of any of these meshes
  return p;
}

// L2 errors of displacement and velocity at the end, relative
std::array<double, 2> errors(int n) {
  const Problem p = cube(n);
  const TetMesh& mesh = p.body.levels[0];
  const std::vector<double> m = LevelProbe<HostBackend>(p).mass();
  std::vector<Phi> phi;
  std::vector<Point> zero(m.size(), Point::Zero()), start;
  for (const Point& X : mesh.vertices)
    phi.push_back(phi_at(X)), start.emplace_back(omega * phi.back().value * direction);
  Simulation<HostBackend> simulation(p);
  simulation.set_state(zero, start);
  simulation.set_external_forces([&](const ForceRequest<HostBackend>& request) {
    request.exec.fence("plica::manufactured_solution");
    for (std::size_t a = 0; a < m.size(); ++a) {
      const Point f = m[a] / rho * body_force(phi[a], request.time + request.ahead);
      for (int k = 0; k < 3; ++k) request.force(a, static_cast<std::size_t>(k)) += f[k];
    }
  });
  while (simulation.time() < duration) simulation.step();
  if (const auto bad = simulation.check()) throw std::runtime_error(bad->text());
  auto u = simulation.positions();
  const auto v = simulation.velocities();
  std::vector<Point> want_u, want_v;
  for (std::size_t a = 0; a < u.size(); ++a) {
    u[a] -= mesh.vertices[a];
    want_u.emplace_back(std::sin(omega * simulation.time()) * phi[a].value * direction);
    want_v.emplace_back(omega * std::cos(omega * simulation.time()) * phi[a].value * direction);
  }
  return {distance(u, want_u, m) / distance(want_u, zero, m), distance(v, want_v, m) / distance(want_v, zero, m)};
}

}  // namespace

VerifyRows manufactured_solution(const VerifyContext& context) {
  VerifyRows rows = {{.quantity = "displacement off the chosen motion, L2 relative"},
                     {.quantity = "velocity off the chosen motion, L2 relative"}};
  for (VerifyRow& row : rows) {
    row.unit = "1", row.accepted = 2, row.judged = Judged::order, row.tolerance = 0.3;
    row.source = "h^2 of linear elements (Hughes, The Finite Element Method, 4.1); b = rho0 x'' - Div P (Roache)";
    row.note = "neo_hookean, irregular mesh, rk4";
  }
  for (const int n : context.refined(4)) {
    context.proceed();
    const auto found = errors(n);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].add(cells_text(n, n, n), 1.0 / n, found[i]);
  }
  return rows;
}

}  // namespace plica
