// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstring>
#include <plica/core/grouping.hpp>
#include <plica/core/patches.hpp>
#include <plica/drivers/elastic/build_patches.hpp>
#include <plica/drivers/level/part_of_level.hpp>
#include <set>
#include <utility>

namespace plica {

namespace {

int owner_in(const std::vector<int>& first, int number) {
  return static_cast<int>(std::ranges::upper_bound(first, number) - first.begin()) - 1;
}

}  // namespace

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

/// Rows of the patches of a whole mesh: each run has a row for each of its vertices, ascending.
struct SharedRows {
  std::vector<int> vertex;    ///< [rows]
  std::vector<int> first{0};  ///< [ranks + 1] first row of each rank

  SharedRows(const TetMesh& mesh, const std::vector<std::vector<int>>& runs,
             const RankRanges& ranges) {
    for (int r = 0; r < ranges.ranks(); ++r) {
      for (int p = ranges.run[index_of(r)]; p < ranges.run[index_of(r + 1)]; ++p) {
        std::vector<int> corners;
        for (const int e : runs[index_of(p)])
          for (const int v : mesh.tets[index_of(e)]) corners.push_back(v);
        std::ranges::sort(corners);
        const auto repeated = std::ranges::unique(corners);
        vertex.insert(vertex.end(), corners.begin(), repeated.begin());
      }
      first.push_back(static_cast<int>(vertex.size()));
    }
  }
  int rank(int row) const { return owner_in(first, row); }
};

/// Lists of what goes to each rank, or comes from it.
class ByRank {
 public:
  explicit ByRank(int ranks) : all_(index_of(ranks)) {}
  void add(int rank, int row) { all_[index_of(rank)].push_back(row); }
  std::vector<int>& of(int rank) { return all_[index_of(rank)]; }

  static HaloRows halo(const ByRank& sent, const ByRank& received) {
    HaloRows rows;
    for (std::size_t q = 0; q < sent.all_.size(); ++q) {
      if (sent.all_[q].empty() && received.all_[q].empty()) continue;
      rows.rank.push_back(static_cast<int>(q));
      rows.sent.insert(rows.sent.end(), sent.all_[q].begin(), sent.all_[q].end());
      rows.first_sent.push_back(static_cast<int>(rows.sent.size()));
      rows.first_received.push_back(rows.first_received.back() +
                                    static_cast<int>(received.all_[q].size()));
    }
    return rows;
  }

 private:
  std::vector<std::vector<int>> all_;
};

/// Local numbers of a part's vertices.
class LocalNumbers {
 public:
  LocalNumbers(const RankPart& part, std::size_t vertices) : of_(vertices, -1) {
    for (std::size_t i = 0; i < part.vertex.size(); ++i)
      of_[index_of(part.vertex[i])] = static_cast<int>(i);
  }
  int operator()(int v) const { return of_[index_of(v)]; }
  bool has(int v) const { return of_[index_of(v)] >= 0; }

