// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstring>
#include <plica/core/mesh.hpp>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/level/part_of_level.hpp>
#include <span>
#include <vector>

// Lists of what ranks have of a mesh, and of what they send to each other.
namespace plica {

/// Returns the range that has a number, of ranges that begin at these numbers.
inline int owner_in(const std::vector<int>& first, int number) {
  return static_cast<int>(std::ranges::upper_bound(first, number) - first.begin()) - 1;
}

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

/// Sends numbers to each rank, and returns those that each sent to this one. All ranks call this.
inline std::vector<std::vector<int>> exchange_numbers(Ranks& ranks,
                                                      const std::vector<std::vector<int>>& sent) {
  std::vector<Bytes> messages;
  for (const std::vector<int>& numbers : sent) {
    const auto bytes = std::as_bytes(std::span(numbers));
    messages.emplace_back(bytes.begin(), bytes.end());
  }
  std::vector<std::vector<int>> received;
  for (const Bytes& one : ranks.to_all(messages)) {
    received.emplace_back(one.size() / sizeof(int));
    if (!one.empty()) std::memcpy(received.back().data(), one.data(), one.size());
  }
  return received;
}

/// Returns the values that each rank has, on all of them. All ranks call this.
template <class T>
std::vector<std::vector<T>> values_of_all(Ranks& ranks, const std::vector<T>& own) {
  std::vector<std::vector<T>> all;
  for (const Bytes& one : ranks.gather(std::as_bytes(std::span(own)))) {
    all.emplace_back(one.size() / sizeof(T));
    if (!one.empty()) std::memcpy(all.back().data(), one.data(), one.size());
  }
  return all;
}

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

/// Returns the rows of vertices that a rank exchanges: it receives all that it has and does not
/// own.
/// @param sent  local vertices that other ranks receive, in any order and more than once
inline HaloRows rows_of_vertices(ByRank sent, const RankPart& part, int own, int ranks) {
  ByRank received(ranks);
  for (std::size_t i = 0; i < part.vertex.size(); ++i)
    if (part.owner[i] != own) received.add(part.owner[i], static_cast<int>(i));
  for (int q = 0; q < ranks; ++q) {
    std::vector<int>& its = sent.of(q);
    std::ranges::sort(its);
    its.erase(std::ranges::unique(its).begin(), its.end());
  }
  HaloRows rows = ByRank::halo(sent, received);
  rows.before = part.first_owned, rows.own = part.owned();
  return rows;
}

/// Returns some tetrahedra of a mesh, with a part's vertices and their local numbers.
inline TetMesh mesh_of_part(const TetMesh& mesh, const RankPart& part, const std::vector<int>& tets,
                            const LocalNumbers& local) {
  TetMesh own;
  own.vertices = part.local(mesh.vertices);
  own.region_names = mesh.region_names;
  for (const int e : tets) {
    auto& corners = own.tets.emplace_back(mesh.tets[index_of(e)]);
    for (int& v : corners) v = local(v);
    if (!mesh.region.empty()) own.region.push_back(mesh.region[index_of(e)]);
    if (!mesh.filled.empty()) own.filled.push_back(mesh.filled[index_of(e)]);
  }
  return own;
}

}  // namespace plica
