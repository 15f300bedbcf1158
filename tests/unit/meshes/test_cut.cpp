// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/cut.hpp>
#include <plica/meshes/generators.hpp>
#include <set>

// Cuts along faces: which faces a blade opens, and what the mesh is after that.
namespace {

using namespace plica;

const Box unit{{0, 0, 0}, {1, 1, 1}};

/// The part z > bottom of the plane x = 0.5, a little larger than the unit box.
Blade plane(double bottom) {
  const Point a(0.5, -0.1, bottom), b(0.5, 1.1, bottom), c(0.5, 1.1, 1.1), d(0.5, -0.1, 1.1);
  return {{a, b, c}, {a, c, d}};
}
constexpr double below_the_box = -0.1, at_60_percent = 0.4;

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.tets) {
    const auto x = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    sum += tet_volume(x(0), x(1), x(2), x(3));
  }
  return sum;
}

CutMesh cut_by(const TetMesh& mesh, const Blade& blade) {
  return open_faces(mesh, faces_across(mesh.tets, mesh.vertices, blade));
}

/// Every tetrahedron has the places that it had, and new vertices are where the old ones are.
void expect_same_shapes(const CutMesh& cut, const TetMesh& before) {
  ASSERT_EQ(cut.mesh.tets.size(), before.tets.size());
  for (std::size_t e = 0; e < before.tets.size(); ++e)
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_EQ(cut.mesh.vertices[static_cast<std::size_t>(cut.mesh.tets[e][k])],
                before.vertices[static_cast<std::size_t>(before.tets[e][k])]);
  ASSERT_EQ(cut.mesh.vertices.size(), before.vertices.size() + cut.twin.size());
  for (std::size_t i = 0; i < cut.twin.size(); ++i)
    EXPECT_EQ(cut.mesh.vertices[before.vertices.size() + i],
              before.vertices[static_cast<std::size_t>(cut.twin[i])]);
  std::set<int> used;
  for (const auto& t : cut.mesh.tets) used.insert(t.begin(), t.end());
  EXPECT_EQ(used.size(), cut.mesh.vertices.size()) << "every vertex is used";
}

// The plane is one of the mesh's: 4 x 4 squares of two triangles, and 5 x 5 vertices
TEST(Cut, AlongAPlaneOfTheMeshOpensThatPlane) {
  const TetMesh mesh = box_mesh(unit, {4, 4, 4});
  EXPECT_EQ(count_pieces(mesh), 1);
  const Faces faces = faces_across(mesh.tets, mesh.vertices, plane(below_the_box));
  EXPECT_EQ(faces.size(), 32u);
  const CutMesh cut = open_faces(mesh, faces);
  EXPECT_EQ(cut.twin.size(), 25u);
  EXPECT_EQ(count_pieces(cut.mesh), 2);
  expect_same_shapes(cut, mesh);
  for (const int v : cut.twin)
    EXPECT_EQ(mesh.vertices[static_cast<std::size_t>(v)][0], 0.5) << "of the plane alone";
  EXPECT_NEAR(volume(cut.mesh), 1, 1e-14);
  EXPECT_NEAR(surface_area(boundary_surface(cut.mesh).surface), 6 + 2, 1e-13);
}

// Counts of a second implementation, in numpy
TEST(Cut, BetweenThePlanesOfTheMeshIsJagged) {
  const TetMesh mesh = box_mesh(unit, {5, 4, 4});
  const CutMesh all = cut_by(mesh, plane(below_the_box)), part = cut_by(mesh, plane(at_60_percent));
  EXPECT_EQ(all.twin.size(), 40u);
  EXPECT_EQ(count_pieces(all.mesh), 2);
  EXPECT_EQ(faces_across(mesh.tets, mesh.vertices, plane(at_60_percent)).size(), 37u);
  EXPECT_EQ(part.twin.size(), 22u);
  EXPECT_EQ(count_pieces(part.mesh), 1);
  expect_same_shapes(all, mesh), expect_same_shapes(part, mesh);
}

// The cut ends in edges whose vertices stay single, within a cell of the blade's own edge
TEST(Cut, StaysClosedAtItsFront) {
  const TetMesh mesh = box_mesh(unit, {4, 4, 4});
  const CutMesh cut = cut_by(mesh, plane(at_60_percent));
  for (const int v : cut.twin) EXPECT_GT(mesh.vertices[static_cast<std::size_t>(v)][2], 0.25);
  std::set<int> split(cut.twin.begin(), cut.twin.end());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    EXPECT_TRUE(split.contains(static_cast<int>(v)) || mesh.vertices[v][0] != 0.5 ||
                mesh.vertices[v][2] <= 0.5);
}

TEST(Cut, ThatMissesOpensNothing) {
  const TetMesh mesh = box_mesh(unit, {4, 4, 4});
  Blade beside = plane(below_the_box);
  for (auto& triangle : beside)
    for (Point& p : triangle) p[0] += 3;
  const Point a(0.5, -1, 0.5), b(0.5, 2, 0.5);
  for (const Blade& blade :
       {Blade{}, beside, plane(1.05), Blade{{a, b, b}}, Blade{{a, 0.5 * (a + b), b}}})
    EXPECT_TRUE(faces_across(mesh.tets, mesh.vertices, blade).empty());
  const CutMesh same = open_faces(mesh, {});
  EXPECT_TRUE(same.twin.empty());
  EXPECT_EQ(same.mesh.tets, mesh.tets);
}

