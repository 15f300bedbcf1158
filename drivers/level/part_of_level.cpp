// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/grouping.hpp>
#include <plica/core/patches.hpp>
#include <plica/drivers/elastic/build_patches.hpp>
#include <plica/drivers/level/matrix_part.hpp>
#include <plica/drivers/level/part_of_level.hpp>
#include <plica/drivers/level/rank_lists.hpp>
#include <set>
#include <utility>

namespace plica {

int RankRanges::owner(int v) const { return owner_in(vertex, v); }
int RankRanges::owner_of_run(int p) const { return owner_in(run, p); }

RankRanges rank_ranges(const TetMesh& mesh, const std::vector<std::vector<int>>& runs, int ranks,
                       int block) {
  // tetrahedra and vertices in front of each run
  std::vector<std::int64_t> tets{0}, vertices{0};
  std::vector<char> seen(mesh.vertices.size(), 0);
  for (const std::vector<int>& run : runs) {
    std::int64_t fresh = 0;
    for (const int e : run)
      for (const int v : mesh.tets[index_of(e)]) fresh += std::exchange(seen[index_of(v)], 1) == 0;
    tets.push_back(tets.back() + std::ssize(run)), vertices.push_back(vertices.back() + fresh);
  }
  RankRanges ranges{{0}, {0}};
  const auto all = static_cast<std::int64_t>(mesh.vertices.size());
  for (int r = 1; r < ranks; ++r) {
    const std::int64_t wanted = tets.back() * r / ranks;
    auto run = std::ranges::lower_bound(tets, wanted) - tets.begin();
    if (run > 0 && wanted - tets[static_cast<std::size_t>(run - 1)] <
                       tets[static_cast<std::size_t>(run)] - wanted)
      --run;
    ranges.run.push_back(static_cast<int>(run));
    const std::int64_t blocks = (vertices[static_cast<std::size_t>(run)] + block / 2) / block;
    ranges.vertex.push_back(static_cast<int>(std::min(all, blocks * block)));
  }
  ranges.run.push_back(static_cast<int>(runs.size()));
  ranges.vertex.push_back(static_cast<int>(all));
  return ranges;
}

namespace {

/// Makes the part's lists of vertices from marks on those of the whole mesh.
void list_vertices(RankPart& part, const std::vector<char>& is_local, const RankRanges& ranges,
                   int own) {
  for (std::size_t v = 0; v < is_local.size(); ++v)
    if (is_local[v]) part.vertex.push_back(static_cast<int>(v));
  for (const int v : part.vertex) part.owner.push_back(ranges.owner(v));
  part.first_owned =
      static_cast<int>(std::ranges::lower_bound(part.owner, own) - part.owner.begin());
  part.last_owned =
      static_cast<int>(std::ranges::upper_bound(part.owner, own) - part.owner.begin());
}

/// Part of a rank with linear elements.
LevelPart linear_part(const TetMesh& mesh, const std::vector<std::vector<int>>& runs,
                      const RankRanges& ranges, int own, bool matrix) {
  const SharedRows rows(mesh, runs, ranges);
  const int first = rows.first[index_of(own)], last = rows.first[index_of(own + 1)];
  LevelPart made;
  RankPart& part = made.part;
  std::vector<char> is_local(mesh.vertices.size(), 0);
  std::fill(is_local.begin() + ranges.vertex[index_of(own)],
            is_local.begin() + ranges.vertex[index_of(own + 1)], 1);
  for (int i = first; i < last; ++i) is_local[index_of(rows.vertex[index_of(i)])] = 1;
  const std::vector<char> has_shares = is_local;
  if (matrix) mark_neighbours(mesh, ranges, own, is_local);
  list_vertices(part, is_local, ranges, own);
  const LocalNumbers local(part, mesh.vertices.size());

  for (int p = ranges.run[index_of(own)]; p < ranges.run[index_of(own + 1)]; ++p)
    part.tet.insert(part.tet.end(), runs[index_of(p)].begin(), runs[index_of(p)].end());
  std::ranges::sort(part.tet);
  for (int p = ranges.run[index_of(own)]; p < ranges.run[index_of(own + 1)]; ++p)
    for (std::vector<int>& run = made.runs.emplace_back(runs[index_of(p)]); int& e : run)
      e = static_cast<int>(std::ranges::lower_bound(part.tet, e) - part.tet.begin());
  made.mesh = mesh_of_part(mesh, part, part.tet, local);

  ByRank sent(ranges.ranks()), received(ranges.ranks());
  int next = last - first;  // the next received row
  for (int i = 0; i < static_cast<int>(rows.vertex.size()); ++i) {
    const int v = rows.vertex[index_of(i)];
    if (!has_shares[index_of(v)]) continue;
    const bool is_own = i >= first && i < last;
    made.share_vertex.push_back(local(v));
    made.share_row.push_back(is_own ? i - first : next++);
    if (!is_own) received.add(rows.rank(i), i);
  }
  const Grouping of_vertex(rows.vertex, mesh.vertices.size());
  for (int i = first; i < last; ++i) {
    const int v = rows.vertex[index_of(i)];
    std::set<int> users{ranges.owner(v)};
    for (const int other : of_vertex.of(index_of(v))) users.insert(rows.rank(other));
    users.erase(own);
    for (const int q : users) sent.add(q, i - first);
  }
  made.shares = ByRank::halo(sent, received);
  made.shares.own = last - first;
  if (matrix) made.vertices = rows_of_neighbours(mesh, runs, ranges, own, part);
  return made;
}

/// Part of a rank with nodal elements.
LevelPart nodal_part(const TetMesh& mesh, const RankRanges& ranges, int own) {
  const int first = ranges.vertex[index_of(own)], last = ranges.vertex[index_of(own + 1)];
  LevelPart made;
  RankPart& part = made.part;
  std::vector<char> is_local(mesh.vertices.size(), 0);
  std::fill(is_local.begin() + first, is_local.begin() + last, 1);
  ByRank sent(ranges.ranks());
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const auto& t = mesh.tets[e];
    const auto owned = [&](int v) { return v >= first && v < last; };
    if (std::ranges::none_of(t, owned)) continue;
    part.tet.push_back(static_cast<int>(e));
    for (const int v : t) {
      is_local[index_of(v)] = 1;
      if (owned(v)) continue;
      for (const int mine : t)
        if (owned(mine)) sent.add(ranges.owner(v), mine);
    }
  }
  list_vertices(part, is_local, ranges, own);
  const LocalNumbers local(part, mesh.vertices.size());
  made.mesh = mesh_of_part(mesh, part, part.tet, local);
  for (int q = 0; q < ranges.ranks(); ++q)
    for (int& v : sent.of(q)) v = local(v);
  made.vertices = rows_of_vertices(std::move(sent), part, own, ranges.ranks());
  return made;
}

}  // namespace

