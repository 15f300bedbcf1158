// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <functional>
#include <limits>
#include <plica/drivers/solver/spaces/edge_graph.hpp>
#include <plica/drivers/solver/spaces/row_ranges.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <queue>

namespace plica {

namespace {

constexpr double unreached = std::numeric_limits<double>::infinity();

constexpr std::size_t most_waves = 4096;

}  // namespace

WaveQueue::WaveQueue(const EdgeGraph& graph) {
  const double width = std::max({graph.mean, 2 * graph.longest / static_cast<double>(most_waves), 1e-300});
  per_metre_ = 1 / width;
  std::size_t count = 4;  // a distance exceeds the last one taken by an edge at most
  while (static_cast<double>(count) < graph.longest / width + 3) count *= 2;
  waves_.resize(count), mask_ = count - 1;
}

EdgeGraph edge_graph(const TetMesh& mesh) {
  const auto edges = mesh_edges(mesh);
  EdgeGraph graph;
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
  // first all lower neighbours of each vertex, then the higher ones: ascending
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

std::vector<int> farthest_points(const EdgeGraph& graph, int count, const std::vector<char>& apart) {
  std::vector<double> distance(index_of(graph.vertices()), unreached);
  std::vector<std::pair<double, int>> all;
  for (int v = 0; v < graph.vertices(); ++v) all.emplace_back(unreached, v);
  std::priority_queue furthest(std::less<>(), std::move(all));  // distances that may have shrunk since
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

double mean_spacing(const EdgeGraph& graph, const std::vector<int>& points) {
  // All points' neighbourhoods at once: a vertex keeps its nearest point, and where two neighbourhoods meet in an edge the
  // way through it joins their points.
  std::vector<double> distance(index_of(graph.vertices()), unreached), nearest(points.size(), unreached);
  std::vector<int> owner(index_of(graph.vertices()), -1);
  // the nearest on top: of two points as near, which one a vertex goes to depends on the order
  using Open = std::pair<double, int>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  for (std::size_t j = 0; j < points.size(); ++j) {
    distance[index_of(points[j])] = 0, owner[index_of(points[j])] = static_cast<int>(j);
    open.emplace(0, points[j]);
  }
  while (!open.empty()) {
    const auto [d, v] = open.top();
    open.pop();
    if (d > distance[index_of(v)]) continue;
    for (int k = graph.first[index_of(v)]; k < graph.first[index_of(v) + 1]; ++k) {
      const int w = graph.neighbour[index_of(k)];
      const double there = d + graph.length[index_of(k)];
      if (!(there < distance[index_of(w)])) continue;
      distance[index_of(w)] = there, owner[index_of(w)] = owner[index_of(v)];
      open.emplace(there, w);
    }
  }
  for (int v = 0; v < graph.vertices(); ++v)
    for (int k = graph.first[index_of(v)]; k < graph.first[index_of(v) + 1]; ++k) {
      const int w = graph.neighbour[index_of(k)], a = owner[index_of(v)], b = owner[index_of(w)];
      if (a < 0 || b < 0 || a == b) continue;
      const double way = distance[index_of(v)] + graph.length[index_of(k)] + distance[index_of(w)];
      nearest[index_of(a)] = std::min(nearest[index_of(a)], way);
    }
  double sum = 0;
  int known = 0;
  for (const double d : nearest)
    if (d < unreached) sum += d, ++known;
  return known > 0 ? sum / known : 0;
}

}  // namespace plica
