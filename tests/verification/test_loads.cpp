// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <complex>
#include <numbers>
#include <plica/drivers/solver/simulation.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"

// Known answers for loads and prescribed motion.
namespace {

using namespace plica;
using namespace plica::test;

/// A bar of linear material, pulled at both ends with the same traction until it is at rest: strain p/E along, -nu p/E across,
/// which linear tetrahedra take exactly.
TEST(UniaxialTension, StrainIsTractionOverYoungsModulus) {
  const double E = 20e3, nu = 0.3, p_over_E = 1e-3;
  for (const char* integrator : {"symplectic_euler", "implicit_euler"}) {
    SCOPED_TRACE(integrator);
    Problem p = body_of({jittered_box(beam_box, {6, 2, 2})}, "linear");
    p.body.material.poisson_ratio = nu;
    p.body.loads = {{HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}, Traction{{-p_over_E * E, 0, 0}}, RampCourse{0.5}},
                    {HalfSpaceSelection{{0.4, 0, 0}, {-1, 0, 0}}, Traction{{p_over_E * E, 0, 0}}, RampCourse{0.5}}};
    p.body.damping.mass = 20;
    p.integration.integrator = {integrator};
    if (std::string(integrator) == "implicit_euler") p.integration.macro_step = 5e-3;
    p.integration.implicit.relative_residual = 1e-9;
    Simulation<Host> simulation(p);
    while (simulation.time() < 2) advance(simulation, 1);
    const auto u = displacements(simulation, p.body.levels[0]);
    const Eigen::Matrix3d want = p_over_E * Eigen::Vector3d(1, -nu, -nu).asDiagonal().toDenseMatrix();
    for (const auto& t : p.body.levels[0].tets) {
      Eigen::Matrix3d rest, change;
      for (int k = 0; k < 3; ++k) {
        const auto a = static_cast<std::size_t>(t[static_cast<std::size_t>(k) + 1]), o = static_cast<std::size_t>(t[0]);
        rest.col(k) = p.body.levels[0].vertices[a] - p.body.levels[0].vertices[o];
        change.col(k) = u[a] - u[o];
      }
      const Eigen::Matrix3d slope = change * rest.inverse();
      EXPECT_LE(((slope + slope.transpose()) / 2 - want).norm(), 1e-4 * p_over_E);
    }
  }
}

/// A bar whose one end shakes along its axis. With mass damping c its steady answer at the free end is
/// 1 / cos(k L), k^2 = (w^2 - i w c) rho / E (one-dimensional: nu = 0).
TEST(ShakenBar, FreeEndAnswersAsTheWaveEquationSays) {
  const double L = 0.4, speed = std::sqrt(20e3 / 1000), c = 5, f = 1.4, w = 2 * std::numbers::pi * f;
  Problem p = body_of({box_mesh(beam_box, {16, 2, 2})}, "linear");
  p.body.material.poisson_ratio = 0;
  p.body.damping.mass = c;
  p.body.prescribed = {{left_face(), SineMotion{{1e-4, 0, 0}, f, 0}}};
  Simulation<Host> simulation(p);
  while (simulation.time() < 4) advance(simulation, 1);
  double largest_motion = 0;
  while (simulation.time() < 4 + 2 / f) {
    advance(simulation, 1);
    const auto u = displacements(simulation, p.body.levels[0]);
    for (std::size_t a = 0; a < u.size(); ++a)
      if (p.body.levels[0].vertices[a][0] > L - 1e-9) largest_motion = std::max(largest_motion, std::abs(u[a][0]));
  }
  const double want = 1e-4 / std::abs(std::cos(std::sqrt(std::complex<double>(w * w, -w * c)) / speed * L));
  EXPECT_GT(want, 1.3e-4);
  EXPECT_NEAR(largest_motion, want, 0.01 * want);
}

}  // namespace