LevelPart part_of_level(const TetMesh& mesh, Element element,
                        const std::vector<std::vector<int>>& runs, const RankRanges& ranges,
                        int own, bool matrix) {
  LevelPart made = element == Element::linear ? linear_part(mesh, runs, ranges, own, matrix)
                                              : nodal_part(mesh, ranges, own);
  made.part.first = ranges.vertex, made.nodal = element == Element::nodal;
  if (matrix) made.matrix = matrix_part(mesh, runs, made.part);
  return made;
}

std::vector<std::vector<int>> runs_of_patches(const TetMesh& mesh) {
  using P = Patches<Backend<double, Kokkos::DefaultHostExecutionSpace>>;
  return element_runs(mesh, P::capacity, P::vertex_capacity);
}

LevelPart part_of_level(const TetMesh& mesh, Element element, Ranks& ranks, int block,
                        bool matrix) {
  const auto runs = runs_of_patches(mesh);
  const RankRanges ranges = rank_ranges(mesh, runs, ranks.count(), block);
  LevelPart made = part_of_level(mesh, element, runs, ranges, ranks.own(), matrix);
  made.ranks = &ranks;
  return made;
}

int ReadVertices::place(int v) const {
  return static_cast<int>(std::ranges::lower_bound(vertex, v) - vertex.begin());
}

