// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>
#include <plica/kernels/transfer/transfer.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/tolerance.hpp"

// Fields that go from level to level, and from levels to surfaces.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class Transfers : public testing::Test {};
TYPED_TEST_SUITE(Transfers, EachBackend);

std::vector<Point> linear_field(const std::vector<Point>& points) {
  Eigen::Matrix3d A;
  A << 1, 2, -1, 0.5, -2, 3, 0, 1, -0.7;
  std::vector<Point> field;
  for (const Point& x : points) field.push_back(A * x + Point(0.1, -0.2, 0.3));
  return field;
}

template <class B>
std::vector<Point> mapped(const LevelProbe<B>& probe, const Transfer<B>& t,
                          const std::vector<Point>& from, std::size_t to) {
  State<B> source, target("test.target", static_cast<int>(to));
  source.u = device_field<B>(from), source.v = source.u;
  map_fields<B, MapState>(probe.built.hierarchy->exec(), "test", t, source, {}, {}, target, {});
  return to_host<B>(probe.built.hierarchy->exec(), target.u);
}

TYPED_TEST(Transfers, AreExactOnLinearFields) {
  using Real = typename TypeParam::Real;
  const Problem p = cube_levels(3, 5, "rs");
  LevelProbe<TypeParam> probe(p);
  for (int i = 1; i < 3; ++i) {
    const auto &fine = p.body.levels[static_cast<std::size_t>(i - 1)].vertices,
               &coarse = p.body.levels[static_cast<std::size_t>(i)].vertices;
    const auto on_fine = linear_field(fine), on_coarse = linear_field(coarse);
    const auto& level = probe.at(i);
    EXPECT_EQ(level.from_finer.rows, static_cast<int>(coarse.size()));
    EXPECT_LE(
        largest_difference(mapped(probe, level.from_finer, on_fine, coarse.size()), on_coarse),
        round_off<Real>(20));
    EXPECT_LE(largest_difference(mapped(probe, level.to_finer, on_coarse, fine.size()), on_fine),
              round_off<Real>(20));
  }
}

TYPED_TEST(Transfers, LeaveConstrainedVerticesAlone) {
  Problem p = cube_levels(2, 4, "rs");
  p.body.fixed = {left_face()};
  LevelProbe<TypeParam> probe(p);
  const auto& level = probe.at(1);
  EXPECT_EQ(level.from_finer.rows, 64 - 16);
  EXPECT_EQ(level.to_finer.rows, 125 - 25);
}

TYPED_TEST(Transfers, EmbeddingsTransposeIsItsAdjoint) {
  using Real = typename TypeParam::Real;
  Problem p = small_cube();
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.052, 2);  // partly outside
  LevelProbe<TypeParam> probe(p);
  const auto& s = probe.at(0).surface;
  const auto points = static_cast<std::size_t>(s.points);
  const auto u = random_field(probe.vertices(), 1, 1), force = random_field(points, 1, 2);
  const Vectors<TypeParam> f("test.f", probe.vertices());
  Kokkos::parallel_for("test", Kokkos::RangePolicy<typename TypeParam::Exec>(0, s.touched),
                       ScatterToVertices<TypeParam>{s, device_field<TypeParam>(force), f});
  const auto scattered = to_host<TypeParam>({}, f);
  const auto gathered = mapped(probe, s.embedding, u, points);
  EXPECT_NEAR(dot(force, gathered), dot(scattered, u), round_off<Real>(200));
  Point total = Point::Zero();
  for (const Point& x : scattered) total += x;
  for (const Point& x : force) total -= x;
  EXPECT_LE(total.norm(), round_off<Real>(500));
}

TYPED_TEST(Transfers, WeightsSumToOneAndMissesAreCounted) {
  using Real = typename TypeParam::Real;
  for (const char* outside : {"clamp", "extrapolate", "keep"}) {
    SCOPED_TRACE(outside);
    Problem p =
        body_of({jittered_box(decimetre, {4, 4, 4}), ball_mesh({0.05, 0.05, 0.05}, 0.05, 4)});
    p.integration.cycle = "rs", p.integration.outside = outside;
    // those vertices would move in their own level's share of the step only
    if (std::string(outside) == "keep") {
      EXPECT_THROW(LevelProbe<TypeParam>{p}, InputError);
      continue;
    }
    LevelProbe<TypeParam> probe(p);
    const LevelReport& r = probe.built.reports[1];
    const auto& t = probe.at(1).to_finer;
    EXPECT_EQ(r.outside_down, 0);
    EXPECT_GT(r.outside_up, 50);  // most of the box's boundary
    EXPECT_GT(r.largest_miss, 0.5);
    EXPECT_EQ(t.rows, 125);
    const auto weight = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), t.weight);
    for (int row = 0; row < t.rows; ++row) {
      double sum = 0;
      for (int c = 0; c < 4; ++c) sum += static_cast<double>(weight(row, c));
      EXPECT_NEAR(sum, 1, round_off<Real>(4));
    }
  }
}

TEST(MapRules, SwitchByTheDriftOfTheDisplacement) {
  Mapped<double> m;
  m.state = {0.3, 0, 0}, m.variation = {0, 0.4, 0};
  EXPECT_TRUE(MapState::take_state(m, 1.0));
  EXPECT_FALSE(MapVariation::take_state(m, 1.0));
  EXPECT_TRUE(MapSwitched::take_state(m, 0.499));
  EXPECT_FALSE(MapSwitched::take_state(m, 0.501));
}

}  // namespace
