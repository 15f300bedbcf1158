// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/solver/material_points.hpp>
#include <plica/drivers/study/level_probe.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/tolerance.hpp"

namespace {

using namespace plica;
using namespace plica::test;

Point linear(const Point& X) { return {0.1 + X.x(), 2 * X.y() - X.z(), 0.5 * X.x() + X.z()}; }

template <class B>
class MaterialPointsOn : public testing::Test {};
TYPED_TEST_SUITE(MaterialPointsOn, EachBackend);

TYPED_TEST(MaterialPointsOn, FollowLinearFields) {
  const TetMesh mesh = jittered_box(decimetre, {3, 3, 3});
  std::vector<Point> points = random_field(20, 0.05, 4);
  for (Point& p : points) p += Point::Constant(0.05);
  const MaterialPoints<TypeParam> watched(mesh, points);
  std::vector<Point> u, v;
  for (const Point& X : mesh.vertices) u.push_back(linear(X)), v.push_back(linear(2 * X));
  const auto motion = watched.sample({}, device_field<TypeParam>(u), device_field<TypeParam>(v));
  ASSERT_EQ(motion.displacement.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LE((watched.rest()[i] - points[i]).norm(), round_off<double>(20, 0.1));
    EXPECT_LE((motion.displacement[i] - linear(points[i])).norm(), round_off<typename TypeParam::Real>(20));
    EXPECT_LE((motion.velocity[i] - linear(2 * points[i])).norm(), round_off<typename TypeParam::Real>(20));
  }
}

TEST(MaterialPoints, OutsideGoToTheNearest) {
  const TetMesh mesh = jittered_box(decimetre, {2, 2, 2});
  const MaterialPoints<Host> watched(mesh, {{0.13, 0.04, 0.05}, {0.1, 0.02, 0.02}});
  EXPECT_LE((watched.rest()[0] - Point(0.1, 0.04, 0.05)).norm(), 1e-12);
  EXPECT_LE((watched.rest()[1] - Point(0.1, 0.02, 0.02)).norm(), 1e-12);
  EXPECT_THROW(MaterialPoints<Host>(mesh, {Point::Constant(std::nan(""))}), InputError);
}

}  // namespace
