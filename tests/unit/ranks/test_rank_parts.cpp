// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numeric>
#include <plica/core/grouping.hpp>
#include <plica/drivers/elastic/build_patches.hpp>
#include <plica/drivers/level/part_of_level.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/reordering.hpp>

// How a mesh is shared out to ranks: what one sends is what another waits for.
namespace {

using namespace plica;

constexpr int block = 128;  // smaller than in runs, so that every rank has some vertices

/// A Delaunay mesh along its curve, as runs of several ranks have it, or in the order of its file.
TetMesh ventricle(bool along_curve) {
  const TetMesh mesh = read_mesh(PLICA_SOURCE_DIR "/meshes/data/organs/ventricle.vtk");
  return along_curve ? reordered(mesh, locality_order(mesh)) : mesh;
}

/// The parts of all ranks.
struct Parts {
  Parts(const TetMesh& mesh, Element element, int ranks)
      : runs(element_runs(mesh, 256, 120)), ranges(rank_ranges(mesh, runs, ranks, block)) {
    for (int r = 0; r < ranks; ++r) all.push_back(part_of_level(mesh, element, runs, ranges, r));
  }
  std::vector<std::vector<int>> runs;
  RankRanges ranges;
  std::vector<LevelPart> all;

  /// Returns the numbers of the vertices whose rows go from one rank to another, in order.
  std::vector<int> sent(int from, int to, const HaloRows LevelPart::*halo) const {
    const LevelPart& part = all[index_of(from)];
    const HaloRows& rows = part.*halo;
    std::vector<int> numbers;
    for (std::size_t n = 0; n < rows.rank.size(); ++n)
      for (int i = rows.first_sent[n]; rows.rank[n] == to && i < rows.first_sent[n + 1]; ++i)
        numbers.push_back(vertex_of(part, rows.sent[index_of(i)], halo));
    return numbers;
  }
  std::vector<int> received(int from, int by, const HaloRows LevelPart::*halo) const {
    const LevelPart& part = all[index_of(by)];
    const HaloRows& rows = part.*halo;
    std::vector<int> numbers;
    for (std::size_t n = 0; n < rows.rank.size(); ++n)
      for (int i = rows.first_received[n]; rows.rank[n] == from && i < rows.first_received[n + 1];
           ++i)
        numbers.push_back(vertex_of(part, i < rows.before ? i : i + rows.own, halo));
    return numbers;
  }

 private:
  /// Returns the number in the whole mesh of the vertex that a local row is of.
  static int vertex_of(const LevelPart& part, int row, const HaloRows LevelPart::*halo) {
    if (halo == &LevelPart::vertices) return part.part.vertex[index_of(row)];
    const auto at = std::ranges::find(part.share_row, row) - part.share_row.begin();
    return part.part.vertex[index_of(part.share_vertex[static_cast<std::size_t>(at)])];
  }
};

TEST(RankParts, OwnEachVertexAndTetrahedronOnce) {
  for (const bool along_curve : {true, false})
    for (const int ranks : {1, 2, 3, 7, 16, 300}) {
      const TetMesh mesh = ventricle(along_curve);
      const Parts parts(mesh, Element::linear, ranks);
      std::vector<int> vertices(mesh.vertices.size(), 0), tets(mesh.tets.size(), 0);
      for (const LevelPart& one : parts.all) {
        EXPECT_TRUE(std::ranges::is_sorted(one.part.vertex));
        EXPECT_EQ(one.mesh.vertices.size(), one.part.vertex.size());
        for (const int v : one.part.of_owned(one.part.vertex)) ++vertices[index_of(v)];
        for (const int e : one.part.tet) ++tets[index_of(e)];
      }
      EXPECT_EQ(std::ranges::count(vertices, 1), std::ssize(vertices)) << ranks;
      EXPECT_EQ(std::ranges::count(tets, 1), std::ssize(tets)) << ranks;
    }
}

TEST(RankParts, SendWhatOthersWaitFor) {
  for (const bool along_curve : {true, false})
    for (const int ranks : {2, 3, 7, 16}) {
      const TetMesh mesh = ventricle(along_curve);
      std::int64_t rows = 0;
      for (const Element element : {Element::linear, Element::nodal}) {
        const Parts parts(mesh, element, ranks);
        const auto halo = element == Element::linear ? &LevelPart::shares : &LevelPart::vertices;
        const std::vector<RankPlan> plans =
            plan_ranks(mesh, element, runs_of_patches(mesh), ranks, block);
        for (int a = 0; a < ranks; ++a) {
          const HaloRows& own = parts.all[index_of(a)].*halo;
          EXPECT_EQ(std::ssize(own.sent), plans[index_of(a)].sent);
          EXPECT_EQ(own.received(), plans[index_of(a)].received);
          EXPECT_EQ(std::ssize(parts.all[index_of(a)].part.vertex),
                    plans[index_of(a)].vertices + plans[index_of(a)].copies);
          rows += own.received();
          for (int b = 0; b < ranks; ++b)
            EXPECT_EQ(parts.sent(a, b, halo), parts.received(a, b, halo)) << a << " to " << b;
        }
      }
      EXPECT_GT(rows, 0);
    }
}

// A vertex adds its shares in the order of the whole mesh, wherever it is updated: rows of ranks
// below, of the rank itself, of ranks above.
TEST(RankParts, AddAllSharesInOneOrder) {
  const TetMesh mesh = ventricle(true);
  const Parts whole(mesh, Element::linear, 1), parts(mesh, Element::linear, 5);
  const Grouping all(whole.all[0].share_vertex, mesh.vertices.size());
  for (int r = 0; r < 5; ++r) {
    const LevelPart& one = parts.all[index_of(r)];
    const HaloRows& rows = one.shares;
    const auto rank_of = [&](int row) {
      if (row < rows.own) return r;
      const auto n = std::ranges::upper_bound(rows.first_received, row - rows.own);
      return rows.rank[static_cast<std::size_t>(n - rows.first_received.begin() - 1)];
    };
    const Grouping own(one.share_vertex, one.part.vertex.size());
    for (std::size_t i = 0; i < one.part.vertex.size(); ++i) {
      EXPECT_EQ(own.of(i).size(), all.of(index_of(one.part.vertex[i])).size());
      std::vector<int> ranks;
      for (const int share : own.of(i)) ranks.push_back(rank_of(one.share_row[index_of(share)]));
      EXPECT_TRUE(std::ranges::is_sorted(ranks)) << "vertex " << one.part.vertex[i];
    }
  }
}

TEST(RankParts, HaveAboutAsMuchWork) {
  const TetMesh mesh = ventricle(true);
  for (const int ranks : {2, 4, 8}) {
    const std::vector<RankPlan> plans =
        plan_ranks(mesh, Element::linear, runs_of_patches(mesh), ranks, block);
    const auto most = std::ranges::max_element(plans, {}, &RankPlan::tets)->tets;
    EXPECT_LT(static_cast<double>(most * ranks), 1.1 * static_cast<double>(mesh.tets.size()));
  }
}

}  // namespace
