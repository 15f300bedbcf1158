// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
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

/// The coarsest level has no multigrid; the others are solved by it, the middle one by one cycle a
/// step.
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

/// A block that sticks on a slope by friction.
Problem stuck(const std::string& method) {
  Problem p = body_of({jittered_box({{0, 0, 0}, {0.1, 0.1, 0.05}}, {4, 4, 2})}, "neo_hookean");
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.body.damping.mass = 20;
  p.gravity = {1.7, 0, -9.66};
  p.contact.obstacles.push_back({PlaneOptions{}, 0.5, {}});
  if (method == "him")
    p.integration.cycle = method;
  else
    p.integration.integrator = {method};
  if (!is_explicit(method) && method != "him") p.integration.macro_step = 5e-3;
  return p;
}
const std::vector<std::string> sticking_methods = {
    "symplectic_euler", "central_difference", "implicit_euler", "bdf2", "sdirk2", "him"};

template <class B>
void run_until_stuck(Simulation<B>& simulation) {
  while (simulation.time() < 0.8) advance(simulation, 1);
  EXPECT_LT(simulation.slipping().at(0), 0.2);
  EXPECT_LT(largest(simulation.velocities()), 1e-3);
  EXPECT_LT(simulation.wrenches()[0].force[0], -0.5);
}

template <class B>
std::vector<Point> result(const typename B::Exec& exec, const Problem& problem = busy()) {
  Simulation<B> simulation(problem, exec);
  bool touched = false;
  for (int step = 0; step < 15; ++step) {
    advance(simulation, 1);
    touched |= simulation.energies().contact > 0;
  }
  EXPECT_TRUE(touched);
  std::vector<Point> all;
  for (int level = 0; level < (problem.integration.cycle == "him" ? 1 : 3); ++level)
    for (const auto& field : {simulation.positions(level), simulation.velocities(level)})
      all.insert(all.end(), field.begin(), field.end());
  const Energies e = simulation.energies();
  all.push_back({e.kinetic, e.elastic, e.potential});
  all.push_back({e.contact, simulation.macro_step(), simulation.levels()[0].critical_step});
  return all;
}

template <class B>
class Reproducible : public testing::Test {};
TYPED_TEST_SUITE(Reproducible, EachBackend);

TYPED_TEST(Reproducible, FromRunToRun) {
  EXPECT_TRUE(same_bits(result<TypeParam>(typename TypeParam::Exec()),
                        result<TypeParam>(typename TypeParam::Exec())));
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
    EXPECT_TRUE(same_bits(result<B>(one, problem), result<B>(two, problem)))
        << problem.integration.cycle;
}
TEST(Threads, OneTwoAndFourLetABodyStickWithTheSameBits) {
  using B = Backend<double, Kokkos::OpenMP>;
  const int most = Kokkos::OpenMP().concurrency();
  if (most < 2) GTEST_SKIP() << "one thread";
  for (const std::string& method : sticking_methods) {
    Simulation<B> alone(stuck(method), Kokkos::OpenMP(1));
    run_until_stuck(alone);
    for (const int threads : {2, 4}) {
      if (threads > most) continue;
      Simulation<B> together(stuck(method), Kokkos::OpenMP(threads));
      run_until_stuck(together);
      EXPECT_TRUE(same_bits(alone.positions(), together.positions())) << method << " " << threads;
      EXPECT_TRUE(same_bits(alone.velocities(), together.velocities())) << method << " " << threads;
      EXPECT_EQ(alone.friction_work(), together.friction_work()) << method << " " << threads;
      EXPECT_EQ(alone.wrenches()[0].force, together.wrenches()[0].force)
          << method << " " << threads;
    }
  }
}
TEST(Threads, OneAndTwoGiveTheSameBitsInDouble) { expect_one_thread_is_two<double>(); }
#ifndef PLICA_WITHOUT_FLOAT
TEST(Threads, OneAndTwoGiveTheSameBitsInFloat) { expect_one_thread_is_two<float>(); }
#endif

