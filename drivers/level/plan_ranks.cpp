// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/grouping.hpp>
#include <plica/drivers/level/part_of_level.hpp>
#include <plica/drivers/level/rank_lists.hpp>
#include <set>
#include <utility>

namespace plica {

namespace {

/// Counts of what ranks send to each other.
struct PlanCounts {
  std::vector<RankPlan>& plans;
  std::set<std::pair<int, int>> neighbours = {};  ///< receiver and sender

  void add(int from, int to) {
    ++plans[index_of(from)].sent, ++plans[index_of(to)].received;
    if (neighbours.emplace(to, from).second) ++plans[index_of(to)].neighbours;
  }
};

void count_linear(const TetMesh& mesh, const std::vector<std::vector<int>>& runs,
                  const RankRanges& ranges, std::vector<RankPlan>& plans) {
  const SharedRows rows(mesh, runs, ranges);
  const Grouping of_vertex(rows.vertex, mesh.vertices.size());
  PlanCounts counts{plans};
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v) {
    const int owner = ranges.owner(v);
    std::set<int> users{owner};
    for (const int row : of_vertex.of(index_of(v))) users.insert(rows.rank(row));
    if (users.size() == 1) continue;
    for (const int q : users) plans[index_of(q)].copies += q != owner;
    for (const int row : of_vertex.of(index_of(v)))
      for (const int q : users)
        if (const int from = rows.rank(row); q != from) counts.add(from, q);
  }
}

void count_nodal(const TetMesh& mesh, const RankRanges& ranges, std::vector<RankPlan>& plans) {
  std::vector<std::set<int>> users(mesh.vertices.size());  // other ranks that read the vertex
  for (const auto& t : mesh.tets)
    for (const int v : t)
      for (const int other : t)
        if (const int q = ranges.owner(other); q != ranges.owner(v)) users[index_of(v)].insert(q);
  PlanCounts counts{plans};
  for (int v = 0; v < static_cast<int>(users.size()); ++v)
    for (const int q : users[index_of(v)])
      counts.add(ranges.owner(v), q), ++plans[index_of(q)].copies;
}

}  // namespace

std::vector<RankPlan> plan_ranks(const TetMesh& mesh, Element element,
                                 const std::vector<std::vector<int>>& runs, int ranks, int block) {
  const RankRanges ranges = rank_ranges(mesh, runs, ranks, block);
  std::vector<RankPlan> plans(index_of(ranks));
  for (int r = 0; r < ranks; ++r) {
    RankPlan& plan = plans[index_of(r)];
    for (int p = ranges.run[index_of(r)]; p < ranges.run[index_of(r + 1)]; ++p)
      plan.tets += std::ssize(runs[index_of(p)]);
    plan.vertices = ranges.vertex[index_of(r + 1)] - ranges.vertex[index_of(r)];
  }
  if (element == Element::linear)
    count_linear(mesh, runs, ranges, plans);
  else
    count_nodal(mesh, ranges, plans);
  return plans;
}

}  // namespace plica
