// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <plica/drivers/study/level_probe.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/composite_box.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Steps of a mesh of two pieces, where vertices of the finer one follow the coarser one.
namespace {

using namespace plica;
using namespace plica::test;

/// A beam of two pieces, held at its coarse end, above a coarse mesh of all of it.
Problem held_beam(const std::string& element, const std::string& material = "neo_hookean") {
  Problem p = body_of({composite_beam(false, 1), box_mesh(beam_box, {4, 1, 1})}, material);
  p.body.element = {element}, p.body.material.poisson_ratio = 0.3;
  p.body.fixed = {left_face()};
  p.integration.cycle = "single";
  return p;
}

/// Largest distance of a follower from where its masters put it.
double lag(const TetMesh& mesh, const std::vector<Point>& x) {
  std::vector<Point> put = x;
  follow(mesh, put);
  return largest_difference(put, x);
}

TEST(PiecesInSteps, FollowersGoWithTheirMasters) {
  for (const char* element : {"linear", "nodal"})
    for (const std::string& integrator : names(integrators())) {
      Problem p = held_beam(element);
      p.gravity = {0, 0, -9.81};
      p.integration.integrator = {integrator};
      p.integration.macro_step = 2e-4, p.integration.allow_unstable = true;
      Simulation<Host> s(p);
      for (int n = 0; n < 20; ++n) {
        s.step();
        EXPECT_LT(lag(p.body.levels[0], displacements(s, p.body.levels[0])), 1e-15) << integrator;
        EXPECT_LT(lag(p.body.levels[0], s.velocities()), 1e-14) << integrator;
      }
      EXPECT_FALSE(s.check()) << integrator;
      EXPECT_GT(largest(s.velocities()), 0.02) << integrator;
    }
}

TEST(PiecesInSteps, FollowersTakeTheirPlaceInAStateThatIsSet) {
  const Problem p = held_beam("nodal");
  Simulation<Host> s(p);
  const std::size_t n = p.body.levels[0].vertices.size();
  s.set_state(random_field(n, 1e-3, 1), random_field(n, 1e-3, 2));
  EXPECT_LT(lag(p.body.levels[0], displacements(s, p.body.levels[0])), 1e-15);
  EXPECT_LT(lag(p.body.levels[0], s.velocities()), 1e-15);
}

/// A step of backward Euler from a velocity, against dense algebra: (M + h^2 K) v = M v_0.
void expect_solved(const std::string& element, const std::string& solver,
                   const std::string& preconditioner, const std::string& matrix) {
  SCOPED_TRACE(element + ", " + solver + ", " + preconditioner + ", " + matrix);
  constexpr double h = 5e-3;
  Problem p = held_beam(element, "linear");
  ImplicitOptions& o = p.integration.implicit;
  o.solver = solver, o.preconditioner = preconditioner, o.matrix = matrix;
  o.relative_residual = 1e-12, o.newton_iterations = 1;
  p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = h;
  LevelProbe<Host> probe(p);
  const TetMesh& mesh = p.body.levels[0];
  const std::vector<double> mass = probe.mass(), inverse = probe.inverse_mass();
  std::vector<Point> start = random_field(mesh.vertices.size(), 0.1, 3);
  for (std::size_t a = 0; a < start.size(); ++a)
    if (inverse[a] == 0) start[a].setZero();
  follow(mesh, start);
  const std::vector<int> list = probe.free();
  const auto n = static_cast<Eigen::Index>(list.size());
  Eigen::VectorXd m(n), v(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int k = list[static_cast<std::size_t>(i)];
    m[i] = mass[static_cast<std::size_t>(k / 3)],
    v[i] = start[static_cast<std::size_t>(k / 3)][k % 3];
  }
  const Eigen::MatrixXd all = probe.stiffness_matrix(probe.zero());
  Eigen::MatrixXd A = h * h * all(list, list);
  A.diagonal() += m;
  const Eigen::VectorXd want = A.ldlt().solve(m.cwiseProduct(v));
  Simulation<Host> s(p);
  s.set_state(probe.zero(), start);
  s.step();
  const std::vector<Point> got = s.velocities();
  double error = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const int k = list[static_cast<std::size_t>(i)];
    error = std::max(error, std::abs(got[static_cast<std::size_t>(k / 3)][k % 3] - want[i]));
  }
  EXPECT_LT(error, 1e-8 * want.lpNorm<Eigen::Infinity>());
  EXPECT_LT(want.norm(), 0.9 * v.norm()) << "or the stiffness has no part";
}

TEST(PiecesInSteps, ImplicitStepsSolveTheSystemOfFreeVertices) {
  expect_solved("linear", "direct", "auto", "auto");
  for (const char* matrix : {"free", "assembled"})
    for (const char* preconditioner : {"block_jacobi", "chebyshev", "multigrid"})
      expect_solved("linear", "conjugate_gradients", preconditioner, matrix);
  for (const char* preconditioner : {"block_jacobi", "chebyshev", "multigrid"})
    expect_solved("nodal", "conjugate_gradients", preconditioner, "auto");
}