// Also where centroids lie on the blade, as they do here at x = 0.5
TEST(Cut, DoesNotDependOnTheOrderOfCorners) {
  const TetMesh mesh = box_mesh(unit, {3, 3, 3});
  const Faces faces = faces_across(mesh.tets, mesh.vertices, plane(below_the_box));
  EXPECT_EQ(faces.size(), 30u);
  Blade turned = plane(below_the_box);
  std::swap(turned[0][1], turned[0][2]);
  std::reverse(turned.begin(), turned.end());
  EXPECT_EQ(faces_across(mesh.tets, mesh.vertices, turned), faces);
}

// A blade moves with the body: where that is now
TEST(Cut, IsWhereTheVerticesAreNow) {
  const TetMesh mesh = box_mesh(unit, {4, 4, 4});
  std::vector<Point> moved = mesh.vertices;
  for (Point& p : moved) p += Point(0.25, 0, 0);
  const Faces faces = faces_across(mesh.tets, moved, plane(below_the_box));
  EXPECT_EQ(faces.size(), 32u);
  for (const int v : open_faces(mesh, faces).twin)
    EXPECT_EQ(mesh.vertices[static_cast<std::size_t>(v)][0], 0.25);
}

// Faces that opened before are open still: vertices between two cuts split, too
TEST(Cut, GoesOnFromEarlierOnes) {
  const TetMesh mesh = box_mesh(unit, {5, 4, 4});
  const CutMesh at_once = cut_by(mesh, plane(below_the_box));
  Faces open;
  TetMesh now = mesh;
  std::size_t twins = 0;
  for (const double bottom : {0.9, 0.7, 0.62, 0.4, 0.1, -0.1}) {
    const Faces more = faces_across(now.tets, now.vertices, plane(bottom));
    Faces all;
    std::ranges::set_union(open, more, std::back_inserter(all));
    open = all;
    const CutMesh cut = open_faces(now, open);
    now = cut.mesh, twins += cut.twin.size();
  }
  EXPECT_EQ(open, faces_across(mesh.tets, mesh.vertices, plane(below_the_box)));
  EXPECT_EQ(twins, at_once.twin.size());
  EXPECT_EQ(count_pieces(now), 2);
  const auto area = [](const TetMesh& m) { return surface_area(boundary_surface(m).surface); };
  EXPECT_NEAR(area(now), area(at_once.mesh), 1e-12);
}

// Named vertices of both halves, and named triangles of all their area
TEST(Cut, IsFollowedByNamedSets) {
  TetMesh mesh = box_mesh(unit, {4, 4, 4});
  for (const auto& t : boundary_triangles(mesh))
    if (std::ranges::all_of(
            t, [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)][2] == 1; }))
      mesh.triangle_sets["top"].push_back(t);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (mesh.vertices[v][2] == 1) mesh.vertex_sets["top"].push_back(static_cast<int>(v));
  const TetMesh cut = cut_by(mesh, plane(below_the_box)).mesh;
  const std::vector<int>& top = cut.vertex_sets.at("top");
  EXPECT_EQ(top.size(), 25u + 5u);
  EXPECT_TRUE(std::ranges::is_sorted(top));
  const auto& triangles = cut.triangle_sets.at("top");
  EXPECT_EQ(triangles.size(), 32u);
  EXPECT_NEAR(surface_area({cut.vertices, triangles}), 1, 1e-14);
  std::set<std::array<int, 3>> boundary;
  const auto ascending = [](std::array<int, 3> t) {
    std::ranges::sort(t);
    return t;
  };
  for (const auto& t : boundary_triangles(cut)) boundary.insert(ascending(t));
  for (const auto& t : triangles) {
    EXPECT_TRUE(boundary.contains(ascending(t)));
    for (const int v : t) EXPECT_TRUE(std::ranges::binary_search(top, v));
  }
}

TEST(Cut, IsFollowedByTheSurface) {
  const TetMesh mesh = box_mesh(unit, {5, 4, 4});
  TriangleSurface surface = boundary_surface(mesh).surface;
  const TriangleSurface before = surface;
  std::vector<int> vertex = boundary_vertices_of(surface, mesh);
  ASSERT_EQ(vertex.size(), surface.vertices.size());
  for (const double bottom : {at_60_percent, below_the_box}) {
    const TetMesh cut = cut_by(mesh, plane(bottom)).mesh;
    TriangleSurface now = before;
    std::vector<int> at = vertex;
    follow_cut(cut, now, at);
    for (std::size_t p = 0; p < now.vertices.size(); ++p)
      EXPECT_EQ(now.vertices[p], cut.vertices[static_cast<std::size_t>(at[p])]);
    for (std::size_t p = 0; p < before.vertices.size(); ++p)
      EXPECT_EQ(now.vertices[p], before.vertices[p]) << "points keep their numbers";
    SurfaceReport report;
    count_edges(now, report);
    EXPECT_EQ(report.open_edges, 0);
    EXPECT_NEAR(enclosed_volume(now), 1, 1e-13);
    EXPECT_GT(surface_area(now), surface_area(before) + (bottom < 0 ? 2 : 1));
    const Embedding embedding = embed_at_vertices(cut, at);
    for (std::size_t p = 0; p < at.size(); ++p)
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_EQ(embedding.weights[p][k], embedding.vertices[p][k] == at[p] ? 1 : 0);
  }
  EXPECT_TRUE(boundary_vertices_of(sphere_surface({0.5, 0.5, 0.5}, 0.4, 1), mesh).empty());
}

}  // namespace
