// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <plica/core/text.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/mesh_quality.hpp>

#include "support/bodies.hpp"
#include "support/refusal.hpp"

namespace {

using namespace plica;
using namespace plica::test;

TEST(StartInObstacles, IsSaidOrRefused) {
  Problem p = small_cube();
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  const std::vector<Point>& vertices = p.body.levels[0].vertices;
  const Point top = *std::ranges::max_element(vertices, {}, [](const Point& x) { return x.sum(); });
  const auto starts_in = [&](double radius) {
    p.contact.obstacles = {{SphereOptions{top, radius}, {}, {}}};
    return starts_in_obstacles(p);
  };
  EXPECT_TRUE(starts_in(1e-6).empty());
  const double edge = mean_edge_length(p.body.levels[0]);
  const std::vector<std::string> found = starts_in(0.6 * edge);
  ASSERT_EQ(found.size(), 1);
  EXPECT_TRUE(
      found[0].starts_with("contact.obstacles.0: the body starts inside it, " + number(0.6 * edge, 3) + " m deep"))
      << found[0];
  EXPECT_EQ(refusal([&] { starts_in(100); }),
            "contact.obstacles.0 contains the whole body at the start; expected a body outside");
}

}  // namespace
