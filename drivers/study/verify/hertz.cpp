// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

namespace plica {

namespace {
namespace hertz {

constexpr double sphere_young = 1e5, nu = 0.3, rho = 1000, R = 0.5, contact_radius = 0.014;  // SI

/// Cells across half of a block. `smallest` is the size of the cell at the contact over R, and
/// `growth` the ratio of the sizes of successive cells.
struct Grading {
  int cells;
  double smallest, growth;
};

/// A block whose upper face is, around its middle, part of a sphere that touches z = 0.
struct Cap {
  Body body;
  double size;  ///< distance from the contact to the fixed faces [m]
};

/// Returns a cap below z = 0, or `upside_down` above it, moved by `shift` across z [m].
Cap cap(const Grading& grading, bool upside_down, const Point& shift) {
  const int n = grading.cells;
  std::vector<double> at{0};
  double h = grading.smallest * R;
  for (int i = 0; i < n; ++i, h *= grading.growth) at.push_back(at.back() + h);
  const double L = at.back(), cut = 8 * contact_radius;
  const auto place = [&](double s) {
    return std::copysign(at[static_cast<std::size_t>(std::lround(std::abs(s) * n))], s);
  };
  TetMesh mesh = grid_mesh({2 * n, 2 * n, n}, {true, true, false}, [&](const Point& u) {
    const Point x(place(2 * u[0] - 1), place(2 * u[1] - 1), -place(1 - u[2]));
    const double square = std::min(x[0] * x[0] + x[1] * x[1], cut * cut),
                 z = x[2] - square / (2 * R) * (1 + x[2] / L);
    return Point(shift + (upside_down ? Point(x[0], -x[1], -z) : Point(x[0], x[1], z)));
  });
  for (std::size_t a = 0; a < mesh.vertices.size(); ++a) {
    const Point d = mesh.vertices[a] - shift;
    if (d.cwiseAbs().maxCoeff() > 0.999 * L)
      mesh.vertex_sets["held"].push_back(static_cast<int>(a));
  }
  Body body = verify_body(std::move(mesh), {"linear", sphere_young, nu, rho}).body;
  body.element = {"nodal"};
  body.surface = boundary_surface(body.levels[0]).surface;
  return {body, L};
}

/// Returns the force over that of Hertz, mean over the second half of an approach up to
/// `contact_radius`. The approach is slow compared with waves. The sphere is pressed on a rigid
/// plane, or with `spheres` on an equal sphere.
double force_over_theory(const Grading& grading, bool spheres) {
  const Cap below = cap(grading, false, Point::Zero());
  const double radius = spheres ? R / 2 : R,
               stiffness = sphere_young / (1 - nu * nu) / (spheres ? 2 : 1);
  const double all = contact_radius * contact_radius / radius,
               wave = std::sqrt(sphere_young * (1 - nu) / (1 + nu) / (1 - 2 * nu) / rho),
               duration = 4 * below.size / wave;
  const Point velocity(0, 0, -all / duration);
  Problem p;
  p.body = below.body;
  p.body.fixed = {GroupSelection{"held"}};
  if (spheres) {  // the shift keeps vertices from lying above each other
    Cap above = cap(grading, true, grading.smallest * R * Point(0.37, 0.23, 0));
    above.body.prescribed = {{GroupSelection{"held"}, SteadyMotion{velocity}}};
    above.body.initial.velocity = velocity;
    p.body = join_bodies({{"below", p.body}, {"above", above.body}});
  } else {
    p.contact.obstacles.push_back(
        {PlaneOptions{{0, 0, 0}, {0, 0, -1}}, {}, SteadyMotion{velocity}});
  }
  Simulation<HostBackend> simulation(p);
  double sum = 0;
  int count = 0;
  while (simulation.time() < duration) {
    simulation.step();
    const double approach = -velocity[2] * simulation.time();
    if (approach < all / 2) continue;
    sum += simulation.wrenches()[0].force.norm() /
           (4.0 / 3 * stiffness * std::sqrt(radius) * std::pow(approach, 1.5)),
        ++count;
  }
  require_sound(simulation);
  return sum / count;
}

}  // namespace hertz
}  // namespace

VerifyRows hertz_contact(const VerifyContext& context) {
  VerifyRows rows;
  for (const bool spheres : {false, true}) {
    VerifyRow row{.quantity = std::string("force of a sphere on ") +
                              (spheres ? "its like" : "a rigid plane") +
                              " over Hertz's, mean of approaches",
                  .unit = "1",
                  .element = "nodal",
                  .accepted = 1};
    row.source = "Hertz: F = 4/3 E* sqrt(R) d^1.5 (Johnson, Contact Mechanics, 4.2)";
    row.judged = Judged::finest, row.tolerance = context.small ? 0.05 : 0.03;
    row.note =
        "a block with a curved face, its least cell .29 and .18 of the largest contact radius; 14 "
        "of these cells, .1 "
        "of it: .985 and .984";
    for (const auto& grading : {hertz::Grading{8, 0.008, 1.6}, {10, 0.005, 1.5}}) {
      if (context.small && !row.ours.empty()) break;
      context.proceed();
      const int n = grading.cells;
      row.add(cells_text(2 * n, 2 * n, n), grading.smallest * hertz::R / hertz::contact_radius,
              hertz::force_over_theory(grading, spheres));
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace plica
