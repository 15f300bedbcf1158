// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <plica/drivers/solver/spaces/edge_graph.hpp>
#include <plica/drivers/solver/spaces/index_of.hpp>
#include <plica/meshes/mesh_quality.hpp>

namespace plica {

namespace {

constexpr double unreached = std::numeric_limits<double>::infinity();

/// Distances spread along the edges from the open vertices, wherever they shrink there; reached(from, to) for each that does.
template <class Reached>
void spread(const EdgeGraph& graph, DistanceQueue open, std::vector<double>& distance, const Reached& reached) {
  walk_edges(
      graph, open, [&](int v) { return distance[index_of(v)]; }, [](int, double) {},
      [&](int from, int to, double d) {
        distance[index_of(to)] = d;
        reached(from, to);
        return true;
      });
}

}  // namespace

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
  for (const auto& edge : edges) enter(edge[0], edge[1], length(edge));
  return graph;
}

std::vector<int> farthest_points(const EdgeGraph& graph, int count, const std::vector<char>& apart) {
  std::vector<double> distance(index_of(graph.vertices()), unreached);
  std::priority_queue<std::pair<double, int>> furthest;  // distances that may have shrunk since
  for (int v = 0; v < graph.vertices(); ++v) furthest.emplace(unreached, v);
  std::vector<int> points;
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
    DistanceQueue open;
    distance[index_of(point)] = 0;
    open.emplace(0, point);
    spread(graph, std::move(open), distance, [](int, int) {});
  }
  return points;
}

double mean_spacing(const EdgeGraph& graph, const std::vector<int>& points) {
  // All points' neighbourhoods at once: a vertex keeps its nearest point, and where two neighbourhoods meet in an edge the
  // way through it joins their points.
  std::vector<double> distance(index_of(graph.vertices()), unreached), nearest(points.size(), unreached);
  std::vector<int> owner(index_of(graph.vertices()), -1);
  DistanceQueue open;
  for (std::size_t j = 0; j < points.size(); ++j) {
    distance[index_of(points[j])] = 0, owner[index_of(points[j])] = static_cast<int>(j);
    open.emplace(0, points[j]);
  }
  spread(graph, std::move(open), distance, [&](int from, int to) { owner[index_of(to)] = owner[index_of(from)]; });
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