TEST(PiecesInSteps, KeepMomentumAndEnergyOfASpin) {
  for (const bool nested : {true, false})
    for (const char* element : {"linear", "nodal"}) {
      SCOPED_TRACE(element);
      Problem p = body_of({composite_beam(nested)}, "neo_hookean");
      p.body.element = {element}, p.body.material.poisson_ratio = 0.45;
      p.body.initial.angular_velocity = {1, 2, 4}, p.body.initial.velocity = {0.3, 0.1, -0.2};
      p.integration.cycle = "single", p.integration.integrator = {"central_difference"};
      p.integration.macro_step = 0.5 * Simulation<Host>(p).levels()[0].critical_step;
      const std::vector<double> m = LevelProbe<Host>(p).mass();
      Simulation<Host> s(p);
      const auto momenta = [&] {
        const std::vector<Point> x = s.positions(), v = s.velocities();
        std::pair<Point, Point> sum{Point::Zero(), Point::Zero()};
        for (std::size_t a = 0; a < m.size(); ++a)
          sum.first += m[a] * v[a], sum.second += m[a] * x[a].cross(v[a]);
        return sum;
      };
      const auto [P, L] = momenta();
      const double energy = s.energies().total();
      double most = 0;
      for (int n = 0; n < 60; ++n) {
        advance(s, 10);
        most = std::max(most, s.energies().elastic);
        EXPECT_NEAR(s.energies().total(), energy, 2e-3 * energy);
      }
      const auto [P_end, L_end] = momenta();
      EXPECT_GT(most, 1e-3 * energy) << "or nothing was stretched";
      EXPECT_LT((P_end - P).norm(), 1e-12 * P.norm());
      EXPECT_LT((L_end - L).norm(), 1e-11 * L.norm());
    }
}

/// Displacements of a beam on the ground, at rest under a force on its top, which lies in the finer
/// half.
std::vector<Point> pressed(const TetMesh& mesh, const std::string& element) {
  Problem p = body_of({mesh}, "neo_hookean");
  p.body.element = {element}, p.body.material.poisson_ratio = 0.3;
  p.body.fixed = {Box{{-1, -1, -1}, {1, 1, 1e-6}}};
  p.body.loads = {{Box{{0.279, -1, 0.0999}, {0.351, 1, 1}}, TotalForce{{0, 0, -4}}, {}}};
  p.integration.cycle = "rest", p.integration.rest.tolerance = 1e-7;
  p.integration.macro_step = 0.5;
  Simulation<Host> s(p);
  advance(s, 2);
  return displacements(s, mesh);
}

/// Largest error in the half with the force, over the largest displacement.
double error_in_part(const TetMesh& mesh, const std::vector<Point>& u, const TetMesh& fine,
                     const std::vector<Point>& want) {
  double error = 0;
  for (std::size_t a = 0; a < u.size(); ++a) {
    if (mesh.vertices[a][0] < 0.24) continue;
    const std::size_t b = vertex_at(fine, mesh.vertices[a]);
    EXPECT_LT((fine.vertices[b] - mesh.vertices[a]).norm(), 1e-9);
    error = std::max(error, (u[a] - want[b]).norm());
  }
  return error / largest(want);
}

TEST(PiecesInSteps, RestNearlyAsAFineMeshWhereTheyAreFine) {
  const TetMesh fine = box_mesh(beam_box, {16, 4, 4}), coarse = box_mesh(beam_box, {8, 2, 2}),
                part = composite_beam(true);
  for (const char* element : {"linear", "nodal"}) {
    const std::vector<Point> want = pressed(fine, element);
    const double alone = error_in_part(coarse, pressed(coarse, element), fine, want),
                 completed = error_in_part(part, pressed(part, element), fine, want);
    EXPECT_LT(completed, 0.06) << element;
    EXPECT_GT(alone, 2 * completed) << element;
  }
}

#if defined(KOKKOS_ENABLE_OPENMP)
TEST(PiecesInSteps, GiveTheSameBitsForOneThreadAndTwo) {
  if (Kokkos::OpenMP().concurrency() < 2) GTEST_SKIP() << "one thread";
  for (const char* element : {"linear", "nodal"})
    for (const char* integrator : {"symplectic_euler", "implicit_euler"}) {
      Problem p = body_of({composite_beam(false, 4)}, "neo_hookean");
      p.body.element = {element}, p.body.fixed = {left_face()}, p.gravity = {0, 0, -9.81};
      p.integration.cycle = "single", p.integration.integrator = {integrator};
      p.integration.macro_step = 2e-4;
      const auto result = [&](int threads) {
        Simulation<Backend<double, Kokkos::OpenMP>> s(p, Kokkos::OpenMP(threads));
        advance(s, 20);
        return s.positions();
      };
      EXPECT_TRUE(same_bits(result(1), result(2))) << element << " " << integrator;
    }
}
#endif

}  // namespace
