// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/read_mesh.hpp>

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

}  // namespace
