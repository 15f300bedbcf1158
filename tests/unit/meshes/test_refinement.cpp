// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>
#include <plica/core/error.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/jitter.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/organs.hpp>
#include <plica/meshes/refinement.hpp>
#include <set>

// Meshes made of other meshes, and the bodies that are no boxes.
namespace {

using namespace plica;

const Box brick{{0, 0, 0}, {0.4, 0.1, 0.15}};

Tube bent() { return {{0.01, 0.02, 0.03}, 6e-3, 2e-3, 60e-3, std::numbers::pi / 2, 12, 2, 10}; }

TetMesh beam_with_a_tumour() {
  return read_mesh(std::filesystem::path(PLICA_SOURCE_DIR) / "meshes" / "data" / "beam.msh");
}

// A mesh in one piece without hanging nodes: its boundary encloses its volume and is closed
MeshQuality expect_sound(const TetMesh& mesh) {
  const MeshQuality quality = mesh_quality(mesh);
  for (int t = 0; t < quality.tets; ++t) EXPECT_GT(tet_shape(mesh, t).volume, 0.0);
  EXPECT_EQ(quality.parts, 1);
  EXPECT_EQ(quality.duplicate_vertices, 0);
  const TriangleSurface boundary = boundary_surface(mesh).surface;
  EXPECT_NEAR(enclosed_volume(boundary) / quality.volume, 1.0, 1e-12);
  std::set<std::array<int, 2>> directed;
  for (const auto& [a, b, c] : boundary.triangles) directed.insert({{a, b}, {b, c}, {c, a}});
  EXPECT_EQ(directed.size(), 3 * boundary.triangles.size());
  for (const auto& [a, b] : directed) EXPECT_TRUE(directed.contains({b, a}));
  return quality;
}

// Corners by place, as sets: to compare meshes that are numbered differently
std::set<std::set<std::array<long, 3>>> tets_by_place(const TetMesh& mesh) {
  std::set<std::set<std::array<long, 3>>> all;
  for (const auto& tet : mesh.tets) {
    std::set<std::array<long, 3>> one;
    for (const int v : tet) {
      const Point& p = mesh.vertices[static_cast<std::size_t>(v)];
      one.insert({std::lround(1e9 * p.x()), std::lround(1e9 * p.y()), std::lround(1e9 * p.z())});
    }
    all.insert(one);
  }
  return all;
}

TEST(Refinement, OfABoxIsTheBoxOfTwiceTheCells) {
  EXPECT_EQ(tets_by_place(refined(box_mesh(brick, {4, 2, 3}))),
            tets_by_place(box_mesh(brick, {8, 4, 6})));
}

TEST(Refinement, CutsEachIntoEightOfTheSameVolume) {
  for (const TetMesh& mesh :
       {jittered(box_mesh(brick, {4, 2, 2}), 0.2), ball_mesh({0, 0, 0}, 1, 4), tube_mesh(bent()),
        blob_mesh({0, 0, 0}, 0.12, 4), beam_with_a_tumour()}) {
    const TetMesh fine = refined(mesh);
    const MeshQuality before = expect_sound(mesh), after = expect_sound(fine);
    ASSERT_EQ(fine.tets.size(), 8 * mesh.tets.size());
    EXPECT_EQ(after.boundary_triangles, 4 * before.boundary_triangles);
    EXPECT_EQ(fine.vertices.size(), mesh.vertices.size() + mesh_edges(mesh).size());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      EXPECT_EQ(fine.vertices[v], mesh.vertices[v]);
    for (int t = 0; t < after.tets; ++t)
      EXPECT_NEAR(8 * tet_shape(fine, t).volume / tet_shape(mesh, t / 8).volume, 1, 1e-9);
    ASSERT_EQ(after.regions.size(), before.regions.size());
    for (std::size_t r = 0; r < before.regions.size(); ++r)
      EXPECT_NEAR(after.regions[r].volume / before.regions[r].volume, 1, 1e-12);
    EXPECT_TRUE(is_refinement_of(fine, mesh));
    EXPECT_LT(mesh_quality(refined(fine)).height_ratios.max, 2 * before.height_ratios.max)
        << "does not degenerate";
  }
}

TEST(Refinement, PartsHaveAllThatTheirTetrahedronHas) {
  TetMesh mesh = box_mesh(brick, {2, 1, 1});
  mesh.region_names = {"even", "odd"};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    mesh.region.push_back(static_cast<int>(t % 2));
    mesh.filled.push_back(1.0 / static_cast<double>(t + 1));
    mesh.tet_vectors["fibres"].push_back(Point(1, static_cast<double>(t), 0));
    mesh.tet_vectors["sheets"].push_back(Point(0, 0, static_cast<double>(t)));
  }
  const TetMesh fine = refined(mesh);
  ASSERT_EQ(fine.region.size(), fine.tets.size());
  ASSERT_EQ(fine.filled.size(), fine.tets.size());
  for (const char* name : {"fibres", "sheets"})
    ASSERT_EQ(fine.tet_vectors.at(name).size(), fine.tets.size()) << name;
  for (std::size_t t = 0; t < fine.tets.size(); ++t) {
    EXPECT_EQ(fine.region[t], mesh.region[t / 8]);
    EXPECT_EQ(fine.filled[t], mesh.filled[t / 8]);
    for (const char* name : {"fibres", "sheets"})
      EXPECT_EQ(fine.tet_vectors.at(name)[t], mesh.tet_vectors.at(name)[t / 8]) << name;
  }
}

