// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/close_slits.hpp>
#include <plica/meshes/generators.hpp>

namespace {

using namespace plica;

bool is_closed(const TriangleSurface& surface) {
  SurfaceReport report;
  count_edges(surface, report);
  return report.closed();
}

TriangleSurface block() {
  return boundary_surface(box_mesh({{0, 0, 0}, {0.1, 0.1, 0.1}}, {4, 4, 4})).surface;
}

/// Two neighbours along an edge are cut apart: a slit of four edges, which opens by `width` in its
/// middle.
TriangleSurface cut(double width) {
  TriangleSurface surface = block();
  const std::array<int, 3> t = surface.triangles.front();
  const int a = t[0], b = t[1], middle = static_cast<int>(surface.vertices.size());
  const Point x = (surface.vertices[static_cast<std::size_t>(a)] +
                   surface.vertices[static_cast<std::size_t>(b)]) /
                  2;
  const Point inward = surface.vertices[static_cast<std::size_t>(t[2])] - x;
  surface.vertices.push_back(x + width * inward.normalized());
  surface.triangles.front() = {a, middle, t[2]};
  surface.triangles.push_back({middle, b, t[2]});
  return surface;
}

TEST(CloseSlits, ThatAreNarrow) {
  TriangleSurface surface = cut(1e-5);
  ASSERT_FALSE(is_closed(surface));
  EXPECT_EQ(close_slits(surface, 1e-3), 1);
  EXPECT_TRUE(is_closed(surface));
  EXPECT_NEAR(enclosed_volume(surface), 1e-3, 1e-12);
}

TEST(CloseSlits, AndNoWideOnes) {
  for (TriangleSurface surface : {cut(5e-3), block()}) {
    if (is_closed(surface)) surface.triangles.resize(surface.triangles.size() - 6);
    const std::size_t triangles = surface.triangles.size();
    EXPECT_EQ(close_slits(surface, 1e-3), 0);
    EXPECT_EQ(surface.triangles.size(), triangles);
  }
  TriangleSurface closed = block();
  EXPECT_EQ(close_slits(closed, 1), 0);
}

TEST(CloseSlits, OfSeveralEdges) {
  TriangleSurface surface = block();
  surface.triangles.erase(surface.triangles.begin(), surface.triangles.begin() + 2);
  ASSERT_FALSE(is_closed(surface));
  EXPECT_EQ(close_slits(surface, 0.1), 1);
  EXPECT_TRUE(is_closed(surface));
}

}  // namespace
