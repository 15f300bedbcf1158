// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/composite.hpp>
#include <plica/meshes/refinement.hpp>

namespace plica {

namespace {

constexpr const char* skin_set = "plica:skin";  // name of the skin's triangles while they are cut

template <class Value>
std::vector<Value> picked(const std::vector<Value>& values, const std::vector<int>& chosen) {
  std::vector<Value> some;
  if (values.empty()) return some;
  for (const int i : chosen) some.push_back(values[static_cast<std::size_t>(i)]);
  return some;
}

template <std::size_t N>
std::array<int, N> renumbered_corners(std::array<int, N> corners, const std::vector<int>& number) {
  for (int& v : corners) v = number[static_cast<std::size_t>(v)];
  return corners;
}

// Returns the triangles whose vertices are all left, with their new numbers
std::vector<std::array<int, 3>> triangles_left(const std::vector<std::array<int, 3>>& triangles,
                                               const std::vector<int>& number) {
  std::vector<std::array<int, 3>> left;
  for (const auto& triangle : triangles)
    if (const auto now = renumbered_corners(triangle, number); std::ranges::min(now) >= 0)
      left.push_back(now);
  return left;
}

}  // namespace

std::vector<std::array<int, 3>> sorted_triangles(std::vector<std::array<int, 3>> triangles) {
  for (auto& triangle : triangles) std::ranges::sort(triangle);
  std::ranges::sort(triangles);
  return triangles;
}

PartMesh cut_out(const PartMesh& of, const std::vector<int>& tets) {
  const TetMesh& all = of.mesh;
  std::vector<int> number(all.vertices.size(), -1);
  for (const int t : tets)
    for (const int v : all.tets[static_cast<std::size_t>(t)])
      number[static_cast<std::size_t>(v)] = 0;
  PartMesh part;
  TetMesh& mesh = part.mesh;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(all.vertices[v]);
  }
  for (const auto& tet : picked(all.tets, tets))
    mesh.tets.push_back(renumbered_corners(tet, number));
  mesh.region = picked(all.region, tets), mesh.region_names = all.region_names;
  mesh.filled = picked(all.filled, tets);
  for (const auto& [name, vectors] : all.tet_vectors)
    mesh.tet_vectors[name] = picked(vectors, tets);
  for (const auto& [name, set] : all.vertex_sets) {
    std::vector<int> left = picked(number, set);
    std::erase(left, -1);
    if (!left.empty()) mesh.vertex_sets[name] = std::move(left);
  }
  for (const auto& [name, set] : all.triangle_sets)
    if (auto left = triangles_left(set, number); !left.empty())
      mesh.triangle_sets[name] = std::move(left);
  if (!of.skin) return part;
  const auto skin = sorted_triangles(triangles_left(*of.skin, number));
  part.skin.emplace();
  for (const auto& triangle : boundary_triangles(mesh)) {
    auto key = triangle;
    std::ranges::sort(key);
    if (std::ranges::binary_search(skin, key)) part.skin->push_back(triangle);
  }
  return part;
}

PartMesh whole_mesh(const TetMesh& mesh) { return {mesh, boundary_triangles(mesh)}; }

PartMesh refined(const PartMesh& part) {
  TetMesh mesh = part.mesh;
  if (part.skin) mesh.triangle_sets[skin_set] = *part.skin;
  PartMesh finer{refined(mesh)};
  if (part.skin) {
    finer.skin = std::move(finer.mesh.triangle_sets.at(skin_set));
    finer.mesh.triangle_sets.erase(skin_set);
  }
  return finer;
}

std::vector<char> follows_others(const TetMesh& mesh) {
  std::vector<char> follows;
  if (mesh.followers.vertex.empty()) return follows;
  follows.assign(mesh.vertices.size(), 0);
  for (const int v : mesh.followers.vertex) follows[static_cast<std::size_t>(v)] = 1;
  return follows;
}

}  // namespace plica