TEST(Refinement, SetsOfTheBoundaryStayThere) {
  TetMesh mesh = box_mesh({{0, 0, 0}, {1, 1, 1}}, {1, 1, 1});
  // all on the boundary; the cell's diagonal is not
  mesh.vertex_sets["all"] = {0, 1, 2, 3, 4, 5, 6, 7};
  mesh.vertex_sets["bottom"] = {0, 1, 2, 3};
  const TetMesh fine = refined(mesh);
  EXPECT_EQ(fine.vertices.size(), 27u);
  EXPECT_EQ(fine.vertex_sets.at("all").size(), 26u);
  ASSERT_EQ(fine.vertex_sets.at("bottom").size(), 9u);
  for (const int v : fine.vertex_sets.at("bottom"))
    EXPECT_EQ(fine.vertices[static_cast<std::size_t>(v)].z(), 0);
  for (const auto& [name, set] : fine.vertex_sets) EXPECT_TRUE(std::ranges::is_sorted(set)) << name;
}

TEST(Refinement, SetsOfTheInsideKeepTheirEdges) {
  TetMesh mesh = box_mesh({{0, 0, 0}, {2, 2, 2}}, {2, 2, 2});
  mesh.vertex_sets["diagonal"] = {0, 13, 26};  // 13 is the middle of the body
  EXPECT_EQ(refined(mesh).vertex_sets.at("diagonal").size(), 5u);
}

TEST(Refinement, IsTold) {
  const TetMesh coarse = box_mesh(brick, {4, 2, 2}), fine = box_mesh(brick, {8, 4, 4});
  EXPECT_TRUE(is_refinement_of(fine, coarse));
  EXPECT_FALSE(is_refinement_of(box_mesh(brick, {9, 4, 4}), coarse));
  EXPECT_FALSE(is_refinement_of(jittered(fine, 0.2), coarse));
  Tube tube = bent();
  const TetMesh angular = tube_mesh(tube);
  tube.around *= 2, tube.across *= 2, tube.along *= 2;
  EXPECT_FALSE(is_refinement_of(tube_mesh(tube), angular)) << "it is rounder";
}

TEST(Jitter, MovesAllButTheShape) {
  const TetMesh mesh = box_mesh(brick, {6, 4, 4}), moved = jittered(mesh, 0.2);
  const MeshQuality before = mesh_quality(mesh), after = expect_sound(moved);
  EXPECT_NEAR(after.volume / before.volume, 1, 1e-12);
  EXPECT_NEAR(after.boundary_area / before.boundary_area, 1, 1e-12);
  EXPECT_EQ(moved.tets, mesh.tets);
  EXPECT_GT(after.height_ratios.max, 1.3 * before.height_ratios.max);
  int still = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Point way = moved.vertices[v] - mesh.vertices[v];
    still += way.norm() == 0 ? 1 : 0;
    EXPECT_LE(way.lpNorm<Eigen::Infinity>(), 0.2 * 0.025 * (1 + 1e-9));
    for (int a = 0; a < 3; ++a) {
      const bool on_face =
          mesh.vertices[v][a] == brick.min[a] || mesh.vertices[v][a] == brick.max[a];
      EXPECT_TRUE(!on_face || std::abs(way[a]) < 1e-15);
    }
  }
  EXPECT_EQ(still, 8) << "only corners stay";
  EXPECT_EQ(jittered(mesh, 0.2).vertices, moved.vertices);
  EXPECT_NE(jittered(mesh, 0.2, 2).vertices, moved.vertices);
  EXPECT_EQ(jittered(mesh, 0).vertices, mesh.vertices);
}