 private:
  std::vector<int> of_;
};

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

TetMesh mesh_of_part(const TetMesh& mesh, const RankPart& part, const LocalNumbers& local) {
  TetMesh own;
  own.vertices = part.local(mesh.vertices);
  own.region_names = mesh.region_names;
  for (const int e : part.tet) {
    auto& corners = own.tets.emplace_back(mesh.tets[index_of(e)]);
    for (int& v : corners) v = local(v);
    if (!mesh.region.empty()) own.region.push_back(mesh.region[index_of(e)]);
    if (!mesh.filled.empty()) own.filled.push_back(mesh.filled[index_of(e)]);
  }
  return own;
}

/// Part of a rank with linear elements.
LevelPart linear_part(const TetMesh& mesh, const std::vector<std::vector<int>>& runs,
                      const RankRanges& ranges, int own) {
  const SharedRows rows(mesh, runs, ranges);
  const int first = rows.first[index_of(own)], last = rows.first[index_of(own + 1)];
  LevelPart made;
  RankPart& part = made.part;
  std::vector<char> is_local(mesh.vertices.size(), 0);
  std::fill(is_local.begin() + ranges.vertex[index_of(own)],
            is_local.begin() + ranges.vertex[index_of(own + 1)], 1);
  for (int i = first; i < last; ++i) is_local[index_of(rows.vertex[index_of(i)])] = 1;
  list_vertices(part, is_local, ranges, own);
  const LocalNumbers local(part, mesh.vertices.size());

  for (int p = ranges.run[index_of(own)]; p < ranges.run[index_of(own + 1)]; ++p)
    part.tet.insert(part.tet.end(), runs[index_of(p)].begin(), runs[index_of(p)].end());
  std::ranges::sort(part.tet);
  for (int p = ranges.run[index_of(own)]; p < ranges.run[index_of(own + 1)]; ++p)
    for (std::vector<int>& run = made.runs.emplace_back(runs[index_of(p)]); int& e : run)
      e = static_cast<int>(std::ranges::lower_bound(part.tet, e) - part.tet.begin());
  made.mesh = mesh_of_part(mesh, part, local);

  ByRank sent(ranges.ranks()), received(ranges.ranks());
  int next = last - first;  // the next received row
  for (int i = 0; i < static_cast<int>(rows.vertex.size()); ++i) {
    const int v = rows.vertex[index_of(i)];
    if (!local.has(v)) continue;
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
  return made;
}

/// Part of a rank with nodal elements.
LevelPart nodal_part(const TetMesh& mesh, const RankRanges& ranges, int own) {
  const int first = ranges.vertex[index_of(own)], last = ranges.vertex[index_of(own + 1)];
  LevelPart made;
  RankPart& part = made.part;
  std::vector<char> is_local(mesh.vertices.size(), 0);
  std::fill(is_local.begin() + first, is_local.begin() + last, 1);
  ByRank sent(ranges.ranks()), received(ranges.ranks());
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
  made.mesh = mesh_of_part(mesh, part, local);
  for (std::size_t i = 0; i < part.vertex.size(); ++i)
    if (part.owner[i] != own) received.add(part.owner[i], static_cast<int>(i));
  for (int q = 0; q < ranges.ranks(); ++q) {
    std::vector<int>& its = sent.of(q);
    std::ranges::sort(its);
    its.erase(std::ranges::unique(its).begin(), its.end());
    for (int& v : its) v = local(v);
  }
  made.vertices = ByRank::halo(sent, received);
  made.vertices.before = part.first_owned, made.vertices.own = part.owned();
  return made;
}

}  // namespace

LevelPart part_of_level(const TetMesh& mesh, Element element,
                        const std::vector<std::vector<int>>& runs, const RankRanges& ranges,
                        int own) {
  return element == Element::linear ? linear_part(mesh, runs, ranges, own)
                                    : nodal_part(mesh, ranges, own);
}

std::vector<std::vector<int>> runs_of_patches(const TetMesh& mesh) {
  using P = Patches<Backend<double, Kokkos::DefaultHostExecutionSpace>>;
  return element_runs(mesh, P::capacity, P::vertex_capacity);
}

LevelPart part_of_level(const TetMesh& mesh, Element element, Ranks& ranks, int block) {
  const auto runs = runs_of_patches(mesh);
  RankRanges ranges = rank_ranges(mesh, runs, ranks.count(), block);
  LevelPart made = part_of_level(mesh, element, runs, ranges, ranks.own());
  made.ranks = &ranks, made.ranges = std::move(ranges);
  return made;
}

int ReadVertices::place(int v) const {
  return static_cast<int>(std::ranges::lower_bound(vertex, v) - vertex.begin());
}

ReadVertices read_vertices(const LevelPart& of, std::vector<int> read) {
  Ranks& ranks = *of.ranks;
  std::ranges::sort(read);
  read.erase(std::ranges::unique(read).begin(), read.end());
  std::vector<std::vector<int>> asked(index_of(ranks.count()));
  for (const int v : read) asked[index_of(of.ranges.owner(v))].push_back(v);
  const int first = of.ranges.vertex[index_of(ranks.own())] - of.part.first_owned;
  const auto local = [&](std::vector<int> numbers) {
    for (int& v : numbers) v -= first;
    return numbers;
  };
  ReadVertices made;
  made.own = local(std::exchange(asked[index_of(ranks.own())], {}));
  made.rows.own = static_cast<int>(made.own.size());
  std::vector<Bytes> messages;
  for (const std::vector<int>& numbers : asked) {
    const auto bytes = std::as_bytes(std::span(numbers));
    messages.emplace_back(bytes.begin(), bytes.end());
  }
  const std::vector<Bytes> wanted = ranks.to_all(messages);
  ByRank sent(ranks.count()), received(ranks.count());
  for (int q = 0; q < ranks.count(); ++q) {
    std::vector<int> numbers(wanted[index_of(q)].size() / sizeof(int));
    if (!numbers.empty())
      std::memcpy(numbers.data(), wanted[index_of(q)].data(), numbers.size() * sizeof(int));
    sent.of(q) = local(std::move(numbers)), received.of(q) = asked[index_of(q)];
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
