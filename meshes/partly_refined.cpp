// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <plica/core/row_ranges.hpp>
#include <plica/meshes/partly_refined.hpp>
#include <plica/meshes/refinement.hpp>
#include <set>

namespace plica {

namespace {

// Vertices of some tetrahedra of a mesh
std::vector<char> vertices_of_tets(const TetMesh& mesh, const std::vector<int>& tets) {
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const int t : tets)
    for (const int v : mesh.tets[index_of(t)]) used[index_of(v)] = 1;
  return used;
}

void add_at_vertices(const std::vector<char>& used, std::vector<Ends>& ends) {
  for (int v = 0; v < static_cast<int>(used.size()); ++v)
    if (used[index_of(v)] != 0) ends.push_back({v, v});
}

}  // namespace

Composite partly_refined(const TetMesh& mesh, const std::vector<int>& tets) {
  if (tets.empty()) return {.mesh = mesh};
  if (tets.size() == mesh.tets.size()) return {.mesh = refined(mesh)};
  return compose(refined(cut_out(whole_mesh(mesh), tets)), mesh);
}

// The order is that of cut_out(), refined() and compose(): vertices of the tetrahedra that are cut,
// ascending; middles of their edges, in the order in which they use them; vertices of the others
std::vector<Ends> ends_of_vertices(const TetMesh& mesh, const std::vector<int>& tets) {
  std::vector<Ends> ends;
  add_at_vertices(vertices_of_tets(mesh, tets), ends);
  std::set<Ends> known;
  for (const int t : tets)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) {
        const auto [a, b] = std::minmax(mesh.tets[index_of(t)][i], mesh.tets[index_of(t)][j]);
        if (known.insert({a, b}).second) ends.push_back({a, b});
      }
  std::vector<int> others;
  for (int t = 0, next = 0; t < static_cast<int>(mesh.tets.size()); ++t)
    if (next < static_cast<int>(tets.size()) && tets[index_of(next)] == t)
      ++next;
    else
      others.push_back(t);
  add_at_vertices(vertices_of_tets(mesh, others), ends);
  return ends;
}

std::vector<Point> values_at_vertices(const std::vector<Ends>& ends,
                                      const std::vector<Point>& values, std::size_t vertices) {
  std::vector<Point> own(vertices, Point::Zero());
  for (std::size_t v = 0; v < ends.size(); ++v)
    if (ends[v][0] == ends[v][1]) own[index_of(ends[v][0])] = values[v];
  return own;
}

std::vector<Point> carried_values(const std::vector<Ends>& from, const std::vector<Point>& values,
                                  const std::vector<Ends>& to, std::size_t vertices) {
  const std::vector<Point> own = values_at_vertices(from, values, vertices);
  std::map<Ends, std::size_t> middles;
  for (std::size_t v = 0; v < from.size(); ++v)
    if (from[v][0] != from[v][1]) middles.emplace(from[v], v);
  std::vector<Point> carried;
  carried.reserve(to.size());
  for (const Ends& at : to) {
    const auto known = middles.find(at);
    carried.push_back(known == middles.end() ? (own[index_of(at[0])] + own[index_of(at[1])]) / 2
                                             : values[known->second]);
  }
  return carried;
}

std::vector<int> tets_within(const std::vector<std::array<int, 4>>& tets,
                             const std::vector<Point>& places, const Point& centre, double radius) {
  std::vector<int> within;
  for (std::size_t t = 0; t < tets.size(); ++t) {
    Point sum = Point::Zero();
    for (const int v : tets[t]) sum += places[index_of(v)];
    if ((sum / 4 - centre).norm() <= radius) within.push_back(static_cast<int>(t));
  }
  return within;
}

}  // namespace plica