TEST(Jitter, KeepsRegionsAndRoundBodies) {
  for (const TetMesh& mesh :
       {blob_mesh({0, 0, 0}, 0.12, 8), tube_mesh(bent()), ball_mesh({0, 0, 0}, 1, 6)}) {
    const MeshQuality before = mesh_quality(mesh), after = expect_sound(jittered(mesh, 0.2));
    EXPECT_NEAR(after.volume / before.volume, 1, 1e-12);
    for (std::size_t r = 0; r < before.regions.size(); ++r)
      EXPECT_NEAR(after.regions[r].volume / before.regions[r].volume, 1, 1e-12);
  }
}

TEST(Jitter, NeverTurnsATetrahedron) {
  expect_sound(jittered(box_mesh(brick, {8, 2, 3}), 0.49));
  EXPECT_THROW(jittered(box_mesh(brick, {8, 2, 3}), 0.5), InputError);
  EXPECT_THROW(jittered(box_mesh(brick, {8, 2, 3}), -0.1), InputError);
}

TEST(BlobMesh, HasAnInclusionAndABase) {
  double before = 0;
  for (const int cells : {4, 8, 12}) {
    const TetMesh mesh = blob_mesh({0.1, 0, 0}, 0.12, cells);
    const MeshQuality quality = expect_sound(mesh);
    EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"tissue", "inclusion"}));
    EXPECT_NEAR(quality.box.max.x() - quality.box.min.x(), 0.12, 1e-12);
    EXPECT_LT(quality.height_ratios.max, 12) << cells;
    const double part = quality.regions[1].volume / quality.volume;
    EXPECT_GT(part, 0.05);
    EXPECT_LT(part, 0.15);
    EXPECT_EQ(mesh.vertex_sets.at("base").size(),
              static_cast<std::size_t>((cells + 1) * (cells + 1)));
    for (const int v : mesh.vertex_sets.at("base"))
      EXPECT_LT(mesh.vertices[static_cast<std::size_t>(v)].x(), 0.1 - 0.02);
    EXPECT_GT(quality.volume, before);  // from inside towards the round body
    before = quality.volume;
  }
  EXPECT_THROW(blob_mesh({0, 0, 0}, 0.12, 6), InputError);
  EXPECT_THROW(blob_mesh({0, 0, 0}, 0, 8), InputError);
}

TEST(TubeMesh, HasItsWallAndItsEnds) {
  const Tube tube = bent();
  const TetMesh mesh = tube_mesh(tube);
  const MeshQuality quality = expect_sound(mesh);
  EXPECT_EQ(quality.tets, 6 * 2 * 12 * 10);
  EXPECT_EQ(quality.vertices, 3 * 12 * 11);
  EXPECT_EQ(mesh.vertex_sets.at("inlet").size(), 36u);
  EXPECT_EQ(mesh.vertex_sets.at("lumen").size(), 132u);
  for (const int v : mesh.vertex_sets.at("inlet"))
    EXPECT_NEAR(mesh.vertices[static_cast<std::size_t>(v)].z(), 0.03, 1e-15);
  // a quarter turn ends where the circle's centre is above
  const double end = 0.01 + tube.length / tube.bend;
  for (const int v : mesh.vertex_sets.at("outlet"))
    EXPECT_NEAR(mesh.vertices[static_cast<std::size_t>(v)].x(), end, 1e-15);
  Tube fine = tube;
  fine.around = 60, fine.along = 40;
  const double exact = std::numbers::pi * (64e-6 - 36e-6) * tube.length;  // Pappus
  EXPECT_NEAR(mesh_quality(tube_mesh(fine)).volume / exact, 1, 3e-3);
  fine.bend = 0;
  EXPECT_NEAR(mesh_quality(tube_mesh(fine)).volume / exact, 1, 3e-3);
}

TEST(TubeMesh, RefusesBadSizes) {
  const auto refused = [](const std::function<void(Tube&)>& change) {
    Tube tube = bent();
    change(tube);
    EXPECT_THROW(tube_mesh(tube), InputError);
  };
  refused([](Tube& t) { t.around = 2; });
  refused([](Tube& t) { t.across = 0; });
  refused([](Tube& t) { t.wall = 0; });
  refused([](Tube& t) { t.bend = 8; });
  refused([](Tube& t) { t.bend = -1; });
}

}  // namespace
