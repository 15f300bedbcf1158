// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <plica/drivers/run/registry.hpp>
#include <plica/drivers/run/simulation.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"

// The preset tled against the method as it is published: Taylor, Cheng & Ourselin, IEEE Trans. Med.
// Imaging 27, 2008, sections II and III; Taylor et al., Med. Image Anal. 13, 2009 has the recursion
// of the viscous stress, too.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double shear = 3e3, bulk = 30e3, damping = 20;  // [Pa], [Pa], [1/s]

/// Its elements, W = mu/2 (I1 - 3) + kappa/2 (J - 1)^2; each remembers the stresses Y_i that its
/// Prony terms have lost.
class PublishedElements {
 public:
  PublishedElements(const TetMesh& mesh, std::vector<PronyTerm> prony)
      : mesh_(mesh),
        prony_(std::move(prony)),
        lost_(mesh.tets.size() * prony_.size(), Eigen::Matrix3d::Zero()) {}

  /// f_a = sum of V F S dN_a after a step h. S without its volumetric part loses Y_i <- (h alpha_i
  /// S + tau_i Y_i) / (h + tau_i).
  std::vector<Point> forces(const std::vector<Point>& u, double h) {
    std::vector<Point> f(u.size(), Point::Zero());
    for (std::size_t e = 0; e < mesh_.tets.size(); ++e) {
      const auto id = [&](std::size_t c) { return static_cast<std::size_t>(mesh_.tets[e][c]); };
      Eigen::Matrix3d X, x;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto column = static_cast<Eigen::Index>(c);
        X.col(column) = mesh_.vertices[id(c + 1)] - mesh_.vertices[id(0)];
        x.col(column) = X.col(column) + u[id(c + 1)] - u[id(0)];
      }
      const Eigen::Matrix3d inverse = X.inverse(), F = x * inverse, C = F.transpose() * F,
                            Ci = C.inverse();
      const double J = F.determinant(), V = X.determinant() / 6;
      const Eigen::Matrix3d shape =
          shear * std::pow(J, -2.0 / 3) * (Eigen::Matrix3d::Identity() - C.trace() / 3 * Ci);
      Eigen::Matrix3d S = shape + bulk * J * (J - 1) * Ci;
      for (std::size_t i = 0; i < prony_.size(); ++i) {
        const auto [alpha, tau] = prony_[i];
        Eigen::Matrix3d& Y = lost_[e * prony_.size() + i];
        Y = (h * alpha * shape + tau * Y) / (h + tau);
        S -= Y;
      }
      const Eigen::Matrix3d force = V * F * S * inverse.transpose();
      for (std::size_t c = 0; c < 3; ++c) {
        f[id(c + 1)] += force.col(static_cast<Eigen::Index>(c));
        f[id(0)] -= force.col(static_cast<Eigen::Index>(c));
      }
    }
    return f;
  }

 private:
  const TetMesh& mesh_;
  std::vector<PronyTerm> prony_;
  std::vector<Eigen::Matrix3d> lost_;
};

/// The largest displacement [m] in 200 steps of both, which must agree.
double largest_of_both(const std::vector<PronyTerm>& prony) {
  Problem p = body_of({jittered_box(decimetre, {2, 2, 3})});
  apply_preset("tled", p);
  p.body.material = {.model = "mooney_rivlin",
                     .parameters = {{"c10", shear / 2}, {"c01", 0}, {"bulk_modulus", bulk}},
                     .volume = "quadratic",
                     .prony = prony};
  p.body.fixed = {left_face()};
  p.body.damping.mass = damping;
  p.gravity = {0, 2, -9.81};
  p.integration.macro_step = 5e-4;
  Simulation<Host> simulation(p);
  EXPECT_EQ(simulation.levels()[0].element, "linear");
  EXPECT_EQ(simulation.levels()[0].integrator, "central_difference");
  EXPECT_EQ(p.integration.relaxation, "backward_euler");
  const TetMesh& mesh = p.body.levels[0];
  const std::size_t n = mesh.vertices.size();
  std::vector<double> mass(n, 0);
  for (const auto& t : mesh.tets) {
    const auto x = [&](std::size_t c) -> const Point& {
      return mesh.vertices[static_cast<std::size_t>(t[c])];
    };
    for (const int v : t)
      mass[static_cast<std::size_t>(v)] += 1000 * tet_volume(x(0), x(1), x(2), x(3)) / 4;
  }
  // u_next = A (R - F) + B u + C u_before with A = 1 / (D/2h + M/h^2), B = 2 M/h^2 A, C = D/2h A -
  // B/2
  const double h = *p.integration.macro_step;
  std::vector<Point> u(n, Point::Zero()), before(n);
  for (std::size_t a = 0; a < n; ++a)
    before[a] = mesh.vertices[a].x() == 0 ? Point(0, 0, 0) : h * h / 2 * p.gravity;
  PublishedElements elements(mesh, prony);
  double largest = 0;
  for (int step = 1; step <= 200; ++step) {
    const auto F = elements.forces(u, h);
    for (std::size_t a = 0; a < n; ++a) {
      if (mesh.vertices[a].x() == 0) continue;
      const double A = 1 / (damping * mass[a] / (2 * h) + mass[a] / (h * h)),
                   B = 2 * mass[a] / (h * h) * A;
      const double C = damping * mass[a] / (2 * h) * A - B / 2;
      const Point next = A * (mass[a] * p.gravity - F[a]) + B * u[a] + C * before[a];
      before[a] = u[a], u[a] = next;
    }
    advance(simulation, 1);
    const auto ours = displacements(simulation, mesh);
    for (std::size_t a = 0; a < n; ++a) {
      EXPECT_LE((ours[a] - u[a]).norm(), 1e-12) << "step " << step;
      largest = std::max(largest, u[a].norm());
    }
    if (::testing::Test::HasFailure()) break;
  }
  return largest;
}

TEST(Tled, IsThePublishedUpdate) { EXPECT_GT(largest_of_both({}), 5e-3); }

TEST(Tled, RelaxesAsPublished) {
  const double elastic = largest_of_both({});
  EXPECT_GT(largest_of_both({{0.5, 0.02}, {0.2, 0.3}}), 1.03 * elastic)
      << "softer, once it has relaxed";
}

}  // namespace
