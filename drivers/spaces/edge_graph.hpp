// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstddef>
#include <plica/core/mesh.hpp>
#include <utility>
#include <vector>

namespace plica {

/// Graph of vertices and the edges between them, by rows.
struct EdgeGraph {
  std::vector<Point> place;      ///< position of each vertex [m]
  std::vector<int> first{0};     ///< [vertices + 1] start of each row in `neighbour` and `length`
  std::vector<int> neighbour;    ///< neighbours of each vertex, ascending
  std::vector<double> length;    ///< edge lengths, not below the straight distance [m]
  double mean = 0, longest = 0;  ///< mean and maximum of the edge lengths [m]
  /// per vertex 1 where it follows others: paths lead over it, but it is no point. Empty: none does
  std::vector<char> follows = {};

  /// Maximum ratio of a path along edges to the straight distance where the body fills the space
  /// between.
  static constexpr double detour = 1.4;

  /// Returns the number of vertices.
  int vertices() const { return static_cast<int>(first.size()) - 1; }
  /// Returns the distance of two vertices: max(straight distance, along / detour) [m]. It is longer
  /// than the straight distance where the path goes around a gap in the body.
  /// @param along  length of the path along edges [m]
  double distance(int v, int w, double along) const {
    return std::max(
        (place[static_cast<std::size_t>(v)] - place[static_cast<std::size_t>(w)]).norm(),
        along / detour);
  }
};

/// Returns the graph of the edges of a mesh. Vertices that follow others have edges to their
/// masters, which join the pieces of the mesh.
EdgeGraph edge_graph(const TetMesh& mesh);

/// Graph of some vertices, the points, of a larger graph. Each point owns the vertices that are
/// nearest to it along edges. Two points are neighbours if an edge connects the vertices that they
/// own. The length of the edge between the points is their EdgeGraph::distance().
struct PointGraph {
  EdgeGraph graph;     ///< graph of the points, in the order given
  double spacing = 0;  ///< mean distance along edges from a point to the nearest other one [m]
};

/// Builds the graph of some points of a graph.
/// @param points  vertex numbers of the points
PointGraph point_graph(const EdgeGraph& graph, const std::vector<int>& points);

/// Priority queue of vertices by distance along edges, sorted into intervals of distance (Dial
/// 1969). Within an interval the order is arbitrary. A shortest-path search that visits a vertex
/// again when its distance shrinks finds the same distances as with a sorted queue, in a fraction
/// of the time.
class WaveQueue {
 public:
  /// Chooses the intervals for the edge lengths of a graph.
  /// @param graph  a distance exceeds the last one that was removed by one of its edges at most
  explicit WaveQueue(const EdgeGraph& graph);

  /// Returns whether the queue is empty.
  bool empty() const { return size_ == 0; }
  /// Starts again at distance 0; the queue must be empty.
  void start() { now_ = 0; }
  /// Adds a vertex.
  /// @param distance  not below that of the last vertex that was removed [m]
  void put(double distance, int vertex) {
    waves_[interval(distance) & mask_].emplace_back(distance, vertex);
    ++size_;
  }
  /// Removes and returns a distance [m] and vertex from the first interval that has one.
  std::pair<double, int> take() {
    while (waves_[now_ & mask_].empty()) ++now_;
    const std::pair<double, int> nearest = waves_[now_ & mask_].back();
    waves_[now_ & mask_].pop_back();
    --size_;
    return nearest;
  }

 private:
  std::vector<std::vector<std::pair<double, int>>> waves_;
  std::size_t mask_ = 0, now_ = 0, size_ = 0;
  double per_metre_ = 1;

  std::size_t interval(double distance) const {
    return static_cast<std::size_t>(distance * per_metre_);
  }
};

/// Search for vertices by their distance along edges from one of them. The memory is reused by all
/// searches of an object.
class EdgeWalk {
 public:
  /// Keeps a reference to `graph`, which must outlive this.
  explicit EdgeWalk(const EdgeGraph& graph)
      : graph_(graph), queue_(graph), state_(static_cast<std::size_t>(graph.vertices())) {}

  /// Calls visit(vertex, distance) for all vertices within `reach` [m], the start included, in no
  /// particular order.
  template <class Visit>
  void from(int start, double reach, const Visit& visit) {
    from(
        start, reach, [](int) { return 0.0; }, visit);
  }

  /// Calls visit(vertex, distance) within `reach` [m] for a search where only some vertices matter.
  /// The other vertices may be left out, or get a distance that is too long.
  /// @param beyond  beyond(vertex): lower bound of the distance from it to a vertex that matters
  /// [m]
  template <class Beyond, class Visit>
  void from(int start, double reach, const Beyond& beyond, const Visit& visit) {
    ++now_;
    reached_.clear();
    queue_.start();
    keep(start, 0);
    const double most = (1 + 1e-9) * reach;
    while (!queue_.empty()) {
      const auto [d, v] = queue_.take();
      if (d > state_[static_cast<std::size_t>(v)].distance || d + beyond(v) > most) continue;
      for (int k = graph_.first[static_cast<std::size_t>(v)];
           k < graph_.first[static_cast<std::size_t>(v) + 1]; ++k) {
        const double there = d + graph_.length[static_cast<std::size_t>(k)];
        if (there <= reach) keep(graph_.neighbour[static_cast<std::size_t>(k)], there);
      }
    }
    for (const int v : reached_) visit(v, state_[static_cast<std::size_t>(v)].distance);
  }

 private:
  struct State {
    double distance = 0;
    int walk = 0;  // number of the last walk that reached the vertex
  };
  const EdgeGraph& graph_;
  WaveQueue queue_;
  std::vector<State> state_;
  std::vector<int> reached_;
  int now_ = 0;

  void keep(int v, double d) {
    State& there = state_[static_cast<std::size_t>(v)];
    if (there.walk != now_)
      reached_.push_back(v);
    else if (!(d < there.distance))
      return;
    there = {d, now_};
    queue_.put(d, v);
  }
};

/// Returns vertices in an order in which each is the furthest, along edges, from all before it
/// (Gonzalez 1985). The first n of them are therefore spread evenly for any n. Every connected part
/// of a body gets one vertex before any part gets a second one. Vertices that follow others are
/// left out.
/// @param count  number of vertices to return, not counting those that are `apart`
/// @param apart  per vertex nonzero if it may be chosen but is not counted; or empty
std::vector<int> farthest_points(const EdgeGraph& graph, int count,
                                 const std::vector<char>& apart = {});

}  // namespace plica
