// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <functional>
#include <limits>
#include <plica/core/grouping.hpp>
#include <plica/drivers/spaces/edge_graph.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <queue>

namespace plica {

namespace {

constexpr double unreached = std::numeric_limits<double>::infinity();

constexpr std::size_t most_waves = 4096;

}  // namespace

WaveQueue::WaveQueue(const EdgeGraph& graph) {
  const double width =
      std::max({graph.mean, 2 * graph.longest / static_cast<double>(most_waves), 1e-300});
  per_metre_ = 1 / width;
  // All waves in the queue at a time: a distance exceeds the last one removed by an edge at most
  std::size_t count = 4;
  while (static_cast<double>(count) < graph.longest / width + 3) count *= 2;
  waves_.resize(count), mask_ = count - 1;
}

namespace {

/// Joins each vertex that follows others to its masters, and marks it.
/// @param edges  edges of the mesh, ascending
void join_followers(const TetMesh& mesh, EdgeGraph& graph, std::vector<std::array<int, 2>>& edges) {
  const Followers& followers = mesh.followers;
  if (followers.vertex.empty()) return;
  graph.follows.resize(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < followers.vertex.size(); ++i) {
    const int v = followers.vertex[i];
    graph.follows[index_of(v)] = 1;
    for (std::size_t c = 0; c < 4; ++c)
      if (followers.weight[i][c] != 0)
        edges.push_back({std::min(v, followers.of[i][c]), std::max(v, followers.of[i][c])});
  }
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

}  // namespace

EdgeGraph edge_graph(const TetMesh& mesh) {
  auto edges = mesh_edges(mesh);
  EdgeGraph graph;
  join_followers(mesh, graph, edges);
  graph.place = mesh.vertices;
  graph.first.assign(mesh.vertices.size() + 1, 0);
  for (const auto& edge : edges)
    for (const int v : edge) ++graph.first[index_of(v) + 1];
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) graph.first[v + 1] += graph.first[v];
  graph.neighbour.resize(2 * edges.size()), graph.length.resize(2 * edges.size());
  std::vector<int> next(graph.first.begin(), graph.first.end() - 1);
  const auto enter = [&](int v, int other, double length) {
    const auto place = index_of(next[index_of(v)]++);
    graph.neighbour[place] = other, graph.length[place] = length;
  };
  // All lower neighbours of each vertex are entered first, then the higher ones: ascending
  const auto length = [&](const auto& edge) {
    return (mesh.vertices[index_of(edge[1])] - mesh.vertices[index_of(edge[0])]).norm();
  };
  for (const auto& edge : edges) enter(edge[1], edge[0], length(edge));
  for (const auto& edge : edges) {
    const double l = length(edge);
    enter(edge[0], edge[1], l);
    graph.mean += l / static_cast<double>(edges.size()), graph.longest = std::max(graph.longest, l);
  }
  return graph;
}

std::vector<int> farthest_points(const EdgeGraph& graph, int count,
                                 const std::vector<char>& apart) {
  std::vector<double> distance(index_of(graph.vertices()), unreached);
  std::vector<std::pair<double, int>> all;
  for (int v = 0; v < graph.vertices(); ++v)
    if (graph.follows.empty() || !graph.follows[index_of(v)]) all.emplace_back(unreached, v);
  // Distances in this queue may be too large: they are compared with `distance` when removed
  std::priority_queue furthest(std::less<>(), std::move(all));
  std::vector<int> points;
  WaveQueue open(graph);
  for (int counted = 0; counted < count && !furthest.empty();) {
    const auto [known, point] = furthest.top();
    furthest.pop();
    const double now = distance[index_of(point)];
    if (now < known) {
      if (now > 0) furthest.emplace(now, point);
      continue;
    }
    points.push_back(point);
    counted += apart.empty() || !apart[index_of(point)];
    distance[index_of(point)] = 0;
    open.start();
    open.put(0, point);
    while (!open.empty()) {
      const auto [d, v] = open.take();
      if (d > distance[index_of(v)]) continue;
      for (int k = graph.first[index_of(v)]; k < graph.first[index_of(v) + 1]; ++k) {
        const int w = graph.neighbour[index_of(k)];
        const double there = d + graph.length[index_of(k)];
        if (there < distance[index_of(w)]) distance[index_of(w)] = there, open.put(there, w);
      }
    }
  }
  return points;
}

namespace {

/// Nearest point of each vertex.
struct Nearest {
  std::vector<double> distance;  ///< along edges [m]
  std::vector<int> owner;        ///< index of the point; -1: no path leads to one
};

Nearest nearest_points(const EdgeGraph& graph, const std::vector<int>& points) {
  Nearest all{std::vector(index_of(graph.vertices()), unreached),
              std::vector(index_of(graph.vertices()), -1)};
  // The nearest vertex is on top. A sorted queue is needed: which of two equally near points a
  // vertex gets depends on the order.
  using Open = std::pair<double, int>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  const auto reach = [&](int v, double distance, int owner) {
    if (!(distance < all.distance[index_of(v)])) return;
    all.distance[index_of(v)] = distance, all.owner[index_of(v)] = owner;
    open.emplace(distance, v);
  };
  for (std::size_t j = 0; j < points.size(); ++j) reach(points[j], 0, static_cast<int>(j));
  while (!open.empty()) {
    const auto [d, v] = open.top();
    open.pop();
    if (d > all.distance[index_of(v)]) continue;
    for (int k = graph.first[index_of(v)]; k < graph.first[index_of(v) + 1]; ++k)
      reach(graph.neighbour[index_of(k)], d + graph.length[index_of(k)], all.owner[index_of(v)]);
  }
  return all;
}

}  // namespace

PointGraph point_graph(const EdgeGraph& graph, const std::vector<int>& points) {
  const Nearest nearest = nearest_points(graph, points);
  const Grouping owned(nearest.owner, points.size());
  PointGraph result;
  EdgeGraph& coarse = result.graph;
  // Shortest path from point `a` to each other point that it meets [m]
  std::vector<double> way(points.size(), unreached);
  std::vector<int> met;
  int connected = 0;
  double sum = 0;
  for (std::size_t a = 0; a < points.size(); ++a) {
    met.clear();
    for (const int v : owned.of(a))
      for (int k = graph.first[index_of(v)]; k < graph.first[index_of(v) + 1]; ++k) {
        const int w = graph.neighbour[index_of(k)], b = nearest.owner[index_of(w)];
        if (b == static_cast<int>(a)) continue;
        if (way[index_of(b)] == unreached) met.push_back(b);
        way[index_of(b)] = std::min(way[index_of(b)], nearest.distance[index_of(v)] +
                                                          nearest.distance[index_of(w)] +
                                                          graph.length[index_of(k)]);
      }
    std::ranges::sort(met);
    double next = unreached;
    for (const int b : met) {
      const double along = std::exchange(way[index_of(b)], unreached);
      next = std::min(next, along);
      coarse.neighbour.push_back(b);
      coarse.length.push_back(graph.distance(points[a], points[index_of(b)], along));
      sum += coarse.length.back(), coarse.longest = std::max(coarse.longest, coarse.length.back());
    }
    if (!met.empty()) result.spacing += next, ++connected;
    coarse.place.push_back(graph.place[index_of(points[a])]);
    coarse.first.push_back(static_cast<int>(coarse.neighbour.size()));
  }
  if (connected > 0)
    result.spacing /= connected, coarse.mean = sum / static_cast<double>(coarse.length.size());
  return result;
}

}  // namespace plica
