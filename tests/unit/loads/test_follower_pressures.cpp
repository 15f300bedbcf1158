// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numeric>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/sample_gradients.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Pressures that follow the body: their forces, their stiffness, and both in implicit steps. Those
// of a fluid: test_cavities.cpp.
namespace {

using namespace plica;
using namespace plica::test;

const Selection right_face = Box{{0.1, -1, -1}, {0.1, 1, 1}};

template <class B>
class FollowerPressures : public testing::Test {};
TYPED_TEST_SUITE(FollowerPressures, EachBackend);

// Everywhere on the boundary it is -p dV/dx of the body as it is: no sum, work 3 p V, and none of
// what turns with it.
TYPED_TEST(FollowerPressures, FollowTheBody) {
  using Real = typename TypeParam::Real;
  constexpr double pressure = 40;
  Problem p = cube_levels(2, 4, "rs");
  p.body.material.model = "linear";
  p.body.initial.position = Point(1, 2, 3);  // only directions and areas count
  LevelProbe<TypeParam> without(p);
  p.body.loads = {{Box{{-1, -1, -1}, {1, 1, 1}}, FollowerPressure{pressure}, RampCourse{2}}};
  LevelProbe<TypeParam> with(p);
  std::mt19937 random(3);
  const Eigen::Matrix3d F = random_rotation(random) * Point(1.2, 0.7, 0.9).asDiagonal();
  for (int i = 0; i < 2; ++i) {
    const TetMesh& mesh = p.body.levels[static_cast<std::size_t>(i)];
    const auto u = affine_field(mesh, F, Point::Zero());
    const auto f = minus(with.force(u, with.zero(i), 1, i), without.force(u, with.zero(i), 1, i));
    double work = 0;
    for (std::size_t a = 0; a < f.size(); ++a) work -= f[a].dot(mesh.vertices[a] + u[a]);
    const double at_one = pressure / 2, volume = 1e-3 * F.determinant();
    EXPECT_NEAR(work, 3 * at_one * volume, round_off<Real>(1e4, at_one * volume)) << i;
    EXPECT_LE(std::accumulate(f.begin(), f.end(), Point(0, 0, 0)).norm(),
              round_off<Real>(1e4, at_one * 0.06))
        << i;
  }
}

// On one face it is at first the traction against it; at a quarter turn it still is, where the
// traction is not
TEST(FollowerPressure, AtRestIsTractionAgainstTheFace) {
  Problem p = body_of({jittered_box(decimetre, {3, 3, 3})});
  p.body.loads = {{right_face, FollowerPressure{-10}, {}}};
  LevelProbe<Host> follower(p);
  p.body.loads = {{right_face, Traction{{10, 0, 0}}, {}}};
  LevelProbe<Host> dead_loads(p);
  const auto pull = follower.force(follower.zero()), same = dead_loads.force(dead_loads.zero());
  EXPECT_LE(largest_difference(pull, same), 1e-15);
  Eigen::Matrix3d R;
  R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const auto turned = follower.force(affine_field(p.body.levels[0], R, Point::Zero()));
  for (std::size_t a = 0; a < pull.size(); ++a)
    EXPECT_LE((turned[a] - R * pull[a]).norm(), 1e-12) << a;
}

/// The stiffness of a pressure on some triangles, at a random state.
struct FollowerStiffness {
  Problem p = body_of({jittered_box(decimetre, {3, 3, 3})}, "neo_hookean");
  LevelProbe<Host> without{p}, with;
  std::vector<Point> u = field(5e-3, 11);

  explicit FollowerStiffness(const Selection& where) : with((add_pressure(where), p)) {}

  std::vector<Point> field(double size, unsigned seed) {
    return random_field(with.vertices(), size, seed);
  }
  /// K along a field, by differences: forces are quadratic in positions, for which these are exact.
  std::vector<Point> differences(const std::vector<Point>& along) {
    constexpr double h = 1e-3;
    auto change = minus(follower(along, -h), follower(along, h));
    for (Point& x : change) x /= 2 * h;
    return change;
  }
  std::vector<Point> product(const std::vector<Point>& along) {
    with.force(u, with.zero(), 1);
    return minus(with.tangent(u, along), with.stiffness(u, along));
  }

