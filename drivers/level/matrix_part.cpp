// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/level/matrix_part.hpp>
#include <plica/drivers/level/rank_lists.hpp>
#include <utility>

namespace plica {

namespace {

/// Vertices of the whole mesh that one rank owns.
struct OwnVertices {
  int first, last;
  bool has(int v) const { return v >= first && v < last; }
  bool touch(const std::array<int, 4>& t) const {
    return std::ranges::any_of(t, [&](int v) { return has(v); });
  }
};

OwnVertices owned_by(const RankRanges& ranges, int own) {
  return {ranges.vertex[index_of(own)], ranges.vertex[index_of(own + 1)]};
}

}  // namespace

void mark_neighbours(const TetMesh& mesh, const RankRanges& ranges, int own,
                     std::vector<char>& is_local) {
  const OwnVertices owned = owned_by(ranges, own);
  for (const auto& t : mesh.tets)
    if (owned.touch(t))
      for (const int v : t) is_local[index_of(v)] = 1;
}

HaloRows rows_of_neighbours(const TetMesh& mesh, const std::vector<std::vector<int>>& runs,
                            const RankRanges& ranges, int own, const RankPart& part) {
  const OwnVertices owned = owned_by(ranges, own);
  const LocalNumbers local(part, mesh.vertices.size());
  ByRank sent(ranges.ranks());
  for (std::size_t p = 0; p < runs.size(); ++p)
    for (const int e : runs[p]) {
      const auto& t = mesh.tets[index_of(e)];
      if (!owned.touch(t)) continue;
      const int of_run = ranges.owner_of_run(static_cast<int>(p));
      for (const int v : t) {
        if (!owned.has(v)) continue;
        if (of_run != own) sent.add(of_run, local(v));
        for (const int other : t)
          if (!owned.has(other)) sent.add(ranges.owner(other), local(v));
      }
    }
  return rows_of_vertices(std::move(sent), part, own, ranges.ranks());
}

MatrixPart matrix_part(const TetMesh& mesh, const std::vector<std::vector<int>>& runs,
                       const RankPart& part) {
  const LocalNumbers local(part, mesh.vertices.size());
  const auto touches = [&](int e) {
    return std::ranges::any_of(mesh.tets[index_of(e)],
                               [&](int v) { return local.has(v) && part.owns(local(v)); });
  };
  MatrixPart made;
  for (const std::vector<int>& run : runs)
    std::ranges::copy_if(run, std::back_inserter(made.tet), touches);
  std::ranges::sort(made.tet);
  for (const std::vector<int>& run : runs) {
    std::vector<int> its;
    for (const int e : run)
      if (touches(e))
        its.push_back(static_cast<int>(std::ranges::lower_bound(made.tet, e) - made.tet.begin()));
    if (!its.empty()) made.runs.push_back(std::move(its));
  }
  made.mesh = mesh_of_part(mesh, part, made.tet, local);
  return made;
}

}  // namespace plica