#if defined(KOKKOS_ENABLE_SERIAL)
TEST(Threads, SerialAndOpenMPGiveTheSameBits) {
  using Alone = Backend<double, Kokkos::Serial>;
  using Together = Backend<double, Kokkos::OpenMP>;
  EXPECT_TRUE(same_bits(result<Alone>({}), result<Together>({})));
}
#endif
#endif

// A simulation that was saved and restored goes on as if nothing had happened.

Problem thrown(const std::string& cycle, const std::string& integrator) {
  Problem p = cube_levels(3, 4, cycle);
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.045, 1);
  p.body.initial.velocity = {0.3, 0, -0.5};
  p.body.initial.angular_velocity = {0, 3, 1};
  p.body.prescribed = {{left_face(), SteadyMotion(Point(0, 0.1, 0))}};
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back(
      {PlaneOptions{{0, 0, 0.006}, {0, 0, 1}}, 0.3, SteadyMotion(Point(0, 0, 0.01))});
  p.integration.integrator = {integrator};
  p.integration.macro_step = integrator == "implicit_euler" ? 2e-3 : 5e-4;
  if (cycle != "him") p.integration.distribution = "equal";
  p.integration.allow_unstable = true;  // for a few steps even the one that always grows will do
  return p;
}

template <class B>
void expect_same(Simulation<B>& a, Simulation<B>& b) {
  EXPECT_EQ(a.time(), b.time());
  EXPECT_EQ(a.macro_steps(), b.macro_steps());
  EXPECT_EQ(a.counters(), b.counters());
  EXPECT_EQ(a.residual(), b.residual());
  EXPECT_EQ(a.worst_residual(), b.worst_residual());
  EXPECT_EQ(a.energies().total(), b.energies().total());
  for (int level = 0; level < static_cast<int>(a.levels().size()); ++level) {
    if (a.levels()[static_cast<std::size_t>(level)].share == 0) continue;  // no state of its own
    EXPECT_TRUE(same_bits(a.positions(level), b.positions(level))) << level;
    EXPECT_TRUE(same_bits(a.velocities(level), b.velocities(level))) << level;
  }
}

template <class B>
class SavedStates : public testing::Test {};
TYPED_TEST_SUITE(SavedStates, EachBackend);

TYPED_TEST(SavedStates, ContinueBitForBit) {
  for (const Choice& cycle : cycles())
    for (const Choice& integrator : integrators()) {
      if (cycle.name == "him" && integrator.name != "symplectic_euler") continue;
      SCOPED_TRACE(cycle.name + " " + integrator.name);
      const Problem problem = thrown(cycle.name, integrator.name);
      Simulation<TypeParam> whole(problem), second(problem);
      SavedState saved;
      {
        Simulation<TypeParam> first(problem);
        advance(first, 3);
        saved = first.save();
      }
      advance(whole, 7);
      second.restore(saved);
      EXPECT_EQ(second.macro_steps(), 3);
      EXPECT_FALSE(same_bits(whole.positions(), second.positions()));
      advance(second, 4);
      expect_same(whole, second);
      EXPECT_EQ(whole.save().bytes, second.save().bytes);
    }
}

// What holds a body is the stretches that its contacts carry.
TYPED_TEST(SavedStates, ContinueBitForBitWhileTheBodySticks) {
  for (const std::string& method : sticking_methods) {
    SCOPED_TRACE(method);
    Simulation<TypeParam> whole(stuck(method)), second(stuck(method));
    run_until_stuck(whole);
    second.restore(whole.save());
    advance(whole, 30);
    advance(second, 30);
    expect_same(whole, second);
    EXPECT_EQ(whole.friction_work(), second.friction_work());
    EXPECT_EQ(whole.slipping(), second.slipping());
    EXPECT_EQ(whole.save().bytes, second.save().bytes);
  }
}

