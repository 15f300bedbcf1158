// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/partly_refined.hpp>
#include <plica/meshes/refinement.hpp>

// Meshes some of whose tetrahedra are cut in eight: those round a point that moves through an
// organ, whose tetrahedra are of no regular shape.
namespace {

using namespace plica;

TetMesh organ() { return read_mesh(PLICA_SOURCE_DIR "/meshes/data/liver_medium.msh"); }

/// Places of a tool over the organ and in it, and one that is far away.
const std::vector<Point> places = {
    {-0.06, 0, 0.04}, {-0.03, 0.02, 0.05}, {0, 0, 0}, {0.1, 0.01, 0.03}, {3, 0, 0}};
constexpr double radius = 0.05;

std::vector<int> tets_round(const TetMesh& mesh, const Point& place) {
  return tets_within(mesh.tets, mesh.vertices, place, radius);
}

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto x = corners_of(mesh, static_cast<int>(t));
    sum += mesh.part(t) * tet_volume(x[0], x[1], x[2], x[3]);
  }
  return sum;
}

TEST(PartlyRefined, ChoosesWhatIsNear) {
  const TetMesh mesh = organ();
  for (const Point& place : places) {
    const std::vector<int> near = tets_round(mesh, place);
    EXPECT_EQ(near.empty(), place[0] > 1);
    for (std::size_t t = 0, next = 0; t < mesh.tets.size(); ++t) {
      const auto x = corners_of(mesh, static_cast<int>(t));
      const double distance = ((x[0] + x[1] + x[2] + x[3]) / 4 - place).norm();
      const bool chosen = next < near.size() && near[next] == static_cast<int>(t);
      EXPECT_EQ(chosen, distance <= radius);
      next += chosen ? 1 : 0;
    }
  }
}

TEST(PartlyRefined, KeepsTheBody) {
  const TetMesh mesh = organ();
  const double whole = volume(mesh);
  for (const Point& place : places) {
    const std::vector<int> near = tets_round(mesh, place);
    const TetMesh made = partly_refined(mesh, near).mesh;
    EXPECT_EQ(made.tets.size(), mesh.tets.size() + 7 * near.size());
    EXPECT_NEAR(volume(made), whole, 1e-12 * whole);
    EXPECT_EQ(made.followers.vertex.empty(), near.empty());
    std::vector<Point> followed = made.vertices;
    follow_masters(made.followers, followed);
    for (std::size_t v = 0; v < followed.size(); ++v)
      EXPECT_LE((followed[v] - made.vertices[v]).norm(), 1e-13);
  }
}

TEST(PartlyRefined, WithoutAnyOrWithAllIsOneMesh) {
  const TetMesh mesh = organ();
  const TetMesh none = partly_refined(mesh, {}).mesh;
  EXPECT_EQ(none.tets, mesh.tets);
  EXPECT_TRUE(none.piece.empty());
  std::vector<int> every(mesh.tets.size());
  std::iota(every.begin(), every.end(), 0);
  const TetMesh all = partly_refined(mesh, every).mesh;
  EXPECT_EQ(all.tets, refined(mesh).tets);
  EXPECT_TRUE(all.piece.empty());
}

// A vertex is exactly in the middle of its ends
TEST(PartlyRefined, NamesItsVertices) {
  const TetMesh mesh = organ();
  std::vector<int> every(mesh.tets.size());
  std::iota(every.begin(), every.end(), 0);
  std::vector<std::vector<int>> choices = {every};
  for (const Point& place : places) choices.push_back(tets_round(mesh, place));
  for (const std::vector<int>& chosen : choices) {
    const TetMesh made = partly_refined(mesh, chosen).mesh;
    const std::vector<Ends> ends = ends_of_vertices(mesh, chosen);
    ASSERT_EQ(ends.size(), made.vertices.size());
    for (std::size_t v = 0; v < ends.size(); ++v) {
      const auto a = static_cast<std::size_t>(ends[v][0]), b = static_cast<std::size_t>(ends[v][1]);
      EXPECT_LE(a, b);
      EXPECT_EQ(made.vertices[v], Point((mesh.vertices[a] + mesh.vertices[b]) / 2));
    }
  }
}

// A field of the mesh itself stays what it is, wherever the part is
TEST(PartlyRefined, CarriesAFieldOfTheMesh) {
  const TetMesh mesh = organ();
  const std::vector<Point> field = random_field(mesh.vertices.size(), 1, 3);
  std::vector<Ends> before = ends_of_vertices(mesh, {});
  std::vector<Point> values = field;
  for (const Point& place : places) {
    const std::vector<Ends> now = ends_of_vertices(mesh, tets_round(mesh, place));
    values = carried_values(before, values, now, mesh.vertices.size());
    ASSERT_EQ(values.size(), now.size());
    for (std::size_t v = 0; v < now.size(); ++v)
      EXPECT_EQ(values[v], Point((field[static_cast<std::size_t>(now[v][0])] +
                                  field[static_cast<std::size_t>(now[v][1])]) /
                                 2));
    EXPECT_EQ(values_at_vertices(now, values, mesh.vertices.size()), field);
    before = now;
  }
}

// What is finer than the mesh goes on where the part stays, and only there
TEST(PartlyRefined, CarriesWhatThePartAlreadyHad) {
  const TetMesh mesh = organ();
  const std::size_t n = mesh.vertices.size();
  const std::vector<int> near = tets_round(mesh, places[0]), moved = tets_round(mesh, places[1]);
  std::vector<int> both;
  std::ranges::set_union(near, moved, std::back_inserter(both));
  ASSERT_LT(near.size(), both.size());
  const std::vector<Ends> part = ends_of_vertices(mesh, near), grown = ends_of_vertices(mesh, both);
  std::vector<Point> values = random_field(part.size(), 1, 5);
  follow_masters(partly_refined(mesh, near).mesh.followers, values);
  const std::vector<Point> larger = carried_values(part, values, grown, n);
  EXPECT_GT(larger.size(), values.size());
  const std::vector<Point> again = carried_values(grown, larger, part, n);
  for (std::size_t v = 0; v < values.size(); ++v) EXPECT_LE((again[v] - values[v]).norm(), 1e-15);
}

}  // namespace
