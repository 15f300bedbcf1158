// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdlib>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/lattice.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/repair_mesh.hpp>

#include "mesh_input.hpp"

namespace {

using namespace plica;
using namespace plica::test;

TetMesh cube(int cells, double size = 1) {
  return box_mesh({Point::Zero(), Point::Constant(size)}, {cells, cells, cells});
}

// The inner vertex nearest to a point
std::size_t nearest(const TetMesh& mesh, const Point& p) {
  std::size_t best = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if ((mesh.vertices[v] - p).norm() < (mesh.vertices[best] - p).norm()) best = v;
  return best;
}

double volume_of(const TetMesh& mesh) { return mesh_quality(mesh).volume; }

TEST(RepairMesh, ASoundMeshStaysAsItIs) {
  const TetMesh mesh = cube(3);
  const MeshRepair repair = repair_mesh(mesh);
  EXPECT_FALSE(repair.changed());
  expect_same(repair.mesh, mesh);
  EXPECT_EQ(repair.worst_before, repair.worst_after);
}

TEST(RepairMesh, SliversAreShapedBetter) {
  TetMesh mesh = cube(4);
  const std::size_t v = nearest(mesh, Point::Constant(0.5));
  mesh.vertices[v] += Point(0.2495, 0, 0);  // nearly into its neighbour
  const MeshRepair repair = repair_mesh(mesh);
  EXPECT_GT(repair.worst_before, 100);
  EXPECT_LT(repair.worst_after, 8);
  EXPECT_GT(repair.moved, 0);
  EXPECT_NEAR(volume_of(repair.mesh), 1, 1e-12);
  EXPECT_NEAR(mesh_quality(repair.mesh).boundary_area, 6, 1e-12) << "the boundary stays";
}

// Two inner vertices close to each other, held by the set of one of them
TEST(RepairMesh, EdgesThatMovesCannotHelpAreCollapsed) {
  TetMesh mesh = cube(4);
  const auto a = nearest(mesh, Point::Constant(0.5)), b = nearest(mesh, Point(0.75, 0.5, 0.5));
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (v != a) mesh.vertex_sets["held"].push_back(static_cast<int>(v));
  mesh.vertices[b] = mesh.vertices[a] + Point(1e-4, 0, 0);
  const double before = volume_of(mesh);
  const MeshRepair repair = repair_mesh(mesh);
  EXPECT_LE(repair.worst_after, repair.worst_before);
  EXPECT_LT(repair.worst_after, 50);
  EXPECT_NEAR(volume_of(repair.mesh), before, 1e-12);
  EXPECT_EQ(repair.vertex[a] == repair.vertex[b], repair.collapsed > 0);
}

// A flat tetrahedron on a square of the boundary, whose other diagonal it brings
TEST(RepairMesh, SliversOnTheBoundaryArePeeledOff) {
  TetMesh mesh = cube(1);
  std::vector<int> top;
  for (int v = 0; v < 8; ++v)
    if (mesh.vertices[static_cast<std::size_t>(v)].z() > 0.5) top.push_back(v);
  const auto edges = mesh_edges(mesh);
  const auto is_edge = [&](int a, int b) {
    return std::ranges::find(edges, std::array<int, 2>{a, b}) != edges.end();
  };
  // the diagonals of the square
  const std::array<int, 2> a = {top[0], top[3]}, b = {top[1], top[2]};
  const auto& raised = is_edge(a[0], a[1]) ? b : a;
  for (const int v : raised) mesh.vertices[static_cast<std::size_t>(v)].z() += 0.001;
  std::array<int, 4> sliver = {top[0], top[1], top[2], top[3]};
  if (!(height_ratio(mesh, sliver) < 1e9)) std::swap(sliver[2], sliver[3]);
  ASSERT_LT(height_ratio(mesh, sliver), 1e9);
  mesh.tets.push_back(sliver);
  const MeshRepair repair = repair_mesh(mesh);
  EXPECT_EQ(repair.peeled, 1);
  EXPECT_GT(repair.worst_before, 500);
  EXPECT_LT(repair.worst_after, 8);
  EXPECT_EQ(repair.mesh.tets.size(), 6u);
  EXPECT_EQ(repair.mesh.vertices.size(), 8u);
}

TEST(RepairMesh, DuplicatesAreMergedAndLoosePartsDropped) {
  const TetMesh one = cube(2), crumb = cube(1, 0.1);
  TetMesh mesh;
  mesh.region_names = {"tissue", "tumour"};
  const auto add = [&](const TetMesh& part, const Point& at, int region) {
    const int base = static_cast<int>(mesh.vertices.size());
    for (const Point& p : part.vertices) mesh.vertices.push_back(p + at);
    for (auto tet : part.tets) {
      for (int& v : tet) v += base;
      mesh.tets.push_back(tet), mesh.region.push_back(region);
      mesh.filled.push_back(1 / static_cast<double>(mesh.tets.size()));
      mesh.tet_vectors["fibres"].push_back(Point(1, static_cast<double>(mesh.tets.size()), 0));
    }
  };
  add(one, Point::Zero(), 0), add(crumb, Point(5, 0, 0), 0), add(one, Point(1, 0, 0), 1);
  mesh.vertex_sets["end"] = {static_cast<int>(mesh.vertices.size()) - 1};
  const MeshRepair repair = repair_mesh(mesh);
  EXPECT_EQ(repair.merged, 9);
  EXPECT_EQ(repair.parts, 1);
  EXPECT_EQ(repair.loose_tets, 6);
  EXPECT_EQ(count_parts(repair.mesh), 1);
  EXPECT_NEAR(volume_of(repair.mesh), 2, 1e-12);
  EXPECT_EQ(repair.mesh.vertices.size(), 45u);
  EXPECT_EQ(repair.mesh.vertices[static_cast<std::size_t>(repair.mesh.vertex_sets.at("end")[0])],
            Point(2, 1, 1));
  ASSERT_EQ(repair.mesh.filled.size(), repair.mesh.tets.size());
  ASSERT_EQ(repair.mesh.tet_vectors.at("fibres").size(), repair.mesh.tets.size());
  for (std::size_t t = 0; t < repair.mesh.tets.size(); ++t) {
    const auto from = static_cast<std::size_t>(repair.original_tet[t]);
    EXPECT_EQ(repair.mesh.region[t], mesh.region[from]);
    EXPECT_EQ(repair.mesh.filled[t], mesh.filled[from]);
    EXPECT_EQ(repair.mesh.tet_vectors.at("fibres")[t], mesh.tet_vectors.at("fibres")[from]);
  }
  for (std::size_t v = 0; v < repair.mesh.vertices.size(); ++v)
    EXPECT_EQ(repair.vertex[static_cast<std::size_t>(repair.original_vertex[v])],
              static_cast<int>(v));
}

TEST(RepairMesh, FlawsThatReadersRefuseAreRepaired) {
  const std::string text =
      "MeshVersionFormatted 2\nDimension 3\nVertices 6\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 1 1 "
      "0\n0.5 0.5 0 0\n"
      "Tetrahedra 5\n1 2 3 4 1\n2 3 4 5 1\n2 3 4 5 1\n1 2 3 6 1\n1 1 2 3 1\nEnd\n";
  const FileBytes file{"m.mesh", text};
  EXPECT_THROW(read_mesh(file), InputError);
  MeshReport report;
  const MeshRepair repair = repair_mesh(read_mesh(file, &report, {.flaws = Flaws::kept}));
  EXPECT_EQ(report.repeated, 1);
  EXPECT_EQ(report.collapsed, 1);
  EXPECT_EQ(repair.flat, 1);
  EXPECT_TRUE(std::isinf(repair.worst_before));
  EXPECT_EQ(repair.mesh.tets.size(), 2u);
  EXPECT_EQ(repair.mesh.vertices.size(), 5u);
}

TEST(RepairMesh, TheWorstNeverBecomesWorse) {
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    std::srand(seed);
    TetMesh mesh = cube(5);
    for (Point& p : mesh.vertices)
      if ((p.array() > 0.01).all() && (p.array() < 0.99).all()) p += 0.08 * Point::Random();
    bool sound = true;
    for (const auto& tet : mesh.tets) sound = sound && std::isfinite(height_ratio(mesh, tet));
    if (!sound) continue;
    const MeshRepair repair = repair_mesh(mesh);
    EXPECT_LE(repair.worst_after, repair.worst_before);
    EXPECT_NEAR(volume_of(repair.mesh), 1, 1e-12);
  }
}

