// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <plica/meshes/connectivity.hpp>
#include <unsupported/Eigen/BVH>

namespace plica {

namespace {

using Volume = Eigen::AlignedBox3d;

// The lowest vertex known to be of the same part, paths halved on the way
int root(std::vector<int>& parent, int v) {
  const auto at = [&](int i) -> int& { return parent[static_cast<std::size_t>(i)]; };
  while (at(v) != v) v = at(v) = at(at(v));
  return v;
}

template <std::size_t corners>
int count_parts(std::size_t vertices, const std::vector<std::array<int, corners>>& elements) {
  std::vector<int> parent(vertices);
  std::iota(parent.begin(), parent.end(), 0);
  for (const auto& element : elements)
    for (std::size_t k = 1; k < corners; ++k) {
      const int a = root(parent, element[0]), b = root(parent, element[k]);
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  std::vector<int> roots;
  for (const auto& element : elements) roots.push_back(root(parent, element[0]));
  std::sort(roots.begin(), roots.end());
  return static_cast<int>(std::unique(roots.begin(), roots.end()) - roots.begin());
}

struct LowerTwin {
  const std::vector<Point>& points;
  int self;
  double tolerance;
  int found = -1;

  bool intersectVolume(const Volume& box) const {
    return box.squaredExteriorDistance(points[static_cast<std::size_t>(self)]) <= tolerance * tolerance;
  }
  bool intersectObject(int other) {
    const Point& p = points[static_cast<std::size_t>(self)];
    if (other >= self || (points[static_cast<std::size_t>(other)] - p).norm() > tolerance) return false;
    found = other;
    return true;
  }
};

}  // namespace

int count_parts(const TetMesh& mesh) { return count_parts(mesh.vertices.size(), mesh.tets); }

int count_parts(const TriangleSurface& surface) { return count_parts(surface.vertices.size(), surface.triangles); }

std::vector<int> lower_twins(const std::vector<Point>& points, double tolerance) {
  std::vector<int> vertices(points.size());
  std::iota(vertices.begin(), vertices.end(), 0);
  std::vector<Volume> boxes;
  for (const Point& p : points) boxes.emplace_back(p, p);
  const Eigen::KdBVH<double, 3, int> tree(vertices.begin(), vertices.end(), boxes.begin(), boxes.end());
  std::vector<int> twins;
  for (const int v : vertices) {
    LowerTwin twin{points, v, tolerance};
    Eigen::BVIntersect(tree, twin);
    twins.push_back(twin.found);
  }
  return twins;
}

int count_duplicate_vertices(const TetMesh& mesh, double tolerance) {
  const std::vector<int> twins = lower_twins(mesh.vertices, tolerance);
  return static_cast<int>(std::count_if(twins.begin(), twins.end(), [](int twin) { return twin >= 0; }));
}

}  // namespace plica
