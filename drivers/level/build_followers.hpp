// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <array>
#include <plica/core/grouping.hpp>
#include <plica/core/mesh.hpp>
#include <plica/core/model.hpp>
#include <plica/meshes/composite.hpp>
#include <utility>
#include <vector>

namespace plica {

/// One follower of a master, and the weight that the master has in it.
struct Follows {
  int follower;
  double weight;
};

/// Returns for each of a mesh's vertices the vertices that follow it, ascending.
inline std::vector<std::vector<Follows>> followers_of_vertices(const Followers& followers,
                                                               std::size_t vertices) {
  std::vector<std::vector<Follows>> of(vertices);
  for (std::size_t i = 0; i < followers.vertex.size(); ++i)
    for (std::size_t c = 0; c < 4; ++c)
      if (const double w = followers.weight[i][c]; w != 0)
        of[index_of(followers.of[i][c])].push_back({followers.vertex[i], w});
  for (std::vector<Follows>& one : of) std::ranges::sort(one, {}, &Follows::follower);
  return of;
}

/// Returns a mesh's followers for kernels; no arrays where there are none.
template <class B>
FollowingVertices<B> following_vertices(const TetMesh& mesh) {
  using Real = typename B::Real;
  FollowingVertices<B> made;
  const Followers& all = mesh.followers;
  if (all.vertex.empty()) return made;
  std::vector<std::array<int, 4>> source = all.of;
  std::vector<std::array<Real, 4>> weight;
  for (std::size_t i = 0; i < source.size(); ++i) {
    std::array<double, 4> w = all.weight[i];
    // weighted_sum() reads the greatest vertex last
    const auto greatest = std::ranges::max_element(source[i]) - source[i].begin();
    std::swap(source[i][static_cast<std::size_t>(greatest)], source[i][3]);
    std::swap(w[static_cast<std::size_t>(greatest)], w[3]);
    weight.push_back({static_cast<Real>(w[0]), static_cast<Real>(w[1]), static_cast<Real>(w[2]),
                      static_cast<Real>(w[3])});
  }
  made.place.rows = static_cast<int>(all.vertex.size());
  made.place.target = to_device<Indices<B>>("followers.target", all.vertex);
  made.place.source = to_device<decltype(made.place.source)>("followers.source", source);
  made.place.weight = to_device<decltype(made.place.weight)>("followers.weight", weight);

  std::vector<int> master, first{0}, follower;
  std::vector<Real> part;
  const auto of = followers_of_vertices(all, mesh.vertices.size());
  for (std::size_t a = 0; a < of.size(); ++a) {
    if (of[a].empty()) continue;
    master.push_back(static_cast<int>(a));
    for (const Follows& one : of[a])
      follower.push_back(one.follower), part.push_back(static_cast<Real>(one.weight));
    first.push_back(static_cast<int>(follower.size()));
  }
  made.masters = static_cast<int>(master.size());
  made.master = to_device<Indices<B>>("followers.master", master);
  made.first = to_device<Indices<B>>("followers.first", first);
  made.follower = to_device<Indices<B>>("followers.follower", follower);
  made.weight = to_device<Scalars<B>>("followers.part", part);
  return made;
}

/// Returns the shares of vertices some of which follow others: followers have none, and a master
/// has those of its followers behind its own, each with the master's weight. A mesh without
/// followers keeps its shares.
template <class B>
VertexShares<B> with_followers(const VertexShares<B>& own, const TetMesh& mesh) {
  if (mesh.followers.vertex.empty()) return own;
  const auto old_first = on_host(own.first), old_row = on_host(own.row);
  const std::size_t n = mesh.vertices.size();
  const std::vector<char> follows = follows_others(mesh);
  const auto of = followers_of_vertices(mesh.followers, n);
  std::vector<int> first{0}, row;
  std::vector<typename B::Real> weight;
  const auto add = [&](int vertex, double w) {
    for (int s = old_first(vertex); s < old_first(vertex + 1); ++s)
      row.push_back(old_row(s)), weight.push_back(static_cast<typename B::Real>(w));
  };
  for (std::size_t a = 0; a < n; ++a) {
    if (!follows[a]) add(static_cast<int>(a), 1);
    for (const Follows& one : of[a]) add(one.follower, one.weight);
    first.push_back(static_cast<int>(row.size()));
  }
  return {own.rows, to_device<Indices<B>>("shares.first", first),
          to_device<Indices<B>>("shares.row", row), to_device<Scalars<B>>("shares.weight", weight)};
}

}  // namespace plica
