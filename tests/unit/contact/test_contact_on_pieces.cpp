// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/body/embed_free.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/composite_box.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Contact of a mesh of two pieces, where vertices of the finer one follow the coarser one and have
// no mass.
namespace {

using namespace plica;
using namespace plica::test;

TriangleSurface skin(const std::array<int, 3>& cells) {
  return boundary_surface(box_mesh(beam_box, cells)).surface;
}

TEST(ContactOnPieces, ActsOnVerticesWithMass) {
  for (const bool nested : {true, false})
    for (const std::array<int, 3>& cells : {std::array{16, 4, 4}, std::array{27, 7, 7}}) {
      const TetMesh mesh = composite_beam(nested);
      const BodyLocator locator(mesh, {});
      const std::vector<Point> points = skin(cells).vertices;
      const Embedding in = embed_free(mesh, {}, locator, points, {});
      std::vector<char> follows(mesh.vertices.size(), 0);
      for (const int v : mesh.followers.vertex) follows[static_cast<std::size_t>(v)] = 1;
      int exact = 0;
      for (std::size_t p = 0; p < points.size(); ++p) {
        Point at = Point::Zero();
        double sum = 0;
        for (std::size_t c = 0; c < 4; ++c) {
          const auto v = static_cast<std::size_t>(in.vertices[p][c]);
          at += in.weights[p][c] * mesh.vertices[v], sum += in.weights[p][c];
          EXPECT_FALSE(follows[v] && std::abs(in.weights[p][c]) > 1e-9) << "point " << p;
        }
        EXPECT_NEAR(sum, 1, 1e-12);
        EXPECT_LT((at - points[p]).norm(), 0.013);  // a quarter of a coarse cell
        exact += (at - points[p]).norm() < 1e-9;
      }
      EXPECT_GT(exact, 0.9 * static_cast<double>(points.size()));
    }
}

/// Force on a ball that is pressed into the top of a beam on the ground, and the beam's
/// displacements [N, m].
std::pair<double, std::vector<Point>> poked(const TetMesh& mesh, double x) {
  Problem p = body_of({mesh}, "neo_hookean");
  p.body.element = {"nodal"}, p.body.material.poisson_ratio = 0.3;
  p.body.fixed = {Box{{-1, -1, -1}, {1, 1, 1e-6}}};
  p.body.surface = skin({16, 4, 4});
  p.body.damping.mass = 30;
  SphereOptions ball;
  ball.centre = {x, 0.05, 0.131}, ball.radius = 0.03;
  ObstacleOptions tool{ball, {}, {}};
  tool.motion = Point(0, 0, -0.06);
  p.contact.obstacles.push_back(tool);
  p.integration.cycle = "single", p.integration.macro_step = 1e-3;
  Simulation<Host> s(p);
  while (s.time() < 0.2) advance(s, 1);
  return {s.wrenches()[0].force.norm(), displacements(s, mesh)};
}

TEST(ContactOnPieces, PressesNearlyAsOnAFineMesh) {
  const auto [want, fine] = poked(box_mesh(beam_box, {16, 4, 4}), 0.3);
  const auto [got, part] = poked(composite_beam(true), 0.3);
  const auto [coarse, alone] = poked(box_mesh(beam_box, {8, 2, 2}), 0.3);
  EXPECT_NEAR(got / want, 1, 0.03);
  EXPECT_GT(std::abs(coarse / want - 1), 2 * std::abs(got / want - 1));
  EXPECT_NEAR(largest(part) / largest(fine), 1, 0.05);
}

// Over the border, where the finer piece's vertices follow
TEST(ContactOnPieces, StaysSoundOverTheBorder) {
  const auto [want, fine] = poked(box_mesh(beam_box, {16, 4, 4}), 0.2);
  for (const bool nested : {true, false}) {
    const auto [got, part] = poked(composite_beam(nested), 0.2);
    EXPECT_NEAR(got / want, 1, 0.4);
    EXPECT_LT(largest(part), 0.03);
  }
}

}  // namespace
