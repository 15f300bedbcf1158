// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/sample_gradients.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <stdexcept>

namespace plica {

namespace {
namespace stopped {

constexpr double bar_young = 205e9, nu = 0.3, rho = 7850, length = 20e-3, width = 1e-3, speed = 0.1,
                 duration = 50e-6;  // SI

// Returns the velocity of the free end. It is +v until the front arrives at L/c, then -v and +v for
// 2L/c each
double exact(double t) {
  const double fronts = (t * std::sqrt(bar_young / rho) / length + 1) / 2;
  return static_cast<long>(fronts) % 2 == 0 ? speed : -speed;
}

struct Pulses {
  double arrival = 0, period = 0, overshoot = 0, error = 0, energy = 0;
};

Pulses pulses(int n) {
  Problem p = verify_body(box_mesh({{0, 0, 0}, {length, width, width}}, {20 * n, n, n}),
                          {"linear", bar_young, nu, rho});
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  p.body.initial.velocity = {-speed, 0, 0};
  Simulation<HostBackend> simulation(p);
  std::vector<std::size_t> face;  // vertices of the free end; bar theory gives their mean velocity
  for (std::size_t a = 0; a < p.body.levels[0].vertices.size(); ++a)
    if (p.body.levels[0].vertices[a][0] > length - 1e-9) face.push_back(a);
  const auto velocity = simulation.velocity();
  const double start = simulation.energies().total();
  std::vector<double> crossings;
  Pulses found;
  double before = speed, sum = 0;
  long samples = 0;
  while (simulation.time() < duration) {
    simulation.step();
    Kokkos::fence("plica::stopped_bar");
    double now = 0;
    for (const std::size_t a : face) now -= velocity(a, 0) / static_cast<double>(face.size());
    const double t = simulation.time(), want = exact(t);
    if (now * before < 0) crossings.push_back(t - simulation.macro_step() * now / (now - before));
    found.overshoot = std::max(found.overshoot, std::abs(now) / speed - 1);
    sum += (now - want) * (now - want), ++samples;
    before = now;
  }
  require_sound(simulation);
  if (crossings.size() != 6)
    throw std::runtime_error(std::to_string(crossings.size()) + " fronts seen, there are 6");
  found.arrival = crossings[0], found.period = (crossings[4] - crossings[0]) / 2;
  found.error = std::sqrt(sum / static_cast<double>(samples)) / speed;
  found.energy = simulation.energies().total() / start - 1;
  return found;
}

}  // namespace stopped
}  // namespace

VerifyRows stopped_bar(const VerifyContext& context) {
  using namespace stopped;
  const double c = std::sqrt(bar_young / rho);
  constexpr const char* source =
      "one-dimensional wave equation, c = sqrt(E/rho): L/c, 4L/c (Graff, Wave Motion in Elastic "
      "Solids, 2.4)";
  VerifyRows rows = {
      {.quantity = "arrival of the first front at the free end",
       .unit = "s",
       .accepted = length / c},
      {.quantity = "period of the pulses there", .unit = "s", .accepted = 4 * length / c},
      {.quantity = "overshoot of the velocity there, over v", .unit = "1", .accepted = 0},
      {.quantity = "error of the velocity there against rectangular pulses, L2 over v",
       .unit = "1",
       .accepted = 0},
      {.quantity = "energy at the end over that at the start, less 1", .unit = "1", .accepted = 0}};
  for (VerifyRow& row : rows) row.source = source;
  rows[0].judged = rows[1].judged = Judged::finest, rows[0].tolerance = 0.02,
  rows[1].tolerance = 0.01;
  rows[0].note =
      "late by lateral inertia, which the wave equation leaves out: Love's rod, whose front is an "
      "integral of Airy's "
      "function, gives 3.98e-06";
  rows[2].note =
      "Airy's front overshoots by 0.27 of the jump, 0.55; the rest are Gibbs' oscillations on the "
      "mesh, which nothing "
      "damps";
  rows[3].note = "does not vanish: the wave equation has no dispersion";
  rows[4].note = "symplectic_euler: bounded oscillation of the energy, no drift";
  for (const int n : context.refined(2)) {
    context.proceed();
    const Pulses found = pulses(n);
    const double ours[] = {found.arrival, found.period, found.overshoot, found.error, found.energy};
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i].add(cells_text(20 * n, n, n), 1.0 / n, ours[i]);
  }
  return rows;
}

namespace {
namespace twisting {

constexpr double height = 6, duration = 0.25, spin = 105,
                 steps_below_limit = 0.5;  // m, s, rad/s, step over the limit at rest

struct Twist {
  double largest = 0, when = 0, energy = 0;
};

Twist twist(const std::string& element, int n) {
  Problem p = verify_body(box_mesh({{-0.5, 0, -0.5}, {0.5, height, 0.5}}, {n, 6 * n, n}),
                          {"neo_hookean", 17e6, 0.45, 1100});
  p.body.element = {element};
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {0, 1, 0}}};
  p.integration.macro_step =
      steps_below_limit * Simulation<HostBackend>(p).levels()[0].critical_step;
  Simulation<HostBackend> simulation(p);
  const TetMesh& mesh = p.body.levels[0];
  std::vector<Point> v;
  for (const Point& X : mesh.vertices)
    v.push_back(Point(0, spin * std::sin(std::numbers::pi * X[1] / (2 * height)), 0).cross(X));
  simulation.set_state(std::vector<Point>(v.size(), Point::Zero()), v);
  const Point corner(0.5, height, 0.5);
  const std::size_t probe = vertex_at(mesh, corner);
  const auto u = simulation.displacement();
  const double start = simulation.energies().total();
  Twist found;
  double angle = 0;
  for (long i = 0; simulation.time() < duration; ++i) {
    simulation.step();
    Kokkos::fence("plica::twisting_column");
    const double x = corner[0] + u(probe, 0), z = corner[2] + u(probe, 2);
    // angle about y, from z to x
    const double turned = std::atan2(corner[2], corner[0]) - std::atan2(z, x);
    angle += std::remainder(turned - angle, 2 * std::numbers::pi);
    if (angle > found.largest) found.largest = angle, found.when = simulation.time();
    if (i % 50 == 0) require_sound(simulation);
  }
  found.energy = simulation.energies().total() / start - 1;
  return found;
}

}  // namespace twisting
}  // namespace