ReadVertices read_vertices(Ranks& ranks, const RankPart& of, std::vector<int> read) {
  std::ranges::sort(read);
  read.erase(std::ranges::unique(read).begin(), read.end());
  std::vector<std::vector<int>> asked(index_of(ranks.count()));
  for (const int v : read) asked[index_of(owner_in(of.first, v))].push_back(v);
  const int first = of.first[index_of(ranks.own())] - of.first_owned;
  const auto local = [&](std::vector<int> numbers) {
    for (int& v : numbers) v -= first;
    return numbers;
  };
  ReadVertices made;
  made.own = local(std::exchange(asked[index_of(ranks.own())], {}));
  made.rows.own = static_cast<int>(made.own.size());
  const std::vector<std::vector<int>> wanted = exchange_numbers(ranks, asked);
  ByRank sent(ranks.count()), received(ranks.count());
  for (int q = 0; q < ranks.count(); ++q) {
    sent.of(q) = local(wanted[index_of(q)]), received.of(q) = asked[index_of(q)];
    if (q < ranks.own()) made.rows.before += static_cast<int>(asked[index_of(q)].size());
  }
  HaloRows rows = ByRank::halo(sent, received);
  rows.before = made.rows.before, rows.own = made.rows.own;
  made.rows = std::move(rows), made.vertex = std::move(read);
  return made;
}

Embedding embedding_of_part(const Embedding& whole, const RankPart* part) {
  if (!part) return whole;
  Embedding own = whole;
  own.vertices = part->local(whole.vertices), own.weights = part->local(whole.weights);
  return own;
}

std::vector<int> read_by(const Embedding& embedding) {
  std::vector<int> all;
  for (const auto& four : embedding.vertices) all.insert(all.end(), four.begin(), four.end());
  return all;
}

Embedding with_places(Embedding embedding, const ReadVertices& read) {
  for (auto& four : embedding.vertices)
    for (int& v : four) v = read.place(v);
  return embedding;
}

namespace {

/// Local number of a vertex of the whole mesh; -1: the part does not have it.
int local_in(const RankPart& part, int v) {
  const auto at = std::ranges::lower_bound(part.vertex, v);
  return at != part.vertex.end() && *at == v ? static_cast<int>(at - part.vertex.begin()) : -1;
}

}  // namespace

LevelConstants constants_of_part(const LevelConstants& whole, const RankPart& part) {
  LevelConstants c = whole;
  c.mass = part.local(whole.mass);
  c.constrained = part.local(whole.constrained);
  c.velocity = part.local(whole.velocity);
  if (whole.mass_damping.size() > 1) {
    c.mass_damping = part.local(whole.mass_damping);
    // more than one entry says that there is one for each vertex
    c.mass_damping.resize(std::max<std::size_t>(2, c.mass_damping.size()));
  }
  if (!whole.fibres.empty()) {
    c.fibres.clear();
    for (const int e : part.tet) c.fibres.push_back(whole.fibres[index_of(e)]);
  }
  c.sliding.clear(), c.prescribed_vertex.clear(), c.prescribed_motion.clear();
  for (SlidingVertex one : whole.sliding)
    if (one.vertex = local_in(part, one.vertex); one.vertex >= 0) c.sliding.push_back(one);
  for (std::size_t i = 0; i < whole.prescribed_vertex.size(); ++i)
    if (const int v = local_in(part, whole.prescribed_vertex[i]); v >= 0) {
      c.prescribed_vertex.push_back(v);
      c.prescribed_motion.push_back(whole.prescribed_motion[i]);
    }
  return c;
}

std::vector<AssembledLoad> loads_of_part(const std::vector<AssembledLoad>& whole,
                                         const RankPart& part) {
  std::vector<AssembledLoad> all;
  for (const AssembledLoad& load : whole) {
    AssembledLoad& own = all.emplace_back();
    own.resultant = load.resultant;
    for (std::size_t i = 0; i < load.vertex.size(); ++i)
      if (const int v = local_in(part, load.vertex[i]); v >= 0)
        own.vertex.push_back(v), own.force.push_back(load.force[i]);
  }
  return all;
}

std::vector<HeldSet> held_by_part(const std::vector<HeldSet>& whole, const RankPart& part) {
  std::vector<HeldSet> all;
  for (const HeldSet& set : whole) {
    HeldSet& own = all.emplace_back(HeldSet{set.name, set.centre, {}, {}});
    for (std::size_t i = 0; i < set.vertex.size(); ++i)
      if (const int v = local_in(part, set.vertex[i]); v >= part.first_owned && v < part.last_owned)
        own.vertex.push_back(v), own.share.push_back(set.share[i]);
  }
  return all;
}

}  // namespace plica
