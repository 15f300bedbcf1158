// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <plica/core/launch_queue.hpp>
#include <plica/drivers/elastic/elasticity.hpp>
#include <plica/drivers/level/build_level.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/kernels/elastic/gather_forces.hpp>
#include <plica/kernels/materials/list.hpp>

#include "like_device/step_problems.hpp"
#include "support/backends.hpp"
#include "support/simulate.hpp"

// What the default execution space computes, a GPU where there is one, beside what the host does in
// double: kernels of forces of each material, and whole macro steps.
namespace {

using namespace plica;
using namespace plica::test;

using Device = Kokkos::DefaultExecutionSpace;

template <class Real>
struct OnDevice : testing::Test {};
using Precisions =
    std::conditional_t<is_built<float>, testing::Types<float, double>, testing::Types<double>>;
TYPED_TEST_SUITE(OnDevice, Precisions);

/// The greatest difference, over the greatest length.
double difference(const std::vector<Point>& got, const std::vector<Point>& want) {
  EXPECT_EQ(got.size(), want.size());
  double apart = 0, longest = 0;
  for (std::size_t a = 0; a < want.size(); ++a) {
    EXPECT_TRUE(got[a].allFinite()) << a;
    apart = std::max(apart, (got[a] - want[a]).norm());
    longest = std::max(longest, want[a].norm());
  }
  EXPECT_GT(longest, 0);
  return apart / longest;
}

template <class B>
std::vector<Point> points_of(const Vectors<B>& field) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), field);
  std::vector<Point> points;
  for (std::size_t a = 0; a < host.extent(0); ++a)
    points.emplace_back(host(a, 0), host(a, 1), host(a, 2));
  return points;
}

/// Forces of a bent and twisted block, and the product of its stiffness with its displacements.
template <class B>
std::array<std::vector<Point>, 2> forces_of(const std::string& material, Element element) {
  Problem p;
  p.body.element = {name_of(element)};
  p.body.levels = {box_mesh({Point::Zero(), Point(0.1, 0.08, 0.12)}, {5, 4, 6})};
  p.body.material = complete({material, 20e3, 0.4, 1000});
  const TetMesh& mesh = p.body.levels.front();
  LevelData<B> level =
      build_level<B>(p.body, mesh, level_constants(p.body, mesh, Point::Zero(), 0));
  const Vectors<B> u("u", mesh.vertices.size());
  const auto host = Kokkos::create_mirror_view(u);
  for (std::size_t a = 0; a < mesh.vertices.size(); ++a) {
    const Point& x = mesh.vertices[a];
    const Point moved(0.01 * std::sin(20 * x[2]), 0.5 * x[0] * x[2], 0.4 * x[1] * x[2]);
    for (int k = 0; k < 3; ++k)
      host(a, static_cast<std::size_t>(k)) = static_cast<typename B::Real>(moved[k]);
  }
  Kokkos::deep_copy(u, host);
  level.state.u = u;
  const typename B::Exec exec;
  const auto elasticity = make_elasticity<B>(material, element);
  elasticity->force(exec, level, level.state, 1);
  gather_forces<B>(exec, level.model, level.partial, {}, level.f);
  exec.fence();
  std::array<std::vector<Point>, 2> results{points_of<B>(level.f), {}};
  elasticity->tangent(exec, level, u, u, 0);
  gather_forces<B>(exec, level.model, level.partial, {}, level.f);
  exec.fence();
  results[1] = points_of<B>(level.f);
  return results;
}

TYPED_TEST(OnDevice, ForcesAreTheHosts) {
  using B = Backend<TypeParam, Device>;
  const double bound = sizeof(TypeParam) == sizeof(float) ? 1e-3 : 1e-11;
  Materials::for_each([&](auto material) {
    const std::string name = decltype(material)::name;
    for (const Element element : {Element::linear, Element::nodal}) {
      SCOPED_TRACE(name + ", " + name_of(element));
      const auto got = forces_of<B>(name, element);
      const auto want = forces_of<Host>(name, element);
      EXPECT_LT(difference(got[0], want[0]), bound);
      EXPECT_LT(difference(got[1], want[1]), bound);
    }
  });
}

// What touches is decided by signs, which rounding may turn; and float's is 1e9 times double's.
TYPED_TEST(OnDevice, StepsAreTheHosts) {
  using B = Backend<TypeParam, Device>;
  const bool single = sizeof(TypeParam) == sizeof(float);
  for (const StepProblem& each : step_problems()) {
    SCOPED_TRACE(each.name);
    Problem problem = each.make();
    problem.integration.implicit.relative_residual = single ? 1e-5 : 1e-10;
    const std::vector<Point>& rest = problem.body.levels.front().vertices;
    Simulation<B> device(problem);
    Simulation<Host> host(problem);
    advance(device, 12), advance(host, 12);
    const auto moved = [&](std::vector<Point> x) {
      for (std::size_t a = 0; a < x.size(); ++a) x[a] -= rest[a];
      return x;
    };
    EXPECT_LT(difference(moved(device.positions()), moved(host.positions())), single ? 5e-3 : 1e-7);
  }
}

// Graphs are another way to launch, nothing else.
TYPED_TEST(OnDevice, GraphsKeepTheBits) {
  using B = Backend<TypeParam, Device>;
  for (const StepProblem& each : step_problems()) {
    SCOPED_TRACE(each.name);
    Problem problem = each.make();
    if (sizeof(TypeParam) == sizeof(float))  // what float can reach
      problem.integration.implicit.relative_residual = 1e-5;
    Simulation<B> gathered(problem), apart(problem);
    apart.use_graphs(false);
    advance(gathered, 16), advance(apart, 16);
    EXPECT_EQ(difference(gathered.positions(), apart.positions()), 0);
    EXPECT_EQ(apart.counters()["launches_in_graphs"], 0);
    if constexpr (gathers<Device>) {
      EXPECT_GT(gathered.counters()["launches_in_graphs"], 10);
    }
  }
}

}  // namespace