VerifyRows twisting_column(const VerifyContext& context) {
  using namespace twisting;
  VerifyRows all;
  for (const std::string element : {"linear", "nodal"}) {
    VerifyRows rows = {{.quantity = "largest rotation of the top", .unit = "rad"},
                       {.quantity = "time of that", .unit = "s"},
                       {.quantity = "energy at 0.25 s over that at the start, less 1",
                        .unit = "1",
                        .accepted = 0}};
    rows[0].source = rows[1].source = "none; compared with its own finest mesh";
    if (element == "linear")
      rows[0].note = rows[1].note =
          "E 17 MPa, nu 0.45: linear tetrahedra are too stiff, so it turns further as the mesh is "
          "refined";
    rows[2].source = "no outside work", rows[2].judged = Judged::size, rows[2].tolerance = 0.01;
    std::vector<int> across = context.refined(4);
    if (element == "nodal" && !context.small) across.pop_back();
    for (const int n : across) {
      context.proceed();
      const Twist found = twist(element, n);
      const double ours[] = {found.largest, found.when, found.energy};
      for (std::size_t i = 0; i < rows.size(); ++i)
        rows[i].add(cells_text(n, 6 * n, n), 1.0 / n, ours[i]);
    }
    for (VerifyRow& row : rows) row.element = element, all.push_back(row);
  }
  return all;
}

namespace {
namespace manufactured {

// Motion u(X, t) = d sin(w t) phi(X), phi = sin(pi X) sin(pi Y) sin(pi Z) of the unit cube. Its
// boundary is fixed
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

// Returns b = rho0 u'' - Div P(I + grad u) [N/m^3], with Div P_i = sum_k (dP/dF : dF/dX_k)_ik
Point body_force(const Phi& phi, double t) {
  const Lame<double> c = lame_constants(soft_matter.young_modulus, soft_matter.poisson_ratio);
  const double s = std::sin(omega * t);
  const Mat3<double> F =
      mat3<double>(Eigen::Matrix3d::Identity() + s * direction * phi.slope.transpose());
  Point b = -rho * omega * omega * s * phi.value * direction;
  for (int k = 0; k < 3; ++k) {
    const Mat3<double> dF = mat3<double>(s * direction * phi.curvature.col(k).transpose());
    const Mat3<double> dP = NeoHookean::stress_change(F, dF, c);
    for (int i = 0; i < 3; ++i) b[i] -= dP[i][k];
  }
  return b;
}

Problem cube(const std::string& element, int n) {
  Problem p = verify_body(jittered_box({{0, 0, 0}, {1, 1, 1}}, {n, n, n}, 0.1), soft_matter);
  p.body.element = {element};
  for (int k = 0; k < 3; ++k) {
    p.body.fixed.push_back(HalfSpaceSelection{Point::Zero(), Point::Unit(k)});
    p.body.fixed.push_back(HalfSpaceSelection{Point::Ones(), -Point::Unit(k)});
  }
  p.integration.integrator = {"rk4"};  // error in time far below the error of any of these meshes
  return p;
}

// Returns the relative L2 errors of displacement and velocity at the end
std::array<double, 2> errors(const std::string& element, int n) {
  const Problem p = cube(element, n);
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
  require_sound(simulation);
  auto u = simulation.positions();
  const auto v = simulation.velocities();
  std::vector<Point> want_u, want_v;
  for (std::size_t a = 0; a < u.size(); ++a) {
    u[a] -= mesh.vertices[a];
    want_u.emplace_back(std::sin(omega * simulation.time()) * phi[a].value * direction);
    want_v.emplace_back(omega * std::cos(omega * simulation.time()) * phi[a].value * direction);
  }
  return {distance(u, want_u, m) / distance(want_u, zero, m),
          distance(v, want_v, m) / distance(want_v, zero, m)};
}

}  // namespace manufactured
}  // namespace

VerifyRows manufactured_solution(const VerifyContext& context) {
  using namespace manufactured;
  VerifyRows all;
  for (const std::string element : {"linear", "nodal"}) {
    VerifyRows rows = {
        {.quantity = "error of the displacement against the chosen motion, L2 relative"},
        {.quantity = "error of the velocity against the chosen motion, L2 relative"}};
    for (VerifyRow& row : rows) {
      row.element = element, row.unit = "1", row.accepted = 2, row.judged = Judged::order;
      // 8 cells are few for nodal elements
      row.tolerance = element == "nodal" && context.small ? 0.6 : 0.3;
      row.source =
          "h^2 of linear elements (Hughes, The Finite Element Method, 4.1); b = rho0 x'' - Div P "
          "(Roache)";
      row.note = "neo_hookean, irregular mesh, rk4";
    }
    for (const int n : context.refined(4)) {
      context.proceed();
      const auto found = errors(element, n);
      for (std::size_t i = 0; i < rows.size(); ++i)
        rows[i].add(cells_text(n, n, n), 1.0 / n, found[i]);
    }
    all.insert(all.end(), rows.begin(), rows.end());
  }
  return all;
}

}  // namespace plica
