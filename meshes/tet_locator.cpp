// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/edge_lengths.hpp>
#include <plica/meshes/tet_locator.hpp>
#include <unsupported/Eigen/BVH>

namespace plica {

struct TetLocator::Tree : Eigen::KdBVH<double, 3, int> {
  using KdBVH::KdBVH;
};

namespace {

using Volume = Eigen::AlignedBox3d;

constexpr double inside_tolerance = 1e-9;  // of an edge
constexpr double tie_tolerance = 1e-9;     // of the distance
constexpr double farthest = 1e100;         // products of distances still fit a double

double smallest(const Weights& weights) { return *std::min_element(weights.begin(), weights.end()); }

// Keeps the tetrahedron with the largest smallest weight; done when that is not negative
struct Containing {
  const TetMesh& mesh;
  const Point& p;
  double depth = -inside_tolerance;
  Located found = {};

  bool intersectVolume(const Volume& box) const { return box.contains(p); }
  bool intersectObject(int tet) {
    const Weights weights = barycentric(p, corners_of(mesh, tet));
    if (const double d = smallest(weights); d >= depth) depth = d, found = {tet, weights, 0.0};
    return depth >= 0.0;
  }
};

double squared_distance(const Point& p, const TetMesh& mesh, int tet) {
  const auto corners = corners_of(mesh, tet);
  return (weighted(nearest_inside(p, corners), corners) - p).squaredNorm();
}

struct Nearest {
  using Scalar = double;
  const TetMesh& mesh;
  const Point& p;
  int tet = -1;
  double least = std::numeric_limits<double>::infinity();

  double minimumOnVolume(const Volume& box) const { return box.squaredExteriorDistance(p); }
  double minimumOnObject(int candidate) {
    const double d = squared_distance(p, mesh, candidate);
    if (d < least) least = d, tet = candidate;
    return d;
  }
};

// Among all as near as the nearest, the one extrapolated least
struct LeastExtrapolated {
  const TetMesh& mesh;
  const Point& p;
  double reach;
  Located found;

  bool intersectVolume(const Volume& box) const { return box.squaredExteriorDistance(p) <= reach; }
  bool intersectObject(int tet) {
    if (squared_distance(p, mesh, tet) > reach) return false;
    const Weights weights = barycentric(p, corners_of(mesh, tet));
    const double own = smallest(weights), best = smallest(found.weights);
    if (own > best || (own == best && tet < found.tet)) found.tet = tet, found.weights = weights;
    return false;
  }
};

}  // namespace

TetLocator::TetLocator(const TetMesh& mesh) : mesh_(&mesh) {
  if (mesh.tets.empty()) throw InputError("the mesh has no tetrahedron to locate points in");
  std::vector<int> tets(mesh.tets.size());
  std::iota(tets.begin(), tets.end(), 0);
  std::vector<Volume> boxes;
  boxes.reserve(tets.size());
  for (const int tet : tets) {
    Volume box;
    for (const Point& corner : corners_of(mesh, tet)) box.extend(corner);
    const Point margin = Point::Constant(inside_tolerance * box.diagonal().norm());
    boxes.emplace_back(box.min() - margin, box.max() + margin);
  }
  tree_ = std::make_unique<Tree>(tets.begin(), tets.end(), boxes.begin(), boxes.end());
}

TetLocator::~TetLocator() = default;
TetLocator::TetLocator(TetLocator&&) noexcept = default;
TetLocator& TetLocator::operator=(TetLocator&&) noexcept = default;

Located TetLocator::locate(const Point& point) const {
  checked_point("a point to locate", point);
  if (point.lpNorm<Eigen::Infinity>() > farthest) throw InputError("a point is more than 1e100 m away from the origin");
  Containing containing{*mesh_, point};
  Eigen::BVIntersect(*tree_, containing);
  if (containing.found.tet >= 0) return containing.found;

  Nearest nearest{*mesh_, point};
  Eigen::BVMinimize(*tree_, nearest);
  LeastExtrapolated choice{*mesh_, point, nearest.least * (1.0 + tie_tolerance), {}};
  choice.found = {nearest.tet, barycentric(point, corners_of(*mesh_, nearest.tet)), std::sqrt(nearest.least)};
  Eigen::BVIntersect(*tree_, choice);
  Located& found = choice.found;
  if (found.distance <= inside_tolerance * mean_edge_length(*mesh_, found.tet)) found.distance = 0.0;
  return found;
}

}  // namespace plica
