// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <plica/core/error.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Normals of the embedded surface, for renderers.
namespace {

using namespace plica;
using namespace plica::test;

const Point middle(0.05, 0.05, 0.05);

Problem cube_with(const TriangleSurface& surface) {
  Problem p = cube_levels(1, 4, "single");
  p.body.surface = surface;
  return p;
}

/// Turns the whole body by a rotation about the middle of the cube.
template <class B>
void turn(Simulation<B>& simulation, const TetMesh& rest, const Eigen::Matrix3d& rotation) {
  std::vector<Point> u;
  for (const Point& x : rest.vertices) u.push_back(middle + rotation * (x - middle) - x);
  simulation.set_state(u, std::vector<Point>(u.size(), Point(Point::Zero())));
}

template <class B>
class SurfaceNormalsOn : public testing::Test {};
TYPED_TEST_SUITE(SurfaceNormalsOn, EachBackend);

// The corners of an icosahedron and the middles of its edges lie on axes of symmetry, so that
// normals there are radial. Else the error of a normal is of the first order in the edge, h = 0.33
// and 0.17 of the radius.
TYPED_TEST(SurfaceNormalsOn, OfASphereAreRadial) {
  const double rounding = round_off<typename TypeParam::Real>(100);
  const std::vector<std::pair<int, double>> errors = {{1, 0}, {2, 0.011}, {3, 0.0055}};
  for (const auto& [subdivisions, most] : errors) {
    SCOPED_TRACE(subdivisions);
    const Problem p = cube_with(sphere_surface(middle, 0.04, subdivisions));
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(1.1, Point(1, 2, -1).normalized()).toRotationMatrix();
    Simulation<TypeParam> simulation(p);
    for (const bool turned : {false, true}) {
      if (turned) turn(simulation, p.body.levels[0], rotation);
      const auto x = simulation.surface_positions(), normals = simulation.surface_normals();
      ASSERT_EQ(normals.size(), x.size());
      double worst = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        EXPECT_NEAR(normals[i].norm(), 1, rounding);
        worst = std::max(worst, (normals[i] - (x[i] - middle).normalized()).norm());
      }
      EXPECT_LE(worst, most + rounding);
      EXPECT_GE(worst, 0.9 * most - rounding);
    }
  }
}

// At a corner of a cube the angles of each face's triangles sum to 90 degrees, however the faces
// are cut: the normal is along the diagonal.
TYPED_TEST(SurfaceNormalsOn, OfACubeDoNotSeeHowItsFacesAreCut) {
  const double rounding = round_off<typename TypeParam::Real>(100);
  const TetMesh cube = box_mesh({{0, 0, 0}, {0.1, 0.1, 0.1}}, {3, 3, 3});
  Problem p = body_of({cube});
  p.body.surface = boundary_surface(cube).surface;
  const Simulation<TypeParam> simulation(p);
  const auto normals = simulation.surface_normals();
  const auto& x = p.body.surface->vertices;
  for (std::size_t i = 0; i < x.size(); ++i) {
    Point expected;
    for (int k = 0; k < 3; ++k) expected[k] = x[i][k] < 1e-9 ? -1 : x[i][k] > 0.1 - 1e-9 ? 1 : 0;
    EXPECT_LE((normals[i] - expected.normalized()).norm(), rounding) << x[i].transpose();
  }
}

TYPED_TEST(SurfaceNormalsOn, AreThoseOfTheMovedTriangles) {
  Problem p = cube_with(sphere_surface(middle, 0.04, 2));
  p.gravity = {3, 0, -9.81};
  p.body.fixed = {Box{{-1, -1, -1}, {1, 1, 0.001}}};
  Simulation<TypeParam> simulation(p);
  const auto at_rest = simulation.surface_normals();
  while (simulation.time() < 0.05) advance(simulation, 1);
  const auto normals = simulation.surface_normals();
  EXPECT_GT(largest_difference(normals, at_rest), 1e-3);
  EXPECT_LE(largest_difference(normals, normals_of_points({simulation.surface_positions(),
                                                           p.body.surface->triangles})),
            round_off<typename TypeParam::Real>(1000));
  const Kokkos::View<float* [3], Kokkos::LayoutLeft, typename TypeParam::Memory> to("to",
                                                                                    normals.size());
  simulation.read_surface_normals(to);
  Kokkos::fence();
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), to);
  for (std::size_t i = 0; i < normals.size(); ++i)
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(host(i, k), normals[i][k], round_off<float>(2));
}

TEST(SurfaceNormals, NeedASurface) {
  Simulation<Host> simulation(cube_levels(1, 2, "single"));
  EXPECT_TRUE(simulation.surface_normals().empty());
  const Kokkos::View<double* [3], Kokkos::LayoutRight, Host::Memory> to("to", 3);
  EXPECT_THROW(simulation.read_surface_normals(to), InputError);
}

// A point whose triangles are flat has no direction.
TEST(SurfaceNormals, OfFlatTrianglesAreZero) {
  const auto normals =
      normals_of_points({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}});
  EXPECT_EQ(normals[1], Point(0, 0, 0));
  EXPECT_EQ(normals[0], Point(0, 0, 1));
}

}  // namespace
