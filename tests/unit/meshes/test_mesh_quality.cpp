// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/validated_mesh.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/reordering.hpp>

#include "mesh_input.hpp"

namespace {

using namespace plica;
using namespace plica::test;

TetMesh one_tet(const std::array<Point, 4>& corners) {
  TetMesh mesh;
  mesh.vertices.assign(corners.begin(), corners.end());
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

TetMesh joined(const TetMesh& a, const TetMesh& b) {
  TetMesh mesh = a;
  const int shift = static_cast<int>(a.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [i, j, k, l] : b.tets)
    mesh.tets.push_back({i + shift, j + shift, k + shift, l + shift});
  return mesh;
}

const TetMesh regular =
    one_tet({Point(1, 1, 1), Point(-1, 1, -1), Point(1, -1, -1), Point(-1, -1, 1)});
const TetMesh corner = one_tet({Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0), Point(0, 0, 1)});

TEST(MeshQuality, OfTheRegularTetrahedron) {
  const MeshQuality q = mesh_quality(regular);
  EXPECT_NEAR(q.volume, 8.0 / 3.0, 1e-14);
  EXPECT_NEAR(q.edges.min, std::sqrt(8.0), 1e-14);
  EXPECT_NEAR(q.edges.max, std::sqrt(8.0), 1e-14);
  EXPECT_NEAR(q.height_ratios.max, std::sqrt(1.5), 1e-14);
  EXPECT_NEAR(q.dihedral_angles.min, std::acos(1.0 / 3.0) * 180.0 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(q.dihedral_angles.max, q.dihedral_angles.min, 1e-12);
  EXPECT_NEAR(q.boundary_area, 8.0 * std::sqrt(3.0), 1e-13);
  EXPECT_EQ(q.boundary_triangles, 4);
  EXPECT_EQ(q.dihedral_angle_counts.counts[7], 6);  // 70.5 degrees
  EXPECT_EQ(q.height_ratio_counts.counts[0], 1);
}

TEST(MeshQuality, OfTheCornerOfACube) {
  const MeshQuality q = mesh_quality(corner);
  EXPECT_NEAR(q.height_ratios.max, std::sqrt(2.0) * std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(q.dihedral_angles.max, 90.0, 1e-12);
  EXPECT_NEAR(q.dihedral_angles.min, std::acos(1.0 / std::sqrt(3.0)) * 180.0 / std::numbers::pi,
              1e-12);
  EXPECT_NEAR(q.edges.mean, (3.0 + 3.0 * std::sqrt(2.0)) / 6.0, 1e-14);
}

TEST(MeshQuality, DoesNotDependOnSizeAndOrder) {
  const TetMesh mesh = ball_mesh({0, 0, 0}, 1.0, 4);
  TetMesh small = mesh;
  for (Point& p : small.vertices) p *= 1e-3;
  std::reverse(small.tets.begin(), small.tets.end());
  const MeshQuality a = mesh_quality(mesh), b = mesh_quality(small);
  EXPECT_NEAR(b.height_ratios.max, a.height_ratios.max, 1e-12);
  EXPECT_NEAR(b.dihedral_angles.min, a.dihedral_angles.min, 1e-10);
  EXPECT_NEAR(b.volume, 1e-9 * a.volume, 1e-21);
  EXPECT_EQ(b.parts, 1);
}

TEST(MeshQuality, CountsRegions) {
  TetMesh mesh = box_mesh({{0, 0, 0}, {1, 1, 1}}, {2, 2, 2});
  MeshQuality q = mesh_quality(mesh);
  ASSERT_EQ(q.regions.size(), 1u);
  EXPECT_EQ(q.regions[0].tets, 48);
  mesh.region_names = {"tissue", "tumour"};
  mesh.region.assign(48, 0);
  for (std::size_t t = 42; t < 48; ++t) mesh.region[t] = 1;
  q = mesh_quality(mesh);
  ASSERT_EQ(q.regions.size(), 2u);
  EXPECT_EQ(q.regions[1].name, "tumour");
  EXPECT_EQ(q.regions[1].tets, 6);
  EXPECT_NEAR(q.regions[0].volume, 7.0 / 8.0, 1e-14);
}

TEST(MeshQuality, FindsPartsAndDuplicates) {
  const Box left{{0, 0, 0}, {1, 1, 1}}, right{{1, 0, 0}, {2, 1, 1}}, apart{{3, 0, 0}, {4, 1, 1}};
  const TetMesh box = box_mesh(left, {2, 2, 2});
  EXPECT_EQ(mesh_quality(joined(box, box_mesh(right, {2, 2, 2}))).parts, 2);
  EXPECT_EQ(mesh_quality(joined(box, box_mesh(right, {2, 2, 2}))).duplicate_vertices, 9);
  EXPECT_EQ(mesh_quality(joined(box, box_mesh(apart, {2, 2, 2}))).duplicate_vertices, 0);
  EXPECT_EQ(mesh_quality(joined(box, box)).duplicate_vertices, 27);
  TetMesh nearly = joined(box, box);
  for (std::size_t v = 27; v < 54; ++v) nearly.vertices[v].x() += 1e-6;
  EXPECT_EQ(mesh_quality(nearly).duplicate_vertices, 0);
}

TEST(MeshQuality, NamesTheWorstFirst) {
  TetMesh mesh = box_mesh({{0, 0, 0}, {1, 1, 1}}, {3, 3, 3});
  mesh.vertices[0] = {0.3, 0.3, 0.3};  // nearly at the other end of its cell
  const MeshQuality q = mesh_quality(mesh);
  ASSERT_EQ(q.worst.size(), 10u);
  EXPECT_EQ(q.worst[0].height_ratio, q.height_ratios.max);
  for (std::size_t i = 1; i < 10; ++i)
    EXPECT_GE(q.worst[i - 1].height_ratio, q.worst[i].height_ratio);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_LT(q.worst[i].tet, 6);  // the six of the first cell
  EXPECT_LT(q.worst[6].height_ratio, 2.5);
  EXPECT_NEAR(tet_shape(mesh, q.worst[0].tet).smallest_angle, q.worst[0].smallest_angle, 1e-15);
  EXPECT_EQ(mesh_quality(regular).worst.size(), 1u);
}

TEST(MeshQuality, HistogramsHoldEverything) {
  const MeshQuality q = mesh_quality(ball_mesh({0, 0, 0}, 1.0, 6));
  const auto sum = [](const Histogram& h) {
    return std::accumulate(h.counts.begin(), h.counts.end(), 0);
  };
  EXPECT_EQ(sum(q.height_ratio_counts), q.tets);
  EXPECT_EQ(sum(q.dihedral_angle_counts), 6 * q.tets);
  Histogram h({0, 1, 2});
  for (const double value : {-1.0, 0.0, 1.0, 2.0, 3.0}) h.add(value);
  EXPECT_EQ(h.counts, (std::vector<int>{2, 3}));
}

TEST(EdgeLengths, OfACell) {
  const TetMesh mesh = box_mesh({{0, 0, 0}, {1, 1, 1}}, {1, 1, 1});
  const auto edges = mesh_edges(mesh);
  EXPECT_EQ(edges.size(), 12u + 6u + 1u);
  EXPECT_TRUE(std::is_sorted(edges.begin(), edges.end()));
  const double root2 = std::sqrt(2.0), root3 = std::sqrt(3.0);
  const auto local = local_edge_lengths(mesh);
  EXPECT_NEAR(local[0], (3.0 + 3.0 * root2 + root3) / 7.0, 1e-15);  // the diagonal starts here
  EXPECT_NEAR(local[1], (3.0 + root2) / 4.0, 1e-15);
  EXPECT_NEAR(mean_edge_length(mesh), (12.0 + 6.0 * root2 + root3) / 19.0, 1e-15);
  EXPECT_NEAR(mean_edge_length(corner, 0), (1.0 + root2) / 2.0, 1e-15);
}

TEST(BoundaryTriangles, LookOutwards) {
  EXPECT_EQ(boundary_triangles(corner).size(), 4u);
  const TetMesh mesh = joined(corner, box_mesh({{2, 0, 0}, {3, 1, 1}}, {2, 3, 1}));
  const BoundarySurface boundary = boundary_surface(mesh);
  EXPECT_NEAR(enclosed_volume(boundary.surface), 1.0 / 6.0 + 1.0, 1e-14);
  EXPECT_NEAR(surface_area(boundary.surface), 1.5 + std::sqrt(3.0) / 2.0 + 6.0, 1e-14);
  EXPECT_EQ(boundary.surface.triangles.size(), 4u + 2u * 2u * (2 * 3 + 3 * 1 + 1 * 2));
  EXPECT_TRUE(std::is_sorted(boundary.mesh_vertex.begin(), boundary.mesh_vertex.end()));
  for (std::size_t v = 0; v < boundary.mesh_vertex.size(); ++v)
    EXPECT_EQ(boundary.surface.vertices[v],
              mesh.vertices[static_cast<std::size_t>(boundary.mesh_vertex[v])]);
}

TEST(BoundaryTriangles, LeaveOutInnerVertices) {
  const TetMesh mesh = box_mesh({{0, 0, 0}, {1, 1, 1}}, {3, 3, 3});
  EXPECT_EQ(boundary_surface(mesh).surface.vertices.size(), 64u - 8u);
}

TetMesh beam() {
  return read_mesh(std::filesystem::path(PLICA_SOURCE_DIR) / "meshes" / "data" / "beam.msh");
}

// Whichever library sorts them
TEST(OverlapAtAFace, NamesTheFirstOfACrowd) {
  TetMesh mesh;
  constexpr int tets = 20;
  mesh.vertices.assign(3 + tets, Point::Zero());
  EXPECT_TRUE(overlap_at_a_face(mesh).empty());
  for (int k = 0; k < tets; ++k) mesh.tets.push_back({0, 1, 2, 3 + k});
  EXPECT_EQ(overlap_at_a_face(mesh), (std::vector<std::size_t>{0, 1, 2}));
}

// A vertex inside a box is moved through its top, and the tetrahedra that this turned inside out
// are turned back.
TEST(OverlapAtAFace, NamesTwoOnOneSide) {
  TetMesh mesh = box_mesh({{0, 0, 0}, {1, 1, 1}}, {4, 4, 4});
  EXPECT_TRUE(overlap_at_a_face(mesh).empty());
  const auto middle = std::ranges::find_if(
      mesh.vertices, [](const Point& x) { return (x - Point(.5, .5, .5)).norm() < 1e-9; });
  (*middle)[2] = 1.2;
  int turned = 0;
  for (auto& t : mesh.tets) {
    const auto x = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    if ((x(1) - x(0)).cross(x(2) - x(0)).dot(x(3) - x(0)) < 0) std::swap(t[2], t[3]), ++turned;
  }
  EXPECT_GT(turned, 0);
  const auto found = overlap_at_a_face(mesh);
  ASSERT_EQ(found.size(), 2u);
  std::set<int> vertices;
  for (const std::size_t e : found) vertices.insert(mesh.tets[e].begin(), mesh.tets[e].end());
  EXPECT_EQ(vertices.size(), 5u);
}

TEST(Reordering, KeepsTheMesh) {
  const TetMesh before = beam();
  const Reordering order = locality_order(before);
  const TetMesh after = reordered(before, order);
  ASSERT_EQ(after.vertices.size(), before.vertices.size());
  ASSERT_EQ(after.tets.size(), before.tets.size());
  std::vector<int> sorted = order.tets;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(std::unique(sorted.begin(), sorted.end()), sorted.end());
  for (std::size_t t = 0; t < after.tets.size(); ++t) {
    const auto old = static_cast<std::size_t>(order.tets[t]);
    EXPECT_EQ(after.region[t], before.region[old]);
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_EQ(order.vertices[static_cast<std::size_t>(after.tets[t][k])], before.tets[old][k]);
  }
  EXPECT_EQ(after.vertices, permuted(before.vertices, order.vertices));
  std::vector<int> base;
  for (const int v : after.vertex_sets.at("base"))
    base.push_back(order.vertices[static_cast<std::size_t>(v)]);
  std::sort(base.begin(), base.end());
  EXPECT_EQ(base, before.vertex_sets.at("base"));
  EXPECT_TRUE(
      std::is_sorted(after.vertex_sets.at("base").begin(), after.vertex_sets.at("base").end()));
}

TEST(Reordering, BringsNeighboursTogether) {
  const TetMesh before = beam();
  const TetMesh after = reordered(before, locality_order(before));
  EXPECT_LT(mean_vertex_span(after), 0.4 * mean_vertex_span(before));
  // and again the same, as its tetrahedra are where they were
  EXPECT_EQ(locality_order(after).tets.front(), 0);
}

// A torn mesh: two boxes whose common vertices are there twice
TetMesh torn() {
  TetMesh mesh = box_mesh({Point(0, 0, 0), Point(1, 1, 1)}, {2, 2, 2});
  const TetMesh other = box_mesh({Point(1, 0, 0), Point(2, 1, 1)}, {2, 2, 2});
  const int first = static_cast<int>(mesh.vertices.size());
  for (const Point& p : other.vertices) mesh.vertices.push_back(p + Point(1e-9, 0, 0));
  for (auto tet : other.tets) {
    for (int& v : tet) v += first;
    mesh.tets.push_back(tet);
  }
  mesh.vertex_sets["all"].resize(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    mesh.vertex_sets["all"][v] = static_cast<int>(v);
  return mesh;
}

TEST(MergeDuplicates, GluesATornMesh) {
  const TetMesh mesh = torn();
  EXPECT_EQ(count_parts(mesh), 2);
  const MergedMesh glued = merge_duplicates(mesh, 1e-6);
  EXPECT_EQ(glued.merged, 9);
  EXPECT_EQ(glued.mesh.vertices.size(), mesh.vertices.size() - 9);
  EXPECT_EQ(glued.mesh.vertex_sets.at("all").size(), glued.mesh.vertices.size());
  EXPECT_EQ(count_parts(glued.mesh), 1);
  EXPECT_NEAR(mesh_quality(glued.mesh).volume, 2.0, 1e-8);
  for (std::size_t v = 0; v < glued.original_vertex.size(); ++v)
    EXPECT_EQ(glued.mesh.vertices[v],
              mesh.vertices[static_cast<std::size_t>(glued.original_vertex[v])]);
  EXPECT_EQ(merge_duplicates(mesh, 0.0).merged, 0);  // none is at exactly the same place
}

TEST(MergeDuplicates, RefusesWhatItWouldBreak) {
  const TetMesh mesh = torn();
  EXPECT_THROW(merge_duplicates(mesh, -1.0), InputError);
  EXPECT_THROW(merge_duplicates(mesh, std::numeric_limits<double>::quiet_NaN()), InputError);
  expect_refused([&] { merge_duplicates(mesh, 0.6); },
                 "vertices at most 0.6 m apart cannot be merged",
                 {"tetrahedron 0 names a node twice"});
  TetMesh twice = box_mesh({Point(0, 0, 0), Point(1, 1, 1)}, {1, 1, 1});
  const std::size_t tets = twice.tets.size();
  const int first = static_cast<int>(twice.vertices.size());
  for (std::size_t v = 0; v < static_cast<std::size_t>(first); ++v)
    twice.vertices.push_back(Point(twice.vertices[v]));
  for (std::size_t t = 0; t < tets; ++t) {
    auto tet = twice.tets[t];
    for (int& v : tet) v += first;
    twice.tets.push_back(tet);
  }
  EXPECT_THROW(merge_duplicates(twice, 0.0), InputError);
}

}  // namespace
