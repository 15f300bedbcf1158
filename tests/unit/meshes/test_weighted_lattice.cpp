// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/cell_contents.hpp>
#include <plica/meshes/compare_levels.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/lattice.hpp>
#include <plica/meshes/refinement.hpp>
#include <plica/meshes/reordering.hpp>

#include "mesh_input.hpp"

namespace {

using namespace plica;

TriangleSurface box_surface(const Point& min, const Point& max) {
  return boundary_surface(box_mesh({min, max}, {1, 1, 1})).surface;
}

TriangleSurface together(TriangleSurface a, const TriangleSurface& b, bool inward) {
  const auto first = static_cast<int>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (auto t : b.triangles) {
    for (int& v : t) v += first;
    if (inward) std::swap(t[1], t[2]);
    a.triangles.push_back(t);
  }
  return a;
}

MeshSize size_of(const TetMesh& mesh) { return mesh_size(mesh, {1000.0}); }

TEST(InsideLines, OfABoxWhoseEdgesLieOnLines) {
  const TriangleSurface box = box_surface(Point(0.5, 0.5, 0.25), Point(2.5, 3.5, 1.75));
  const InsideLines lines(box, Point::Zero(), 1, {4, 5});
  double inside = 0;
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 4; ++i)
      for (const auto& [from, to] : lines.at(i, j)) {
        EXPECT_EQ(from, 0.25);
        EXPECT_EQ(to, 1.75);
        inside += to - from;
      }
  EXPECT_EQ(inside, 2 * 3 * 1.5);  // of two opposite sides on lines one counts
}

TEST(InsideLines, PartsThatOverlapAreOneAndHolesAreNone) {
  const TriangleSurface low = box_surface(Point(0, 0, 0), Point(1, 1, 2)),
                        high = box_surface(Point(0, 0, 1), Point(1, 1, 3));
  const auto at = [](const TriangleSurface& surface) {
    const InsideLines lines(surface, Point::Zero(), 1, {1, 1});
    std::vector<double> ends;
    for (const auto& [from, to] : lines.at(0, 0)) ends.insert(ends.end(), {from, to});
    return ends;
  };
  EXPECT_EQ(at(together(low, high, false)), (std::vector<double>{0, 3}));
  const TriangleSurface hole = box_surface(Point(0.25, 0.25, 0.5), Point(0.75, 0.75, 1));
  EXPECT_EQ(at(together(low, hole, true)), (std::vector<double>{0, 0.5, 1, 2}));
}

// A box of 2.5 cells along each edge in 3: the outer ones are filled by three quarters of each
// length
TEST(WeightedLattice, OfABoxBetweenItsCells) {
  const WeightedLattice lattice =
      weighted_lattice(box_surface(Point::Zero(), Point::Constant(0.025)), 0.01);
  ASSERT_EQ(lattice.mesh.tets.size(), 27u * 6);
  ASSERT_EQ(lattice.mesh.filled.size(), lattice.mesh.tets.size());
  for (std::size_t cell = 0; cell < 27; ++cell) {
    double expected = 1, filled = 0;
    for (const std::size_t place : {cell % 3, cell / 3 % 3, cell / 9})
      expected *= place == 1 ? 1 : 0.75;
    for (std::size_t t = 0; t < 6; ++t) filled += lattice.mesh.filled[6 * cell + t] / 6;
    EXPECT_NEAR(filled, expected, 0.01) << cell;
  }
  EXPECT_EQ(lattice.shared_cells, 0);
}

TEST(WeightedLattice, HasTheBodysVolumeAndCentroid) {
  const Point centre(1, 2, 3);
  const TriangleSurface ball = sphere_surface(centre, 0.5, 4);
  const TriangleSurface shell = together(ball, sphere_surface(centre, 0.3, 4), true);
  for (const TriangleSurface* surface : {&ball, &shell})
    for (const double size : {0.9, 0.3, 0.1}) {
      const WeightedLattice lattice = weighted_lattice(*surface, size);
      const MeshSize found = size_of(lattice.mesh);
      // by 8 lines a cell
      EXPECT_NEAR(found.volume / enclosed_volume(*surface), 1, size > 0.5 ? 0.02 : 0.01) << size;
      EXPECT_LT((found.centroid - centre).norm(), 0.004) << size;
      EXPECT_GE(std::ranges::min(lattice.mesh.filled), 0.0199);
      EXPECT_LE(std::ranges::max(lattice.mesh.filled), 1.0);
    }
}

TEST(WeightedLattice, OfOneSurfaceAreOneBodyWhateverTheirCells) {
  const TriangleSurface plate = box_surface(Point::Zero(), Point(0.1, 0.1, 0.012));
  const MeshSize fine = size_of(weighted_lattice(plate, 0.005).mesh),
                 coarse = size_of(weighted_lattice(plate, 0.04).mesh);
  EXPECT_EQ(compare_levels(fine, coarse, 1).same, SameBody::yes)
      << compare_levels(fine, coarse, 1).sentence;
  EXPECT_NE(compare_levels(fine, size_of(lattice_mesh(plate, 0.04)), 1).same, SameBody::yes);
}

// Two prongs 4 mm apart, which hang together at one end
TEST(WeightedLattice, CountsCellsThatConnectWhatIsApart) {
  const TriangleSurface prongs =
      together(box_surface(Point(0, 0, 0), Point(0.1, 0.02, 0.01)),
               box_surface(Point(0, 0, 0.014), Point(0.1, 0.02, 0.024)), false);
  const TriangleSurface fork =
      together(prongs, box_surface(Point(-0.02, 0, 0), Point(0.001, 0.02, 0.024)), false);
  EXPECT_EQ(weighted_lattice(fork, 0.002).shared_cells, 0);
  EXPECT_GE(weighted_lattice(fork, 0.008).shared_cells, 20);
  EXPECT_NEAR(size_of(weighted_lattice(fork, 0.008).mesh).volume, 4.968e-5, 2e-7);
}

TEST(WeightedLattice, PartsGoAlongWithTetrahedra) {
  const TetMesh mesh = weighted_lattice(sphere_surface(Point::Zero(), 0.5, 2), 0.3).mesh;
  const double volume = size_of(mesh).volume;
  EXPECT_NEAR(size_of(refined(mesh)).volume, volume, 1e-12);
  EXPECT_NEAR(size_of(reordered(mesh, locality_order(mesh))).volume, volume, 1e-12);
}

}  // namespace
