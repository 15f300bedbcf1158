// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/solver/registry.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// The same bits however many threads compute them.
namespace {

using namespace plica;
using namespace plica::test;

Problem busy() {
  Problem p = cube_levels(3, 8, "rsv");
  p.body.material.model = "corotational";
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.045, 3);
  p.body.initial.velocity = {0.3, 0, -0.5};
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, 0.003}, {0, 0, 1}}, 0.3, {}});
  p.integration.integrator = {"symplectic_euler", "rk4", "implicit_euler"};
  return p;
}

Problem busy_in_him() {
  Problem p = busy();
  p.integration = {};
  p.integration.cycle = "him", p.integration.macro_step = 1e-3;
  p.body.initial.angular_velocity = {2, 0, 5};
  return p;
}

/// The coarsest level has no multigrid; the others are solved by it, the middle one by one cycle a step.
Problem busy_with_matrices() {
  Problem p = busy();
  p.integration.integrator = {"implicit_euler", "v_cycle_euler", "implicit_euler"};
  p.integration.implicit.solver = "conjugate_gradients";
  p.integration.implicit.preconditioner = "multigrid";
  p.integration.implicit.matrix = "assembled";
  p.integration.macro_step = 2e-3;
  p.body.levels = cube_levels(3, 5, "rsv").body.levels;
  return p;
}

template <class B>
std::vector<Point> result(const typename B::Exec& exec, const Problem& problem = busy()) {
  Simulation<B> simulation(problem, exec);
  advance(simulation, 15);
  std::vector<Point> all;
  for (int level = 0; level < (problem.integration.cycle == "him" ? 1 : 3); ++level)
    for (const auto& field : {simulation.positions(level), simulation.velocities(level)})
      all.insert(all.end(), field.begin(), field.end());
  const Energies e = simulation.energies();
  EXPECT_GT(e.contact, 0);
  all.push_back({e.kinetic, e.elastic, e.potential});
  all.push_back({e.contact, simulation.macro_step(), simulation.levels()[0].critical_step});
  return all;
}

template <class B>
class Reproducible : public testing::Test {};
TYPED_TEST_SUITE(Reproducible, EachBackend);

TYPED_TEST(Reproducible, FromRunToRun) {
  EXPECT_TRUE(same_bits(result<TypeParam>(typename TypeParam::Exec()), result<TypeParam>(typename TypeParam::Exec())));
}

#if defined(KOKKOS_ENABLE_OPENMP)
template <class Real>
void expect_one_thread_is_two() {
  using B = Backend<Real, Kokkos::OpenMP>;
  if (Kokkos::OpenMP().concurrency() < 2) GTEST_SKIP() << "one thread";
  const Kokkos::OpenMP one(1), two(2);
  ASSERT_EQ(one.concurrency(), 1);
  ASSERT_EQ(two.concurrency(), 2);
  for (const Problem& problem : {busy(), busy_in_him(), busy_with_matrices()})
    EXPECT_TRUE(same_bits(result<B>(one, problem), result<B>(two, problem))) << problem.integration.cycle;
}
TEST(Threads, OneAndTwoGiveTheSameBitsInDouble) { expect_one_thread_is_two<double>(); }
TEST(Threads, OneAndTwoGiveTheSameBitsInFloat) { expect_one_thread_is_two<float>(); }

#if defined(KOKKOS_ENABLE_SERIAL)
TEST(Threads, SerialAndOpenMPGiveTheSameBits) {
  using Alone = Backend<double, Kokkos::Serial>;
  using Together = Backend<double, Kokkos::OpenMP>;
  EXPECT_TRUE(same_bits(result<Alone>({}), result<Together>({})));
}
#endif
#endif

}  // namespace
