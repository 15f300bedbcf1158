// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

namespace plica {

namespace {
namespace incline {

constexpr double friction = 0.3, g = 10, size = 0.1, duration = 0.3;

double along(const Simulation<HostBackend>& simulation) {
  double sum = 0;
  const auto v = simulation.velocities();
  for (const Point& one : v) sum += one[0] / static_cast<double>(v.size());
  return sum;
}

/// Whether it gains speed on a slope of this tangent, after the first jolt.
bool slides(int n, double tangent) {
  Problem p = verify_body(box_mesh({{0, 0, 0}, {size, size, size}}, {n, n, n}), {"corotational", 2e5, 0.3, 1000});
  const double angle = std::atan(tangent);
  p.gravity = g * Point(std::sin(angle), 0, -std::cos(angle));
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.contact.obstacles.push_back({PlaneOptions{}, friction, {}});
  Simulation<HostBackend> simulation(p);
  while (simulation.time() < duration) simulation.step();
  const double before = along(simulation), start = simulation.time();
  while (simulation.time() < 2 * duration) simulation.step();
  require_sound(simulation);
  return along(simulation) - before > 0.01 * g * tangent * (simulation.time() - start);
}

/// The smallest tangent at which it does, by bisection.
double slips_at(int n) {
  double holds = 0.5 * friction, slips = 2 * friction;
  while (slips - holds > 1e-3 * friction) {
    const double middle = (holds + slips) / 2;
    (slides(n, middle) ? slips : holds) = middle;
  }
  return slips;
}

}  // namespace incline

namespace hertz {

// Lengths over the sphere's radius, stiffness over Young's modulus. The block is as wide and deep as it takes to look infinite; its cells
// grow away from the contact.
constexpr double nu = 0.3, approach = 0.01, contact_radius = 0.1, far = 60 * contact_radius;

/// Cells' ends from 0 on: n of them over the contact radius, then longer by half each, up to `far`.
std::vector<double> ends(int n) {
  const double fine = contact_radius / n;
  std::vector<double> all{0};
  while (all.back() < far) {
    const double last = all.size() > 1 ? all.back() - all[all.size() - 2] : fine;
    all.push_back(all.back() + (all.back() < 1.5 * contact_radius ? fine : 1.5 * last));
  }
  all.back() = far;
  return all;
}

double at(const std::vector<double>& ends, double s) {  // s: from 0 to 1 over the cells
  return ends[static_cast<std::size_t>(std::lround(s * static_cast<double>(ends.size() - 1)))];
}

/// The force on a rigid sphere pressed into the middle of the block's top.
double force(int n, std::string& cells) {
  const std::vector<double> side = ends(n);
  const int m = static_cast<int>(side.size()) - 1;
  TetMesh mesh = grid_mesh({2 * m, 2 * m, m}, {false, false, false}, [&](const Point& s) {
    const auto across = [&](double t) { return t < 0.5 ? -at(side, 1 - 2 * t) : at(side, 2 * t - 1); };
    return Point(across(s[0]), across(s[1]), -at(side, 1 - s[2]));
  });
  cells = cells_text(2 * m, 2 * m, m);
  Problem p = verify_body(std::move(mesh), {"linear", 1, nu, 1e-6});
  p.body.element = {"nodal"};
  p.body.fixed = {Box{{-far, -far, -far}, {far, far, -far}}};
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  std::erase_if(p.body.surface->triangles, [&](const auto& t) {
    return std::ranges::any_of(t, [&](int v) { return p.body.surface->vertices[static_cast<std::size_t>(v)][2] < 0; });
  });
  p.contact.obstacles.push_back({SphereOptions{{0, 0, 1 - approach}, 1}, {}, {}});
  p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 1;  // far longer than any motion here takes
  p.integration.implicit.newton_iterations = 20;
  Simulation<HostBackend> simulation(p);
  for (int i = 0; i < 6; ++i) simulation.step();
  require_sound(simulation);
  return -simulation.wrenches()[0].force[2];
}

}  // namespace hertz
}  // namespace

VerifyRows friction_on_a_slope(const VerifyContext& context) {
  VerifyRow row{.quantity = "tangent of the slope on which a block slips, friction 0.3",
                .unit = "1",
                .accepted = incline::friction};
  row.source = "Coulomb's law: tan(angle) = mu";
  row.judged = Judged::finest, row.tolerance = 0.02;
  row.note = "it slips where from 0.3 to 0.6 s it gains 1 % of the speed of free fall along the slope";
  for (const int n : {3, 6}) {
    context.proceed();
    row.add(cells_text(n, n, n), 1.0 / n, incline::slips_at(n));
    if (context.small) break;
  }
  return {row};
}

VerifyRows indentation(const VerifyContext& context) {
  using namespace hertz;
  VerifyRow row{.quantity = "force on a rigid sphere pressed into a half-space, over E R^2", .unit = "1"};
  row.accepted = 4.0 / 3 / (1 - nu * nu) * std::pow(approach, 1.5);
  row.element = "nodal";
  row.source = "Hertz: 4/3 E/(1 - nu^2) sqrt(R) d^(3/2) (Johnson, Contact Mechanics, 4.2)";
  row.judged = Judged::finest, row.tolerance = 0.03;
  for (const int n : {2, 4, 6}) {
    context.proceed();
    std::string cells;
    const double found = force(n, cells);
    row.add(cells, 1.0 / n, found);
    if (context.small && n == 4) break;
  }
  return {row};
}

}  // namespace plica