TEST(Lattice, OfABoxIsTheBox) {
  const TriangleSurface box = boundary_surface(cube(2, 0.02)).surface;
  const TetMesh lattice = lattice_mesh(box, 0.005);
  EXPECT_EQ(lattice.tets.size(), 4u * 4 * 4 * 6);
  EXPECT_NEAR(volume_of(lattice), 8e-6, 1e-15);
}

// Every cell that the ball reaches into, and no other
TEST(Lattice, CoversABallAndNoMore) {
  const TriangleSurface ball = sphere_surface(Point(1, 2, 3), 0.5, 4);
  for (const double size : {0.4, 0.2, 0.1}) {
    const TetMesh lattice = lattice_mesh(ball, size);
    const TetLocator locator(lattice);
    for (const Point& p : ball.vertices) EXPECT_LT(locator.locate(p).distance, 1e-12);
    EXPECT_EQ(locator.locate(Point(1, 2, 3)).distance, 0.0);
    EXPECT_EQ(count_parts(lattice), 1);
    for (std::size_t t = 0; t < lattice.tets.size(); t += 6) {
      const auto corners = corners_of(lattice, static_cast<int>(t));
      const Box cell = bounding_box({corners.begin(), corners.end()});
      const Point nearest = Point(1, 2, 3).cwiseMax(cell.min).cwiseMin(cell.max);
      EXPECT_LT((nearest - Point(1, 2, 3)).norm(), 0.5);
    }
  }
  EXPECT_THROW(lattice_mesh(ball, 1.1), InputError);
  EXPECT_THROW(lattice_mesh(ball, 1e-4), InputError);
  EXPECT_THROW(lattice_mesh(ball, 0), InputError);
}

