// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <limits>
#include <plica/core/mesh.hpp>
#include <queue>
#include <utility>
#include <vector>

namespace plica {

/// A mesh's vertices and edges, by rows.
struct EdgeGraph {
  std::vector<int> first{0};   ///< [vertices + 1] into the others
  std::vector<int> neighbour;  ///< of a vertex, ascending
  std::vector<double> length;  ///< of that edge [m]

  int vertices() const { return static_cast<int>(first.size()) - 1; }
};

EdgeGraph edge_graph(const TetMesh& mesh);

/// Distances along edges, and the vertex: the nearest on top.
using DistanceQueue = std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>>;

/// Goes along the edges from the open vertices, the nearest first (Dijkstra 1959). visit(vertex, distance) once for each vertex whose
/// distance known(vertex) is final; reach(from, to, distance) keeps a distance that is shorter than what is known, or says no.
template <class Known, class Visit, class Reach>
void walk_edges(const EdgeGraph& graph, DistanceQueue& open, const Known& known, const Visit& visit,
                const Reach& reach) {
  while (!open.empty()) {
    const auto [d, v] = open.top();
    open.pop();
    if (d > known(v)) continue;
    visit(v, d);
    for (int k = graph.first[static_cast<std::size_t>(v)]; k < graph.first[static_cast<std::size_t>(v) + 1]; ++k) {
      const int w = graph.neighbour[static_cast<std::size_t>(k)];
      const double there = d + graph.length[static_cast<std::size_t>(k)];
      if (there < known(w) && reach(v, w, there)) open.emplace(there, w);
    }
  }
}

/// Vertices in the order of their distance along edges from one of them. Its memory serves many walks.
class EdgeWalk {
 public:
  explicit EdgeWalk(const EdgeGraph& graph)
      : graph_(graph), distance_(static_cast<std::size_t>(graph.vertices())), walk_(distance_.size(), 0) {}

  /// Calls visit(vertex, distance) for all that are not further than `reach` [m], the start included.
  template <class Visit>
  void from(int start, double reach, const Visit& visit) {
    ++now_;
    DistanceQueue open;
    open.emplace(0, start);
    keep(start, 0);
    const auto known = [&](int v) {
      const auto at = static_cast<std::size_t>(v);
      return walk_[at] == now_ ? distance_[at] : std::numeric_limits<double>::infinity();
    };
    walk_edges(graph_, open, known, visit, [&](int, int v, double d) {
      if (d > reach) return false;
      keep(v, d);
      return true;
    });
  }

 private:
  const EdgeGraph& graph_;
  std::vector<double> distance_;
  std::vector<int> walk_;
  int now_ = 0;

  void keep(int v, double d) { walk_[static_cast<std::size_t>(v)] = now_, distance_[static_cast<std::size_t>(v)] = d; }
};

/// Vertices in the order in which each is the furthest, along edges, from all before it (Gonzalez 1985): any first part of
/// them is spread evenly. Every part of a body that hangs together gets one before any gets its second.
/// @param count        how many; vertices that are `apart` come on top of it
/// @param apart        per vertex; or empty
std::vector<int> farthest_points(const EdgeGraph& graph, int count, const std::vector<char>& apart = {});

/// The mean distance along edges from each of these vertices to the nearest other one [m].
double mean_spacing(const EdgeGraph& graph, const std::vector<int>& points);

}  // namespace plica
