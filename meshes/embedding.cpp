// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <unsupported/Eigen/BVH>
#include <utility>

namespace plica {

// Names: ab_p is the dot product of edge ab with the vector from a to p; q and r stand for p
// relative to b and c.
std::array<double, 3> nearest_in_triangle(const Point& p, const Point& a, const Point& b,
                                          const Point& c) {
  const Point ab = b - a, ac = c - a;
  const double ab_p = ab.dot(p - a), ac_p = ac.dot(p - a);
  if (ab_p <= 0.0 && ac_p <= 0.0) return {1.0, 0.0, 0.0};
  const double ab_q = ab.dot(p - b), ac_q = ac.dot(p - b);
  if (ab_q >= 0.0 && ac_q <= ab_q) return {0.0, 1.0, 0.0};
  const double over_ab = ab_p * ac_q - ab_q * ac_p;  // below zero: p lies beyond edge ab
  if (over_ab <= 0.0 && ab_p >= 0.0 && ab_q <= 0.0) {
    const double t = ab_p / (ab_p - ab_q);
    return {1.0 - t, t, 0.0};
  }
  const double ab_r = ab.dot(p - c), ac_r = ac.dot(p - c);
  if (ac_r >= 0.0 && ab_r <= ac_r) return {0.0, 0.0, 1.0};
  const double over_ac = ab_r * ac_p - ab_p * ac_r;
  if (over_ac <= 0.0 && ac_p >= 0.0 && ac_r <= 0.0) {
    const double t = ac_p / (ac_p - ac_r);
    return {1.0 - t, 0.0, t};
  }
  const double over_bc = ab_q * ac_r - ab_r * ac_q;
  if (over_bc <= 0.0 && ac_q >= ab_q && ab_r >= ac_r) {
    const double t = (ac_q - ab_q) / ((ac_q - ab_q) + (ab_r - ac_r));
    return {0.0, 1.0 - t, t};
  }
  const double v = over_ac / (over_ab + over_ac + over_bc),
               w = over_ab / (over_ab + over_ac + over_bc);
  return {1.0 - v - w, v, w};
}

Weights barycentric(const Point& p, const std::array<Point, 4>& corners) {
  const Point a = corners[1] - corners[0], b = corners[2] - corners[0], c = corners[3] - corners[0];
  const Point bc = b.cross(c), r = p - corners[0];
  const Point ar = a.cross(r);
  const double six_volumes = a.dot(bc);
  const double w1 = r.dot(bc) / six_volumes, w2 = ar.dot(c) / six_volumes,
               w3 = -ar.dot(b) / six_volumes;
  return {1.0 - w1 - w2 - w3, w1, w2, w3};
}

bool is_in_tetrahedron(const std::array<Point, 4>& corners, const Point& x) {
  for (int k = 0; k < 3; ++k) {  // a quick test by the bounding box rejects most points
    const auto [least, most] =
        std::ranges::minmax({corners[0][k], corners[1][k], corners[2][k], corners[3][k]});
    if (x[k] < least || x[k] > most) return false;
  }
  return std::ranges::all_of(barycentric(x, corners), [](double weight) { return weight >= 0; });
}

Weights nearest_inside(const Point& p, const std::array<Point, 4>& corners) {
  static constexpr std::array<std::array<std::size_t, 3>, 4> faces = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  const Weights own = barycentric(p, corners);
  Weights best = own;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < 4; ++f) {
    if (own[f] >= 0.0) continue;  // p is on the inner side of this face: another one is nearer
    const auto& [i, j, k] = faces[f];
    const std::array<double, 3> t = nearest_in_triangle(p, corners[i], corners[j], corners[k]);
    Weights candidate = {};
    candidate[i] = t[0], candidate[j] = t[1], candidate[k] = t[2];
    const double d = (weighted(candidate, corners) - p).squaredNorm();
    if (d < nearest) nearest = d, best = candidate;
  }
  return best;
}

Point weighted(const Weights& weights, const std::array<Point, 4>& corners) {
  // Sum relative to corner 0: coordinates far from the origin would round more than the edges do
  return corners[0] + weights[1] * (corners[1] - corners[0]) +
         weights[2] * (corners[2] - corners[0]) + weights[3] * (corners[3] - corners[0]);
}

std::array<Point, 4> corners_of(const TetMesh& mesh, int tet) {
  const auto& v = mesh.tets[static_cast<std::size_t>(tet)];
  const auto at = [&](int i) -> const Point& { return mesh.vertices[static_cast<std::size_t>(i)]; };
  return {at(v[0]), at(v[1]), at(v[2]), at(v[3])};
}

struct TetLocator::Tree : Eigen::KdBVH<double, 3, int> {
  using KdBVH::KdBVH;
};

namespace {

using Volume = Eigen::AlignedBox3d;

constexpr double inside_tolerance = 1e-9;  // relative to an edge
constexpr double tie_tolerance = 1e-9;     // relative to the squared distance
constexpr double farthest = 1e100;         // [m], so that products of distances fit a double

double smallest(const Weights& weights) {
  return *std::min_element(weights.begin(), weights.end());
}

// Visitor that keeps the tetrahedron whose smallest weight is the largest. The search ends when
// this weight is not negative. Of pieces that share room the finest counts.
struct Containing {
  const TetMesh& mesh;
  const Point& p;
  double depth = -inside_tolerance;
  Located found = {};
  int piece = std::numeric_limits<int>::max();

