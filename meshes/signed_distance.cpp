// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <plica/meshes/signed_distance.hpp>
#include <unsupported/Eigen/BVH>
#include <vector>

namespace plica {

namespace {

using Volume = Eigen::AlignedBox3d;
// Normals at a triangle's vertices 0 1 2, at its edges 01 12 20, and of its face
using Normals = std::array<Point, 7>;

struct Closest {
  Point point;
  std::size_t feature;  // index in Normals
};

// Finds the closest point by Voronoi regions (Ericson, Real-Time Collision Detection, 5.1.5)
Closest closest_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {a, 0};
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {b, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, 3};
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {c, 2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, 5};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), 4};
  return {a + ab * (vb / (va + vb + vc)) + ac * (vc / (va + vb + vc)), 6};
}

double angle_at(const Point& a, const Point& b, const Point& c) {
  return std::atan2((b - a).cross(c - a).norm(), (b - a).dot(c - a));
}

std::vector<Normals> normals_of(const TriangleSurface& surface) {
  std::vector<Point> at_vertex(surface.vertices.size(), Point::Zero());
  std::map<std::array<int, 2>, Point> at_edge;
  const auto edge = [](int a, int b) { return std::array<int, 2>{std::min(a, b), std::max(a, b)}; };
  std::vector<Point> face;
  for (const auto& t : surface.triangles) {
    const auto x = [&](std::size_t k) -> const Point& {
      return surface.vertices[static_cast<std::size_t>(t[k % 3])];
    };
    face.push_back((x(1) - x(0)).cross(x(2) - x(0)).normalized());
    for (std::size_t k = 0; k < 3; ++k) {
      at_vertex[static_cast<std::size_t>(t[k])] += angle_at(x(k), x(k + 1), x(k + 2)) * face.back();
      at_edge.try_emplace(edge(t[k], t[(k + 1) % 3]), Point::Zero()).first->second += face.back();
    }
  }
  std::vector<Normals> all(surface.triangles.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& t = surface.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      all[i][k] = at_vertex[static_cast<std::size_t>(t[k])];
      all[i][3 + k] = at_edge.at(edge(t[k], t[(k + 1) % 3]));
    }
    all[i][6] = face[i];
  }
  return all;
}

struct Nearest {
  using Scalar = double;
  const TriangleSurface& surface;
  const Point& p;
  double reach;  // squared bound of the distance [m^2]
  int triangle = -1;
  Closest closest = {};
  double least = std::numeric_limits<double>::infinity();

  double minimumOnVolume(const Volume& box) const {
    const double d = box.squaredExteriorDistance(p);
    // the search skips boxes whose minimum is not below the largest double
    return d <= reach ? d : std::numeric_limits<double>::max();
  }
  double minimumOnObject(int candidate) {
    const auto& t = surface.triangles[static_cast<std::size_t>(candidate)];
    const auto x = [&](std::size_t k) -> const Point& {
      return surface.vertices[static_cast<std::size_t>(t[k])];
    };
    const Closest c = closest_on_triangle(p, x(0), x(1), x(2));
    const double d = (c.point - p).squaredNorm();
    if (d < least) least = d, triangle = candidate, closest = c;
    return d;
  }
};

}  // namespace

struct SignedDistance::Tree {
  const TriangleSurface& surface;
  std::vector<Normals> normals;
  Eigen::KdBVH<double, 3, int> boxes;
};

SignedDistance::SignedDistance(const TriangleSurface& surface)
    : tree_(std::make_unique<Tree>(Tree{surface, normals_of(surface), {}})) {
  std::vector<int> triangles(surface.triangles.size());
  std::iota(triangles.begin(), triangles.end(), 0);
  std::vector<Volume> boxes(triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (int v : surface.triangles[i])
      boxes[i].extend(surface.vertices[static_cast<std::size_t>(v)]);
  tree_->boxes.init(triangles.begin(), triangles.end(), boxes.begin(), boxes.end());
}

SignedDistance::~SignedDistance() = default;

double SignedDistance::operator()(const Point& point, double bound) const {
  Nearest nearest{tree_->surface, point, bound * bound * (1 + 1e-9)};
  Eigen::BVMinimize(tree_->boxes, nearest);
  // The given bound was too small by rounding: search without one
  if (nearest.least > nearest.reach) return (*this)(point);
  if (nearest.triangle < 0) return std::numeric_limits<double>::quiet_NaN();
  const Point& normal =
      tree_->normals[static_cast<std::size_t>(nearest.triangle)][nearest.closest.feature];
  const double d = std::sqrt(nearest.least);
  return (point - nearest.closest.point).dot(normal) < 0 ? -d : d;
}

}  // namespace plica
