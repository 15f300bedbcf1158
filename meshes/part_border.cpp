// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/part_border.hpp>
#include <unsupported/Eigen/BVH>

namespace plica {

namespace {

constexpr double skin_reach = 0.15;  // distance over an edge of the coarser skin
constexpr double skin_cosine = 0.8;

using Triangle = std::array<int, 3>;

const Point& corner_of(const TetMesh& mesh, const Triangle& t, std::size_t k) {
  return mesh.vertices[static_cast<std::size_t>(t[k])];
}

Point centre_of_triangle(const TetMesh& mesh, const Triangle& t) {
  return (corner_of(mesh, t, 0) + corner_of(mesh, t, 1) + corner_of(mesh, t, 2)) / 3;
}

Point normal_of_triangle(const TetMesh& mesh, const Triangle& t) {
  const Point& a = corner_of(mesh, t, 0);
  return (corner_of(mesh, t, 1) - a).cross(corner_of(mesh, t, 2) - a).normalized();
}

// Skin of the coarser mesh, and search for triangles of it that a place may belong to
class CoarserSkin {
 public:
  explicit CoarserSkin(const TetMesh& mesh) : mesh_(mesh), triangles_(boundary_triangles(mesh)) {
    std::vector<int> numbers(triangles_.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const auto& t : triangles_) {
      Eigen::AlignedBox3d& box = boxes.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) box.extend(corner_of(mesh, t, k));
      const Point reach = Point::Constant(reach_of(t));
      box.min() -= reach, box.max() += reach;
    }
    tree_.init(numbers.begin(), numbers.end(), boxes.begin(), boxes.end());
  }

  // Returns whether a triangle of the skin is near a place, and parallel to a face with this normal
  bool has(const Point& place, const Point& normal) const {
    Search search{*this, place, normal};
    return Eigen::BVIntersect(tree_, search), search.found;
  }

 private:
  struct Search {
    const CoarserSkin& skin;
    const Point &place, &normal;
    bool found = false;
    bool intersectVolume(const Eigen::AlignedBox3d& box) const { return box.contains(place); }
    bool intersectObject(int triangle) {
      return found = found || skin.is_like(skin.triangles_[static_cast<std::size_t>(triangle)],
                                           place, normal);
    }
  };

  const TetMesh& mesh_;
  std::vector<Triangle> triangles_;
  Eigen::KdBVH<double, 3, int> tree_;

  double reach_of(const Triangle& t) const {
    const auto length = [&](std::size_t i, std::size_t j) {
      return (corner_of(mesh_, t, i) - corner_of(mesh_, t, j)).norm();
    };
    return skin_reach * (length(0, 1) + length(1, 2) + length(2, 0)) / 3;
  }

  bool is_like(const Triangle& t, const Point& place, const Point& normal) const {
    if (normal_of_triangle(mesh_, t).dot(normal) <= skin_cosine) return false;
    const Point &a = corner_of(mesh_, t, 0), &b = corner_of(mesh_, t, 1),
                &c = corner_of(mesh_, t, 2);
    const std::array<double, 3> w = nearest_in_triangle(place, a, b, c);
    return (w[0] * a + w[1] * b + w[2] * c - place).norm() < reach_of(t);
  }
};

}  // namespace

std::vector<char> border_flags(const PartMesh& part, const std::vector<Triangle>& boundary,
                               const TetMesh& coarser, const std::string& border) {
  const TetMesh& mesh = part.mesh;
  std::vector<char> inner;
  const auto flag = [&](const auto& is_border) {
    for (const auto& t : boundary) inner.push_back(is_border(t) ? 1 : 0);
  };
  const auto is_in = [](const std::vector<Triangle>& sorted) {
    return [&sorted](Triangle t) {
      return std::ranges::sort(t), std::ranges::binary_search(sorted, t);
    };
  };
  const auto triangles = mesh.triangle_sets.find(border);
  const auto vertices = mesh.vertex_sets.find(border);
  if (!border.empty() && triangles != mesh.triangle_sets.end()) {
    const std::vector<Triangle> chosen = sorted_triangles(triangles->second);
    flag(is_in(chosen));
  } else if (!border.empty() && vertices != mesh.vertex_sets.end()) {
    const std::vector<int>& set = vertices->second;
    flag([&](const Triangle& t) {
      return std::ranges::all_of(t, [&](int v) { return std::ranges::binary_search(set, v); });
    });
  } else if (!border.empty()) {
    std::vector<std::string> names;
    for (const auto& [name, set] : mesh.vertex_sets) names.push_back(name);
    throw InputError("the part's border: " + unknown_name("group", border, names));
  } else if (part.skin) {
    const std::vector<Triangle> skin = sorted_triangles(*part.skin);
    const auto is_skin = is_in(skin);
    flag([&](const Triangle& t) { return !is_skin(t); });
  } else {
    const CoarserSkin skin(coarser);
    flag([&](const Triangle& t) {
      return !skin.has(centre_of_triangle(mesh, t), normal_of_triangle(mesh, t));
    });
  }
  return inner;
}

}  // namespace plica