TYPED_TEST(SavedStates, KeepPreconditioners) {
  for (const char* preconditioner : {"chebyshev", "multigrid"})
    for (const char* integrator : {"implicit_euler", "v_cycle_euler"}) {
      SCOPED_TRACE(std::string(preconditioner) + " " + integrator);
      Problem problem = thrown("rsv", integrator);
      problem.integration.macro_step = 5e-3;
      problem.integration.implicit.solver = "conjugate_gradients";
      problem.integration.implicit.preconditioner = preconditioner;
      Simulation<TypeParam> whole(problem), second(problem);
      advance(whole, 3);
      second.restore(whole.save());
      advance(whole, 12);
      advance(second, 12);
      expect_same(whole, second);
    }
}

TYPED_TEST(SavedStates, KeepTheLastGoodState) {
  const Problem problem = thrown("rsv", "symplectic_euler");
  Simulation<TypeParam> whole(problem), second(problem);
  advance(whole, 25);
  second.restore(whole.save());
  whole.return_to_last_good();
  second.return_to_last_good();
  EXPECT_EQ(second.macro_steps(), 20);
  advance(whole, 3);
  advance(second, 3);
  expect_same(whole, second);
}

TYPED_TEST(SavedStates, KeepWrenches) {
  const Problem problem = thrown("rsv", "symplectic_euler");
  Simulation<TypeParam> whole(problem), second(problem);
  for (int i = 0; i < 200 && whole.wrenches()[0].force.isZero(); ++i) advance(whole, 1);
  ASSERT_FALSE(whole.wrenches()[0].force.isZero());
  second.restore(whole.save());
  EXPECT_EQ(second.wrenches()[0].force, whole.wrenches()[0].force);
  EXPECT_EQ(second.wrenches()[0].torque, whole.wrenches()[0].torque);
}

template <class B>
std::string refusal_of(Simulation<B>& simulation, const SavedState& saved) {
  const auto before = simulation.save().bytes;
  const std::string text = refusal([&] { simulation.restore(saved); });
  if (!text.empty()) {
    EXPECT_EQ(simulation.save().bytes, before) << "changed although it refused";
  }
  return text;
}

TEST(SavedState, OfAnotherSimulationIsRefused) {
  const Problem problem = thrown("rsv", "symplectic_euler");
  Simulation<Host> simulation(problem);
  const auto from = [&](Problem other) { return Simulation<Host>(std::move(other)).save(); };
  const std::string start = "the saved state is that of another simulation: ";
  Problem other = problem;
  other.integration.macro_step = 4e-4;
  EXPECT_EQ(refusal_of(simulation, from(other)), start + "the macro step differs");
  other = problem;
  other.body.levels.pop_back();
  EXPECT_EQ(refusal_of(simulation, from(other)), start + "the number of levels differs");
  other = problem;
  other.body.levels[1] = jittered_box(decimetre, {2, 2, 2});
  EXPECT_EQ(refusal_of(simulation, from(other)), start + "the size of level 1's state.u differs");
  EXPECT_EQ(refusal_of(simulation, from(thrown("rs", "symplectic_euler"))),
            start + "the size of level 0's start.u differs");
#ifndef PLICA_WITHOUT_FLOAT
  EXPECT_EQ(refusal_of(simulation, Simulation<HostFloat>(problem).save()),
            start + "the precision differs");
#endif
}

TEST(SavedState, CutShortOrTooLongIsRefused) {
  Simulation<Host> simulation(thrown("rsv", "implicit_euler"));
  advance(simulation, 2);
  const SavedState saved = simulation.save();
  for (std::size_t size = 0; size < saved.bytes.size(); size += 1 + saved.bytes.size() / 50)
    EXPECT_EQ(refusal_of(simulation, {{saved.bytes.begin(),
                                       saved.bytes.begin() + static_cast<std::ptrdiff_t>(size)}}),
              "the saved state is damaged: it ends early");
  SavedState longer = saved;
  longer.bytes.resize(longer.bytes.size() + 3);
  EXPECT_EQ(refusal_of(simulation, longer), "the saved state is damaged: 3 bytes too many");
}

}  // namespace
