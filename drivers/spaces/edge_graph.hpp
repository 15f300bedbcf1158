// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstddef>
#include <plica/core/mesh.hpp>
#include <utility>
#include <vector>

namespace plica {

/// Vertices and edges between them, by rows.
struct EdgeGraph {
  std::vector<Point> place;      ///< of a vertex [m]
  std::vector<int> first{0};     ///< [vertices + 1] into the following
  std::vector<int> neighbour;    ///< of a vertex, ascending
  std::vector<double> length;    ///< of that edge, not below the straight distance [m]
  double mean = 0, longest = 0;  ///< of the lengths [m]

  /// A way along edges over the straight one, at most, where the body fills the space between.
  static constexpr double detour = 1.4;

  int vertices() const { return static_cast<int>(first.size()) - 1; }
  /// The straight distance of two vertices; or a longer one where the way along edges makes more
  /// than a detour. [m]
  /// @param along  the length of this way [m]
  double distance(int v, int w, double along) const {
    return std::max(
        (place[static_cast<std::size_t>(v)] - place[static_cast<std::size_t>(w)]).norm(),
        along / detour);
  }
};

/// The edges of a mesh.
EdgeGraph edge_graph(const TetMesh& mesh);

/// Some vertices of a graph, the points, as a smaller graph. Each owns the vertices that are
/// nearest to it along edges. Where what two of them own meets they are neighbours, and the edge is
/// as long as their distance().
struct PointGraph {
  EdgeGraph graph;     ///< of the points, in their order
  double spacing = 0;  ///< the mean distance along edges from a point to the nearest other one [m]
};

/// @param points  numbers of vertices
PointGraph point_graph(const EdgeGraph& graph, const std::vector<int>& points);

/// Distances along edges and the vertex, about the nearest first: by intervals of distance (Dial
/// 1969). Where all that can shorten a distance is gone through again, distances come out as with a
/// queue that is sorted, in a fraction of its time.
class WaveQueue {
 public:
  /// @param graph  its edges' lengths are what one distance can exceed another by
  explicit WaveQueue(const EdgeGraph& graph);

  bool empty() const { return size_ == 0; }
  /// For distances from 0 on; when it is empty.
  void start() { now_ = 0; }
  /// A distance not below that of the last one that was taken [m].
  void put(double distance, int vertex) {
    waves_[interval(distance) & mask_].emplace_back(distance, vertex);
    ++size_;
  }
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

/// Vertices and their distance along edges from one of them. Its memory serves many walks.
class EdgeWalk {
 public:
  explicit EdgeWalk(const EdgeGraph& graph)
      : graph_(graph), queue_(graph), state_(static_cast<std::size_t>(graph.vertices())) {}

  /// Calls visit(vertex, distance) for all that are not further than `reach` [m], the start
  /// included, in no particular order.
  template <class Visit>
  void from(int start, double reach, const Visit& visit) {
    from(
        start, reach, [](int) { return 0.0; }, visit);
  }

  /// The same where only some vertices matter. The others may be left out, or come with a distance
  /// that is too long.
  /// @param beyond  of a vertex: no way from it to one that matters is shorter [m]
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
    int walk = 0;  // in which it was last reached
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

/// Vertices in the order in which each is the furthest, along edges, from all before it (Gonzalez
/// 1985): any first part of them is spread evenly. Every part of a body that hangs together gets
/// one before any gets its second.
/// @param count        how many; vertices that are `apart` come on top of it
/// @param apart        per vertex; or empty
std::vector<int> farthest_points(const EdgeGraph& graph, int count,
                                 const std::vector<char>& apart = {});

}  // namespace plica