  bool intersectVolume(const Volume& box) const { return box.contains(p); }
  bool intersectObject(int tet) {
    const Weights weights = barycentric(p, corners_of(mesh, tet));
    const double d = smallest(weights);
    const int own = mesh.piece.empty() ? 0 : mesh.piece[static_cast<std::size_t>(tet)];
    if (own < piece ? d >= -inside_tolerance : own == piece && d >= depth)
      depth = d, piece = own, found = {tet, weights, 0.0};
    return depth >= 0.0 && piece == 0;
  }
};

double squared_distance(const Point& p, const TetMesh& mesh, int tet) {
  const auto corners = corners_of(mesh, tet);
  return (weighted(nearest_inside(p, corners), corners) - p).squaredNorm();
}

// Visitor that lists the tetrahedra whose boxes meet a box
struct MeetingBox {
  const TetMesh& mesh;
  Volume box;
  std::vector<int> found = {};

  bool intersectVolume(const Volume& of_some) const { return of_some.intersects(box); }
  bool intersectObject(int tet) {
    Volume own;
    for (const Point& corner : corners_of(mesh, tet)) own.extend(corner);
    if (own.intersects(box)) found.push_back(tet);
    return false;
  }
};

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

// Visitor that finds, among the equally near tetrahedra, the one with the least extrapolation
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
  if (point.lpNorm<Eigen::Infinity>() > farthest)
    throw InputError("a point is more than 1e100 m away from the origin");
  Containing containing{*mesh_, point};
  Eigen::BVIntersect(*tree_, containing);
  if (containing.found.tet >= 0) return containing.found;

  Nearest nearest{*mesh_, point};
  Eigen::BVMinimize(*tree_, nearest);
  LeastExtrapolated choice{*mesh_, point, nearest.least * (1.0 + tie_tolerance), {}};
  choice.found = {nearest.tet, barycentric(point, corners_of(*mesh_, nearest.tet)),
                  std::sqrt(nearest.least)};
  Eigen::BVIntersect(*tree_, choice);
  Located& found = choice.found;
  if (found.distance <= inside_tolerance * mean_edge_length(*mesh_, found.tet))
    found.distance = 0.0;
  return found;
}

std::vector<int> TetLocator::tets_near(const Box& box) const {
  MeetingBox meeting{*mesh_, Volume(box.min, box.max)};
  Eigen::BVIntersect(*tree_, meeting);
  std::ranges::sort(meeting.found);
  return std::move(meeting.found);
}

namespace {

constexpr double lowest_weight = -0.5;

// Returns the weights of a point inside without errors of rounding: negative ones are set to zero,
// and all are scaled to sum to 1
Weights cut(Weights weights) {
  double sum = 0.0;
  for (double& w : weights) sum += w = std::max(w, 0.0);
  for (double& w : weights) w /= sum;
  return weights;
}

// Moves the weights towards those of the centroid (1/4 each) until none is below `lowest_weight`.
// Returns whether that was necessary. Each weight is linear in the move.
bool hold(Weights& weights) {
  const double least = *std::min_element(weights.begin(), weights.end());
  if (least >= lowest_weight) return false;
  const double share = (0.25 - lowest_weight) / (0.25 - least);
  for (double& w : weights) w = 0.25 + share * (w - 0.25);
  return true;
}

}  // namespace

Embedding embed(const std::vector<Point>& points, const TetLocator& locator, Outside outside) {
  const TetMesh& mesh = locator.mesh();
  Embedding result;
  result.vertices.reserve(points.size());
  result.weights.reserve(points.size());
  result.outside.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) checked_point("point " + std::to_string(i), points[i]);
    const Located at = locator.locate(points[i]);
    const bool miss = at.distance > 0.0;
    Weights weights = at.weights;
    if (outside == Outside::clamp)
      weights = miss ? nearest_inside(points[i], corners_of(mesh, at.tet)) : cut(weights);
    if (outside == Outside::extrapolate && hold(weights)) ++result.held;
    if (outside == Outside::keep && miss) weights = {};
    if (miss) {
      ++result.misses;
      result.largest_distance_over_edge =
          std::max(result.largest_distance_over_edge, at.distance / mean_edge_length(mesh, at.tet));
    }
    result.vertices.push_back(mesh.tets[static_cast<std::size_t>(at.tet)]);
    result.weights.push_back(weights);
    result.outside.push_back(miss ? 1 : 0);
  }
  return result;
}

Embedding embed(const std::vector<Point>& points, const TetMesh& mesh, Outside outside) {
  return embed(points, TetLocator(mesh), outside);
}

std::vector<int> vertices_at(const std::vector<Point>& points, const TetMesh& mesh) {
  std::vector<int> order(points.size()), at(points.size(), -1);
  std::iota(order.begin(), order.end(), 0);
  const auto before = [](const Point& a, const Point& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  const auto of = [&](int p) -> const Point& { return points[static_cast<std::size_t>(p)]; };
  std::ranges::sort(order, before, of);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto found = std::ranges::equal_range(order, mesh.vertices[v], before, of);
    for (const int p : found)
      if (std::exchange(at[static_cast<std::size_t>(p)], static_cast<int>(v)) >= 0) return {};
  }
  return std::ranges::count(at, -1) > 0 ? std::vector<int>{} : at;
}

}  // namespace plica
