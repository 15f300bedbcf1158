// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <plica/drivers/solver/presets.hpp>
#include <plica/drivers/solver/simulation.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"

// The preset tled against the method as it is published: Taylor, Cheng & Ourselin, IEEE Trans. Med. Imaging 27, 2008, section II.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double shear = 3e3, bulk = 30e3, damping = 20;  // [Pa], [Pa], [1/s]

/// Its forces: f_a = sum of V F S dN_a, with S of W = mu/2 (I1 - 3) + kappa/2 (J - 1)^2.
std::vector<Point> published_forces(const TetMesh& mesh, const std::vector<Point>& u) {
  std::vector<Point> f(u.size(), Point::Zero());
  for (const auto& t : mesh.tets) {
    const auto id = [&](std::size_t c) { return static_cast<std::size_t>(t[c]); };
    Eigen::Matrix3d X, x;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto column = static_cast<Eigen::Index>(c);
      X.col(column) = mesh.vertices[id(c + 1)] - mesh.vertices[id(0)];
      x.col(column) = X.col(column) + u[id(c + 1)] - u[id(0)];
    }
    const Eigen::Matrix3d inverse = X.inverse(), F = x * inverse, C = F.transpose() * F, Ci = C.inverse();
    const double J = F.determinant(), V = X.determinant() / 6;
    const Eigen::Matrix3d S =
        shear * std::pow(J, -2.0 / 3) * (Eigen::Matrix3d::Identity() - C.trace() / 3 * Ci) + bulk * J * (J - 1) * Ci;
    const Eigen::Matrix3d force = V * F * S * inverse.transpose();
    for (std::size_t c = 0; c < 3; ++c) {
      f[id(c + 1)] += force.col(static_cast<Eigen::Index>(c));
      f[id(0)] -= force.col(static_cast<Eigen::Index>(c));
    }
  }
  return f;
}

TEST(Tled, IsThePublishedUpdate) {
  Problem p = body_of({jittered_box(decimetre, {2, 2, 3})});
  apply_preset("tled", p);
  p.body.material = {.model = "mooney_rivlin",
                     .parameters = {{"c10", shear / 2}, {"c01", 0}, {"bulk_modulus", bulk}},
                     .volume = "quadratic"};
  p.body.fixed = {left_face()};
  p.body.damping.mass = damping;
  p.gravity = {0, 2, -9.81};
  p.integration.macro_step = 5e-4;
  Simulation<Host> simulation(p);
  EXPECT_EQ(simulation.levels()[0].element, "linear");
  EXPECT_EQ(simulation.levels()[0].integrator, "central_difference");
  const TetMesh& mesh = p.body.levels[0];
  const std::size_t n = mesh.vertices.size();
  std::vector<double> mass(n, 0);
  for (const auto& t : mesh.tets) {
    const auto x = [&](std::size_t c) -> const Point& { return mesh.vertices[static_cast<std::size_t>(t[c])]; };
    for (const int v : t) mass[static_cast<std::size_t>(v)] += 1000 * tet_volume(x(0), x(1), x(2), x(3)) / 4;
  }
  // u_next = A (R - F) + B u + C u_before with A = 1 / (D/2h + M/h^2), B = 2 M/h^2 A, C = D/2h A - B/2
  const double h = *p.integration.macro_step;
  std::vector<Point> u(n, Point::Zero()), before(n);
  for (std::size_t a = 0; a < n; ++a) before[a] = mesh.vertices[a].x() == 0 ? Point(0, 0, 0) : h * h / 2 * p.gravity;
  double largest = 0;
  for (int step = 1; step <= 200; ++step) {
    const auto F = published_forces(mesh, u);
    for (std::size_t a = 0; a < n; ++a) {
      if (mesh.vertices[a].x() == 0) continue;
      const double A = 1 / (damping * mass[a] / (2 * h) + mass[a] / (h * h)), B = 2 * mass[a] / (h * h) * A;
      const double C = damping * mass[a] / (2 * h) * A - B / 2;
      const Point next = A * (mass[a] * p.gravity - F[a]) + B * u[a] + C * before[a];
      before[a] = u[a], u[a] = next;
    }
    advance(simulation, 1);
    const auto ours = displacements(simulation, mesh);
    for (std::size_t a = 0; a < n; ++a) {
      ASSERT_LE((ours[a] - u[a]).norm(), 1e-10) << "step " << step;
      largest = std::max(largest, u[a].norm());
    }
  }
  EXPECT_GT(largest, 5e-3);
}

}  // namespace
