// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/elastic/build_patches.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/reordering.hpp>
#include <random>
#include <set>

// Runs of elements, of which patches are made, on Delaunay meshes of organs and on a grid.
namespace {

using namespace plica;

constexpr int elements = 256, vertices = 120;

TetMesh organ(const std::string& name) {
  return read_mesh(PLICA_SOURCE_DIR "/meshes/data/organs/" + name + ".vtk");
}

std::size_t vertices_of(const TetMesh& mesh, const std::vector<int>& run) {
  std::set<int> all;
  for (const int e : run) all.insert(mesh.tets[index_of(e)].begin(), mesh.tets[index_of(e)].end());
  return all.size();
}

void expect_each_once(const TetMesh& mesh, const std::vector<std::vector<int>>& runs) {
  std::vector<int> all;
  for (const std::vector<int>& run : runs) {
    EXPECT_FALSE(run.empty());
    EXPECT_LE(run.size(), elements);
    EXPECT_LE(vertices_of(mesh, run), vertices);
    EXPECT_TRUE(std::ranges::is_sorted(run));
    all.insert(all.end(), run.begin(), run.end());
  }
  std::ranges::sort(all);
  std::vector<int> expected(mesh.tets.size());
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(all, expected);
}

TEST(Runs, HaveEachElementOnceAndFewVertices) {
  for (const char* name : {"liver", "branch", "ventricle"}) {
    const TetMesh mesh = organ(name);
    const auto runs = element_runs(mesh, elements, vertices);
    expect_each_once(mesh, runs);
    std::size_t copies = 0;
    for (const auto& run : runs) copies += vertices_of(mesh, run);
    EXPECT_LT(copies, 2.6 * static_cast<double>(mesh.vertices.size())) << name;
    EXPECT_LT(runs.size(), 1.25 * static_cast<double>(mesh.tets.size()) / elements + 2) << name;
  }
}

// A run has elements that follow each other on the curve, whatever the order of the mesh.
TEST(Runs, AreTheSameInAnyOrderOfTheMesh) {
  TetMesh mesh = organ("liver");
  mesh.region.clear();
  Reordering shuffled{{}, std::vector<int>(mesh.tets.size())};
  shuffled.vertices.resize(mesh.vertices.size());
  std::iota(shuffled.vertices.begin(), shuffled.vertices.end(), 0);
  std::iota(shuffled.tets.begin(), shuffled.tets.end(), 0);
  std::shuffle(shuffled.tets.begin(), shuffled.tets.end(), std::mt19937(5));
  auto runs = element_runs(reordered(mesh, shuffled), elements, vertices);
  for (std::vector<int>& run : runs) {
    for (int& e : run) e = shuffled.tets[index_of(e)];
    std::ranges::sort(run);
  }
  EXPECT_EQ(runs, element_runs(mesh, elements, vertices));
  const TetMesh sorted = reordered(mesh, locality_order(mesh));
  int next = 0;
  for (const std::vector<int>& run : element_runs(sorted, elements, vertices))
    for (const int e : run) EXPECT_EQ(e, next++);
}

TEST(Runs, KeepRegionsApartWithinEachStretch) {
  constexpr int stretch = 4096;
  TetMesh mesh = box_mesh({Point::Zero(), Point(0.3, 0.1, 0.1)}, {24, 8, 8});
  mesh = reordered(mesh, locality_order(mesh));
  mesh.region_names = {"a", "b", "c"};
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
    mesh.region.push_back(static_cast<int>(e * e % 7 % 3));
  const auto runs = element_runs(mesh, elements, vertices);
  expect_each_once(mesh, runs);
  std::map<std::pair<int, int>, std::vector<int>> of;
  for (const std::vector<int>& run : runs) {
    const std::pair key(run.front() / stretch, mesh.region[index_of(run.front())]);
    for (const int e : run) {
      EXPECT_EQ(std::pair(e / stretch, mesh.region[index_of(e)]), key);
      of[key].push_back(e);
    }
  }
  EXPECT_EQ(of.size(), 3 * ((mesh.tets.size() + stretch - 1) / stretch));
  for (const auto& [key, tets] : of) EXPECT_TRUE(std::ranges::is_sorted(tets));
}

// Two threads have equal shares of a body that fills a patch and a little more.
TEST(Runs, AreAboutEquallyLong) {
  const TetMesh mesh = box_mesh({Point::Zero(), Point(0.1, 0.1, 0.1)}, {5, 3, 3});
  const auto runs = element_runs(mesh, elements, vertices);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].size(), 136u);
  EXPECT_EQ(runs[1].size(), 134u);
}

TEST(Runs, TakeOneElementWhereNoMoreFits) {
  const TetMesh mesh = organ("branch");
  const auto runs = element_runs(mesh, 1, 4);
  EXPECT_EQ(runs.size(), mesh.tets.size());
}

}  // namespace