TEST(Lattice, RefusesVerticesThatAreNotFinite) {
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    TriangleSurface surface = sphere_surface({0, 0, 0}, 1, 1);
    surface.vertices[3][1] = bad;
    EXPECT_THROW(lattice_mesh(surface, 0.3), InputError);
    EXPECT_THROW(weighted_lattice(surface, 0.3), InputError);
  }
}

TEST(Lattice, CoarserThanAMeshWithItsRegions) {
  TetMesh mesh = box_mesh({Point::Zero(), Point(0.4, 0.1, 0.1)}, {24, 6, 6});
  mesh.region_names = {"left", "right"};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    mesh.region.push_back(corners_of(mesh, static_cast<int>(t))[0].x() < 0.2 ? 0 : 1);
  for (const int vertices : {30, 100, 400}) {
    const TetMesh coarse = coarse_lattice(mesh, vertices);
    EXPECT_LE(static_cast<int>(coarse.vertices.size()), vertices);
    EXPECT_GE(static_cast<int>(coarse.vertices.size()), vertices / 2);
    const MeshQuality quality = mesh_quality(coarse);
    ASSERT_EQ(quality.regions.size(), 2u);
    EXPECT_NEAR(quality.regions[0].volume / quality.volume, 0.5, 0.2);
    EXPECT_GE(quality.volume, 0.4 * 0.1 * 0.1 * (1 - 1e-9));
  }
  EXPECT_THROW(coarse_lattice(mesh, 29), InputError);
  EXPECT_THROW(coarse_lattice(mesh, 10000), InputError);
}

}  // namespace
