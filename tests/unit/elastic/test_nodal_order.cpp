// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <map>
#include <plica/core/to_device.hpp>
#include <plica/drivers/elastic/build_nodal_rows.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <set>

#include "support/backends.hpp"

// The order of rows and entries of nodal elements follows the numbers of vertices.
namespace {

using namespace plica;
using namespace plica::test;

/// A liver of several blocks of vertices with three regions that are mixed everywhere.
TetMesh mixed_organ() {
  TetMesh mesh = read_mesh(PLICA_SOURCE_DIR "/meshes/data/organs/liver.vtk");
  mesh.region_names = {"a", "b", "c"};
  mesh.region.clear();
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
    mesh.region.push_back(static_cast<int>(e / 7 % 3));
  return mesh;
}

template <class B>
NodalRows<B> rows_of(const TetMesh& mesh) {
  const std::vector<std::vector<double>> material(3, {1e4, 1e4});
  return build_nodal_rows<B>(mesh, {material, {1, 1, 1}, {}, {}}, {});
}

template <class B>
class NodalOrder : public testing::Test {};
TYPED_TEST_SUITE(NodalOrder, EachBackend);

TYPED_TEST(NodalOrder, SlicesAreOfOneBlockAndRegion) {
  using B = TypeParam;
  const TetMesh mesh = mixed_organ();
  const NodalRows<B> rows = rows_of<B>(mesh);
  const auto vertex = on_host(rows.vertex), region = on_host(rows.region);
  std::pair<int, int> last{-1, -1};
  std::set<std::pair<int, int>> domains;
  for (int slot = 0; slot < rows.slots(); ++slot) {
    if (vertex(slot) < 0) continue;
    const int slice = slot / NodalRows<B>::height;
    const std::pair now(vertex(slot) / vertex_block<B>, region(slice));
    EXPECT_LE(last, now) << slot;
    last = now;
    EXPECT_TRUE(domains.emplace(vertex(slot), region(slice)).second) << slot;
  }
  EXPECT_EQ(domains.size(), static_cast<std::size_t>(rows.domains));
  EXPECT_GT(last.first, 0) << "several blocks";
}

TYPED_TEST(NodalOrder, EntriesAscendByVertex) {
  using B = TypeParam;
  constexpr int height = NodalRows<B>::height;
  const TetMesh mesh = mixed_organ();
  const NodalRows<B> rows = rows_of<B>(mesh);
  const auto vertex = on_host(rows.vertex), region = on_host(rows.region),
             first = on_host(rows.first);
  const auto neighbour = on_host(rows.neighbour);
  std::map<std::pair<int, int>, std::set<int>> expected;  // of each vertex and region
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
    for (const int a : mesh.tets[e])
      for (const int b : mesh.tets[e])
        if (a != b) expected[{a, mesh.region[e]}].insert(b);
  for (int slot = 0; slot < rows.slots(); ++slot) {
    if (vertex(slot) < 0) continue;
    const int slice = slot / height;
    std::vector<int> found;
    for (int e = first(slice); e < first(slice + 1); ++e)
      if (const int other = neighbour(e, slot % height); other != slot) {
        EXPECT_EQ(region(other / height), region(slice));
        found.push_back(vertex(other));
      }
    const std::set<int>& own = expected.at({vertex(slot), region(slice)});
    EXPECT_EQ(found, std::vector<int>(own.begin(), own.end())) << slot;
  }
}

}  // namespace
