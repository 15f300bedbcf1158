// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/run/energy_meter.hpp>

#include "support/backends.hpp"
#include "support/him_pieces.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// What the cycle him conserves: the energy p.A(x) p/2 + V(x) and a free body's momenta, to what
// steps leave of them.
namespace {

using namespace plica;
using namespace plica::test;

/// A run with its momenta to be looked at.
template <class B>
struct HimRun {
  explicit HimRun(const Problem& problem)
      : built(build_hierarchy<B>(problem, {})),
        meter(*built.hierarchy, built.meshes.front(), built.reports.front().mass, problem.gravity),
        mass(lumped_masses(built.meshes[0], {problem.body.material.density})) {}
  BuiltHierarchy<B> built;
  EnergyMeter<B> meter;
  std::vector<double> mass;
  double time = 0;

  const LevelData<B>& level() { return (*built.hierarchy)[0]; }
  void advance(int steps) {
    for (int n = 0; n < steps; ++n, time += built.macro_step)
      built.stepper->step(*built.hierarchy, time, built.macro_step);
    ASSERT_FALSE(built.stepper->lost_stability(*built.hierarchy, 0));
  }
  std::vector<Point> field(const Vectors<B>& x) { return to_host<B>(built.hierarchy->exec(), x); }
  std::vector<Point> momenta() {
    return field(dynamic_cast<const HimStepper<B>&>(*built.stepper).momenta());
  }

  struct Sums {
    Point momentum = Point::Zero(), moment = Point::Zero(), moment_of_mass = Point::Zero();
    double energy = 0, kinetic = 0;
  };
  /// The moment about where forces act, half a step ahead.
  Sums sums() {
    Sums s;
    const auto u = field(level().state.u), v = field(level().state.v), p = momenta();
    for (std::size_t a = 0; a < p.size(); ++a) {
      const Point x = built.meshes[0].vertices[a] + u[a] + 0.5 * built.macro_step * v[a];
      s.momentum += mass[a] * v[a], s.moment += x.cross(p[a]),
          s.moment_of_mass += mass[a] * x.cross(v[a]);
      s.kinetic += 0.5 * p[a].dot(v[a]);
    }
    const Energies e = meter.all(time);
    s.energy = s.kinetic + e.elastic + e.potential;
    return s;
  }

