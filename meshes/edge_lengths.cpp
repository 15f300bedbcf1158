// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/edge_lengths.hpp>
#include <utility>

namespace plica {

namespace {

constexpr std::array<std::array<std::size_t, 2>, 6> corner_pairs = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

double length(const TetMesh& mesh, int a, int b) {
  return (mesh.vertices[static_cast<std::size_t>(b)] - mesh.vertices[static_cast<std::size_t>(a)]).norm();
}

// Sorted by the lower vertex by counting, then within each vertex: several times faster than one sort of all
template <std::size_t corners>
std::vector<std::array<int, 2>> edges_of(const std::vector<std::array<int, corners>>& cells, std::size_t vertices) {
  std::vector<std::size_t> start(vertices + 1, 0);
  const auto for_each = [&](auto visit) {
    for (const auto& cell : cells)
      for (std::size_t i = 0; i < corners; ++i)
        for (std::size_t j = i + 1; j < corners; ++j) visit(std::min(cell[i], cell[j]), std::max(cell[i], cell[j]));
  };
  for_each([&](int low, int) { ++start[static_cast<std::size_t>(low) + 1]; });
  for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
  std::vector<int> highs(start.back());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for_each([&](int low, int high) { highs[next[static_cast<std::size_t>(low)]++] = high; });

  std::vector<std::array<int, 2>> edges;
  edges.reserve(highs.size() / 4);
  for (std::size_t v = 0; v + 1 < start.size(); ++v) {
    const auto first = highs.begin() + static_cast<std::ptrdiff_t>(start[v]);
    const auto last = highs.begin() + static_cast<std::ptrdiff_t>(start[v + 1]);
    std::sort(first, last);
    std::for_each(first, std::unique(first, last), [&](int high) { edges.push_back({static_cast<int>(v), high}); });
  }
  return edges;
}

}  // namespace

std::vector<std::array<int, 2>> mesh_edges(const TetMesh& mesh) { return edges_of(mesh.tets, mesh.vertices.size()); }

std::vector<std::array<int, 2>> mesh_edges(const TriangleSurface& surface) {
  return edges_of(surface.triangles, surface.vertices.size());
}

std::vector<double> local_edge_lengths(const TetMesh& mesh) {
  std::vector<double> sums(mesh.vertices.size(), 0.0);
  std::vector<int> counts(mesh.vertices.size(), 0);
  for (const auto& edge : mesh_edges(mesh)) {
    const double l = length(mesh, edge[0], edge[1]);
    for (const int v : edge) sums[static_cast<std::size_t>(v)] += l, ++counts[static_cast<std::size_t>(v)];
  }
  for (std::size_t v = 0; v < sums.size(); ++v) sums[v] /= std::max(1, counts[v]);
  return sums;
}

double mean_edge_length(const TetMesh& mesh) {
  const auto edges = mesh_edges(mesh);
  double sum = 0.0;
  for (const auto& [a, b] : edges) sum += length(mesh, a, b);
  return edges.empty() ? 0.0 : sum / static_cast<double>(edges.size());
}

double mean_edge_length(const TetMesh& mesh, int tet) {
  const auto& v = mesh.tets[static_cast<std::size_t>(tet)];
  double sum = 0.0;
  for (const auto& [i, j] : corner_pairs) sum += length(mesh, v[i], v[j]);
  return sum / 6.0;
}

}  // namespace plica
