// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/body/embed_free.hpp>

namespace plica {

namespace {

/// Returns the tetrahedra of a mesh that have no follower, on the vertices of the mesh.
/// @param follower  [vertices] number among the followers; -1: it follows none
TetMesh free_tets(const TetMesh& mesh, const std::vector<int>& follower) {
  TetMesh free;
  free.vertices = mesh.vertices, free.region_names = mesh.region_names;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    if (std::ranges::any_of(mesh.tets[e], [&](int v) { return follower[index_of(v)] >= 0; }))
      continue;
    free.tets.push_back(mesh.tets[e]);
    if (!mesh.region.empty()) free.region.push_back(mesh.region[e]);
    if (!mesh.piece.empty()) free.piece.push_back(mesh.piece[e]);
  }
  return free;
}

}  // namespace

Embedding embed_free(const TetMesh& mesh, const std::vector<BodyPart>& parts,
                     const BodyLocator& locator, const std::vector<Point>& points,
                     const std::vector<int>& part) {
  constexpr double on_vertex = 1e-9;  // largest other weight of a point on a vertex
  Embedding all = locator.embed(points, part, Outside::extrapolate);
  const Followers& followers = mesh.followers;
  if (followers.vertex.empty()) return all;
  std::vector<int> follower(mesh.vertices.size(), -1);
  for (std::size_t i = 0; i < followers.vertex.size(); ++i)
    follower[index_of(followers.vertex[i])] = static_cast<int>(i);
  std::vector<std::size_t> left;
  for (std::size_t p = 0; p < points.size(); ++p) {
    int own = -1, others = 0;  // follower whose place the point has; vertices that have a weight
    bool follows = false;
    for (std::size_t c = 0; c < 4; ++c) {
      if (std::abs(all.weights[p][c]) <= on_vertex) continue;
      const int i = follower[index_of(all.vertices[p][c])];
      ++others, follows = follows || i >= 0, own = i;
    }
    if (follows && others == 1)
      all.vertices[p] = followers.of[index_of(own)],
      all.weights[p] = followers.weight[index_of(own)];
    else if (follows)
      left.push_back(p);
  }
  if (left.empty()) return all;
  std::vector<Point> place;
  std::vector<int> body;
  for (const std::size_t p : left) {
    place.push_back(points[p]);
    if (!part.empty()) body.push_back(part[p]);
  }
  const TetMesh free = free_tets(mesh, follower);
  const Embedding beside = BodyLocator(free, parts).embed(place, body, Outside::extrapolate);
  for (std::size_t i = 0; i < left.size(); ++i)
    all.vertices[left[i]] = beside.vertices[i], all.weights[left[i]] = beside.weights[i];
  return all;
}

}  // namespace plica