 private:
  void add_pressure(const Selection& where) {
    p.body.loads = {{where, FollowerPressure{300}, RampCourse{2}}};
  }
  std::vector<Point> follower(const std::vector<Point>& along, double ahead) {
    auto x = u;
    for (std::size_t a = 0; a < x.size(); ++a) x[a] += ahead * along[a];
    return minus(with.force(x, with.zero(), 1), without.force(x, with.zero(), 1));
  }
};

// Of a closed surface the stiffness is symmetric, and all of it is in the product
TEST(FollowerPressure, HasTheDerivativeOfItsForcesAsStiffness) {
  FollowerStiffness closed(Box{{-1, -1, -1}, {1, 1, 1}});
  const auto e = closed.field(1, 12), K = closed.product(e);
  EXPECT_GT(largest(K), 1);
  EXPECT_LE(largest_difference(K, closed.differences(e)), 1e-9 * largest(K));
}

// Of a surface with a free rim it is not: the product has its symmetric part
TEST(FollowerPressure, OfAFreeRimHasTheSymmetricPart) {
  FollowerStiffness face(right_face);
  const auto d = face.field(1, 12), e = face.field(1, 13);
  const double de = dot(d, face.differences(e)), ed = dot(e, face.differences(d));
  EXPECT_GT(std::abs(de - ed), 0.1 * std::abs(de + ed));
  EXPECT_NEAR(dot(d, face.product(e)), (de + ed) / 2, 1e-9 * std::abs(de));
}

// A pressure that takes more stiffness away than there is: the first solve is undone, and the
// second one is what counts, with nothing left of it, also of the pressures that nearly
// incompressible nodal elements carry.
TEST(FollowerPressure, ASolveThatIsUndoneIsNoMiss) {
  for (const double nu : {0.3, 0.495}) {
    Problem p = small_cube("neo_hookean");
    p.body.element = {"nodal"}, p.body.material.poisson_ratio = nu;
    p.body.loads = {{Box{{-1, -1, -1}, {1, 1, 1}}, FollowerPressure{3e4}, {}}};
    p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 0.1;
    p.integration.implicit.solver = "conjugate_gradients",
    p.integration.implicit.preconditioner = "block_jacobi";
    p.integration.implicit.newton_iterations = 1;
    Simulation<Host> simulation(p);
    simulation.step();
    const auto counters = simulation.counters();
    EXPECT_EQ(counters.at("cg_indefinite"), 1) << nu;
    EXPECT_EQ(counters.at("linear_solves"), 2) << nu;
    EXPECT_EQ(counters.at("cg_misses"), 0) << nu;
  }
}

TEST(FollowerPressure, IsBalancedInImplicitSteps) {
  Problem p = body_of({box_mesh({{0, 0, 0}, {0.4, 0.1, 0.1}}, {8, 2, 2})}, "neo_hookean");
  p.body.fixed = {left_face()};
  p.body.loads = {{Box{{0, 0, 0}, {1, 1, 0}}, FollowerPressure{60}, RampCourse{0.5}}};
  p.body.damping.mass = 4;  // [1/s], about critical: at rest after 10 s
  p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 0.05;
  p.integration.implicit.newton_iterations = 30, p.integration.implicit.newton_tolerance = 1e-8;
  Simulation<Host> simulation(p);
  advance(simulation, 200);
  EXPECT_EQ(simulation.counters().at("newton_misses"), 0);
  LevelProbe<Host> probe(p);
  const std::vector<Point> u = displacements(simulation, p.body.levels[0]);
  EXPECT_GT(largest(u), 0.05);
  const auto f = probe.force(u, probe.zero(), 10);
  for (std::size_t a = 0; a < f.size(); ++a)
    if (p.body.levels[0].vertices[a][0] > 1e-9) {
      EXPECT_LE(f[a].norm(), 1e-5) << a;  // of 2.4 N in all
    }
}

}  // namespace
