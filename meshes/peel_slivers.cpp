// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/improve_shapes.hpp>
#include <plica/meshes/peel_slivers.hpp>

namespace plica {

namespace {

constexpr double thin = 20;  // height ratio
constexpr int most_rounds = 10;

using Edge = std::array<int, 2>;

Edge edge(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

std::array<int, 3> sorted(std::array<int, 3> face) {
  std::sort(face.begin(), face.end());
  return face;
}

class Peeler {
 public:
  explicit Peeler(const TetMesh& mesh) : mesh_(mesh), touched_(mesh.vertices.size(), false) {
    for (const auto& triangle : boundary_triangles(mesh)) {
      faces_.push_back(sorted(triangle));
      for (std::size_t k = 0; k < 3; ++k) edges_.push_back(edge(triangle[k], triangle[(k + 1) % 3]));
    }
    std::sort(faces_.begin(), faces_.end()), std::sort(edges_.begin(), edges_.end());
  }

  // Neighbours wait for the next round, which sees what this one does
  bool peels(const std::array<int, 4>& tet) {
    if (!(height_ratio(mesh_, tet) > thin)) return false;
    std::vector<int> ends;  // corners across from faces of the boundary
    for (std::size_t k = 0; k < 4; ++k) {
      const std::array<int, 3> face = sorted({tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]});
      if (std::binary_search(faces_.begin(), faces_.end(), face)) ends.push_back(tet[k]);
    }
    if (ends.size() != 2 || std::binary_search(edges_.begin(), edges_.end(), edge(ends[0], ends[1]))) return false;
    for (const int v : tet)
      if (touched_[static_cast<std::size_t>(v)]) return false;
    for (const int v : tet) touched_[static_cast<std::size_t>(v)] = true;
    return true;
  }

 private:
  const TetMesh& mesh_;
  std::vector<std::array<int, 3>> faces_;
  std::vector<Edge> edges_;
  std::vector<char> touched_;
};

}  // namespace

int peel_slivers(TetMesh& mesh, std::vector<int>& numbers) {
  const std::size_t before = mesh.tets.size();
  for (int round = 0; round < most_rounds; ++round) {
    Peeler peeler(mesh);
    std::size_t kept = 0;
    const std::size_t count = mesh.tets.size();
    for (std::size_t t = 0; t < count; ++t) {
      if (peeler.peels(mesh.tets[t])) continue;
      mesh.tets[kept] = mesh.tets[t], numbers[kept] = numbers[t];
      if (!mesh.region.empty()) mesh.region[kept] = mesh.region[t];
      for (auto& [name, vectors] : mesh.tet_vectors) vectors[kept] = vectors[t];
      ++kept;
    }
    mesh.tets.resize(kept), numbers.resize(kept);
    if (!mesh.region.empty()) mesh.region.resize(kept);
    for (auto& [name, vectors] : mesh.tet_vectors) vectors.resize(kept);
    if (kept == count) break;
  }
  return static_cast<int>(before - mesh.tets.size());
}

}  // namespace plica