  /// Largest change of the energy over so many times `steps`, over the largest kinetic energy.
  double energy_error(int times, int steps) {
    const double start = sums().energy;
    double error = 0, most = 0;
    for (int n = 0; n < times; ++n) {
      advance(steps);
      const Sums now = sums();
      error = std::max(error, std::abs(now.energy - start)), most = std::max(most, now.kinetic);
    }
    return error / most;
  }
};

Problem spinning() {
  Problem p = him_beam(false, "neo_hookean");
  p.body.material.young_modulus = 100e3;
  p.body.initial.angular_velocity = {2, 5, 12};
  p.body.initial.velocity = {0.3, -0.2, 0.1};
  return p;
}

template <class B>
class HimOnEachBackend : public testing::Test {};
TYPED_TEST_SUITE(HimOnEachBackend, EachBackend);

TYPED_TEST(HimOnEachBackend, KeepsTheMomentaOfAFreeBody) {
  using Real = typename TypeParam::Real;
  HimRun<TypeParam> run(spinning());
  const auto before = run.sums();
  double wavers = 0;
  for (int n = 0; n < 20; ++n) {
    run.advance(20);
    wavers = std::max(wavers, (run.sums().moment_of_mass - before.moment_of_mass).norm());
  }
  const auto after = run.sums();
  const double size = before.moment.norm();
  EXPECT_LE((after.momentum - before.momentum).norm(),
            round_off<Real>(4000, before.momentum.norm()));
  // as exactly as the frames' force is found
  EXPECT_LE((after.moment - before.moment).norm(), 1e-4 * size);
  EXPECT_LE(wavers, 0.05 * size);
  EXPECT_GT((run.field(run.level().state.u)[0]).norm(), 1);  // it did turn
}

TEST(Him, KeepsTheEnergyOfASpin) {
  Problem p = spinning();
  p.integration.him.dissipation = 0;
  EXPECT_LE(HimRun<Host>(p).energy_error(60, 50), 0.03);
}

TEST(Him, KeepsTheEnergyOfASwing) {
  Problem p = him_beam(true, "neo_hookean");
  p.body.material.young_modulus = 100e3;
  p.body.fixed = {Box{{-1e-9, -1, 0.1 - 1e-9}, {1e-9, 1, 1}}};
  p.gravity = {0, 0, -9.81};
  p.integration.him.dissipation = 0;
  EXPECT_LE(HimRun<Host>(p).energy_error(60, 50), 0.02);
}

// What the frames do to momenta is what turning them by moving the body does to the kinetic energy.
TEST(Him, FramesActBackByTheGradientOfTheKineticEnergy) {
  for (const bool alone : {false, true})
    for (const bool held : {false, true}) {
      Problem problem = alone ? him_beam_alone() : him_beam(false);
      if (held) problem.body.fixed = {left_face()};
      Pieces pieces(problem);
      ASSERT_TRUE(pieces.fit(6));
      InverseMass<Host>& A = *pieces.inverse_mass;
      const auto n = pieces.levels[0].vertices.size();
      const auto inverse_mass = pieces.probe.inverse_mass();
      std::vector<Point> u(n), along = random_field(n, 0.01, 2),
                               momentum = random_field(n, 1e-3, 3);
      for (std::size_t a = 0; a < n; ++a) {
        const Point& x = pieces.levels[0].vertices[a];
        u[a] = {0.05 * std::sin(9 * x[0]), 0.4 * x[0] * x[0],
                0.02 * std::sin(40 * x[1]) + 0.3 * x[0] * x[0]};
        if (!(inverse_mass[a] > 0)) u[a] = along[a] = momentum[a] = Point::Zero();
      }
      const Vectors<Host> v("v", n), p = device_field<Host>(momentum);
      const auto kinetic = [&](double step) {
        std::vector<Point> there = u;
        for (std::size_t a = 0; a < n; ++a) there[a] += step * along[a];
        A.turn({}, device_field<Host>(there));
        A.apply({}, p, v);
        double sum = 0;
        for (std::size_t a = 0; a < n; ++a)
          for (int k = 0; k < 3; ++k) sum += 0.5 * momentum[a][k] * v(a, k);
        return sum;
      };
      const double slope = (kinetic(1e-4) - kinetic(-1e-4)) / 2e-4;
      kinetic(0);
      const double t = 1e-7;  // too short for the force to change what it depends on
      const Vectors<Host> pushed = device_field<Host>(momentum);
      A.solve_frame_force({}, p, t);
      A.push_and_answer({}, t, pushed, {}, v);
      double work = 0;
      for (std::size_t a = 0; a < n; ++a)
        for (int k = 0; k < 3; ++k) work += (pushed(a, k) - momentum[a][k]) / t * along[a][k];
      EXPECT_GT(std::abs(slope), 0);
      EXPECT_NEAR(-work / slope, 1, 1e-6);

      // What is pushed and answered at once is answered as it is by itself
      const double long_time = 1e-2;
      const Vectors<Host> v_before = device_field<Host>(to_host<Host>({}, v)),
                          pushed_too = device_field<Host>(momentum);
      const auto expect_answered = [&](const Vectors<Host>& at_once) {
        A.apply({}, pushed, v);
        const auto want = to_host<Host>({}, v);
        A.apply({}, p, v);
        // the share of which is kept in float
        const double by_push = largest_difference(want, to_host<Host>({}, v));
        EXPECT_GT(largest_difference(to_host<Host>({}, pushed), momentum),
                  1e-5 * largest(momentum));  // a push that shows
        EXPECT_LE(largest_difference(to_host<Host>({}, at_once), want),
                  round_off<double>(1000, largest(want)) + round_off<float>(10, by_push));
      };
      const Vectors<Host> v_at_once("v", n);
      copy(Host::Exec(), pushed, p);
      A.solve_frame_force({}, p, long_time);
      A.push_and_accelerate({}, long_time, pushed, v_before, v_at_once);
      combine<Host>({}, "velocity", long_time, v_at_once, 1, v_before, v_at_once);
      expect_answered(v_at_once);
      copy(Host::Exec(), pushed, p);
      A.solve_frame_force({}, p, long_time);
      A.push_and_answer({}, long_time, pushed, pushed_too, v_at_once);
      EXPECT_TRUE(same_bits(to_host<Host>({}, pushed_too), to_host<Host>({}, pushed)));
      expect_answered(v_at_once);
    }
}

TYPED_TEST(HimOnEachBackend, ContinuesASavedRunBitForBit) {
  const Problem p = spinning();
  Simulation<TypeParam> whole(p), second(p);
  advance(whole, 5);
  second.restore(whole.save());
  advance(whole, 5), advance(second, 5);
  EXPECT_TRUE(same_bits(whole.positions(), second.positions()));
  EXPECT_TRUE(same_bits(whole.velocities(), second.velocities()));
}

// A state that is read and put back goes on as it would have: velocities that were made from
// momenta give those again.
TEST(Him, GoesOnFromAStateThatIsPutBack) {
  Problem p = spinning();
  p.integration.him.dissipation = 0;
  Simulation<Host> left_alone(p), put_back(p);
  advance(left_alone, 40), advance(put_back, 40);
  put_back.set_state(displacements(put_back, p.body.levels[0]), put_back.velocities());
  advance(left_alone, 20), advance(put_back, 20);
  const double size = largest_difference(left_alone.positions(), p.body.levels[0].vertices);
  EXPECT_GT(size, 0.05);
  EXPECT_LE(largest_difference(left_alone.positions(), put_back.positions()),
            2e-5 * size);  // the frames' force is found to 1e-3
}

}  // namespace
