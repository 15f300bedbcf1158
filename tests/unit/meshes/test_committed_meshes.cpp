// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <plica/meshes/compare_levels.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/mesh_quality.hpp>

namespace {

using namespace plica;

const std::filesystem::path folder = std::filesystem::path(PLICA_SOURCE_DIR) / "meshes" / "data";

TEST(CommittedMeshes, AreSoundAndSmall) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".msh") continue;
    SCOPED_TRACE(entry.path().string());
    ++count;
    EXPECT_LT(entry.file_size(), 150'000u);
    MeshReport report;
    const TetMesh mesh = read_mesh(entry.path(), &report);
    EXPECT_EQ(report.flipped, 0);
    EXPECT_EQ(report.unreferenced, 0);
    const MeshQuality quality = mesh_quality(mesh);
    EXPECT_EQ(quality.parts, 1);
    EXPECT_EQ(quality.duplicate_vertices, 0);
    EXPECT_LT(quality.height_ratios.max, 7.0);
    EXPECT_LT((quality.box.max - quality.box.min).norm(), 0.5);  // in metres, not millimetres
  }
  EXPECT_EQ(count, 5);
}

TEST(CommittedMeshes, BeamHasATumourAndABase) {
  const TetMesh mesh = read_mesh(folder / "beam.msh");
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"tissue", "tumour"}));
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_NEAR(quality.volume, 0.16 * 0.04 * 0.04, 1e-15);
  EXPECT_NEAR(quality.regions[1].volume, 4.0 / 3.0 * 3.14159 * std::pow(0.012, 3), 2e-6);
  ASSERT_GT(mesh.vertex_sets.at("base").size(), 10u);
  for (const int v : mesh.vertex_sets.at("base")) EXPECT_EQ(mesh.vertices[static_cast<std::size_t>(v)].x(), 0.0);
}

TEST(CommittedMeshes, BallIsRound) {
  const TetMesh mesh = read_mesh(folder / "ball.msh");
  for (const int v : mesh.vertex_sets.at("skin"))
    EXPECT_NEAR(mesh.vertices[static_cast<std::size_t>(v)].norm(), 0.05, 1e-12);
}

TEST(CommittedMeshes, LiversFitEachOther) {
  const TetMesh fine = read_mesh(folder / "liver_fine.msh"), medium = read_mesh(folder / "liver_medium.msh"),
                coarse = read_mesh(folder / "liver_coarse.msh");
  EXPECT_GT(fine.tets.size(), 2 * medium.tets.size());
  EXPECT_GT(2 * medium.tets.size(), 3 * coarse.tets.size());
  for (const auto* pair : {&fine, &coarse}) {
    const Embedding down = embed(pair->vertices, medium, Outside::extrapolate);
    EXPECT_GT(down.misses, 0);  // the boundaries differ
    EXPECT_EQ(down.held, 0);
    EXPECT_LT(down.largest_distance_over_edge, 0.2);
  }
}

TEST(CommittedMeshes, HornsAreGradedAndNotNested) {
  std::vector<TetMesh> horns;
  for (const char* name : {"fine", "medium", "coarse"}) {
    const auto file = folder / "graded" / (std::string("horn_") + name + ".msh");
    EXPECT_LE(std::filesystem::file_size(file), 400'000u);
    MeshReport report;
    horns.push_back(read_mesh(file, &report));
    EXPECT_EQ(report.flipped + report.unreferenced, 0);
    const MeshQuality quality = mesh_quality(horns.back());
    EXPECT_EQ(quality.parts, 1);
    EXPECT_LT(quality.height_ratios.max, 7.0);
    EXPECT_GT(quality.edges.max, 7 * quality.edges.min);
    EXPECT_GT(horns.back().vertex_sets.at("base").size(), 5u);
    for (const int v : horns.back().vertex_sets.at("base"))
      EXPECT_EQ(horns.back().vertices[static_cast<std::size_t>(v)].x(), 0.0);
  }
  for (std::size_t i = 1; i < horns.size(); ++i) {
    EXPECT_GT(horns[i - 1].tets.size(), 4 * horns[i].tets.size());
    const Embedding down = embed(horns[i].vertices, horns[i - 1], Outside::clamp);
    EXPECT_GT(down.misses, 0);
    EXPECT_LT(down.largest_distance_over_edge, 0.5);
  }
}

SameBody same(const TetMesh& finest, const TetMesh& coarse) {
  return compare_levels(mesh_size(finest, {1000}), mesh_size(coarse, {1000}), 1).same;
}
TetMesh only_region_of(TetMesh mesh) {
  mesh.region.clear();
  return mesh;
}

// What is meant as levels of one body is not doubted, from files and from generators.
TEST(CompareLevels, DoubtsNoCommittedMesh) {
  const auto read = [](const char* name) { return only_region_of(read_mesh(folder / name)); };
  for (const char* coarse : {"liver_medium.msh", "liver_coarse.msh"})
    EXPECT_EQ(same(read("liver_fine.msh"), read(coarse)), SameBody::yes) << coarse;
  for (const char* coarse : {"graded/horn_medium.msh", "graded/horn_coarse.msh"})
    EXPECT_EQ(same(read("graded/horn_fine.msh"), read(coarse)), SameBody::yes) << coarse;
  const auto ball = [](int cells) { return ball_mesh({0, 0, 0}, 0.05, cells); };
  EXPECT_EQ(same(ball(16), ball(4)), SameBody::yes);
  EXPECT_EQ(same(ball(4), ball(2)), SameBody::yes);
  EXPECT_EQ(same(ball(16), ball(1)), SameBody::doubtful);  // a cube of 37 % of the volume
}

TEST(CompareLevels, RefusesAnotherScaleOrPlace) {
  const TetMesh fine = box_mesh({{0, 0, 0}, {0.2, 0.1, 0.1}}, {4, 2, 2});
  const auto coarse = [&](double scale, double shift) {
    TetMesh mesh = box_mesh({{0, 0, 0}, {0.2, 0.1, 0.1}}, {2, 1, 1});
    for (Point& p : mesh.vertices) p = scale * p + Point(shift, 0, 0);
    return mesh;
  };
  EXPECT_EQ(same(fine, coarse(1, 0)), SameBody::yes);
  EXPECT_EQ(same(fine, coarse(1.04, 0)), SameBody::yes);
  EXPECT_EQ(same(fine, coarse(1.06, 0)), SameBody::doubtful);
  EXPECT_EQ(same(fine, coarse(1, 0.02)), SameBody::doubtful);
  for (const double scale : {1e-3, 1e-2, 0.45, 2.1, 100.0, 1000.0})
    EXPECT_EQ(same(fine, coarse(scale, 0)), SameBody::no) << scale;
  for (const double shift : {-0.1, 0.06, 0.1}) EXPECT_EQ(same(fine, coarse(1, shift)), SameBody::no) << shift;
  const MeshSize light = mesh_size(fine, {200}), heavy = mesh_size(fine, {1000});
  EXPECT_EQ(compare_levels(heavy, light, 1).same, SameBody::no);
  const std::string said = compare_levels(heavy, mesh_size(coarse(1000, 0), {1000}), 2).sentence;
  EXPECT_EQ(
      said,
      "level 2 is not the body of level 0: 200 x 100 x 100 m, 2e+06 m^3, 2e+09 kg, centroid [100, 50, 50] instead "
      "of 0.2 x 0.1 x 0.1 m, 0.002 m^3, 2 kg, centroid [0.1, 0.05, 0.05]; is the file of level 2 in mm? Then its "
      "scale is 0.001");
}

}  // namespace
