// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <plica/meshes/barycentric.hpp>

namespace plica {

namespace {

// Weights of the nearest point of a triangle. Names: ab_p is the product of edge ab with the way from a to p.
std::array<double, 3> nearest_in_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
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
  const double v = over_ac / (over_ab + over_ac + over_bc), w = over_ab / (over_ab + over_ac + over_bc);
  return {1.0 - v - w, v, w};
}

}  // namespace

Weights barycentric(const Point& p, const std::array<Point, 4>& corners) {
  const Point a = corners[1] - corners[0], b = corners[2] - corners[0], c = corners[3] - corners[0];
  const Point bc = b.cross(c), r = p - corners[0];
  const Point ar = a.cross(r);
  const double six_volumes = a.dot(bc);
  const double w1 = r.dot(bc) / six_volumes, w2 = ar.dot(c) / six_volumes, w3 = -ar.dot(b) / six_volumes;
  return {1.0 - w1 - w2 - w3, w1, w2, w3};
}

Weights nearest_inside(const Point& p, const std::array<Point, 4>& corners) {
  static constexpr std::array<std::array<std::size_t, 3>, 4> faces = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  const Weights own = barycentric(p, corners);
  Weights best = own;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < 4; ++f) {
    if (own[f] >= 0.0) continue;  // p is on the inner side: another face is nearer
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
  // From corner 0, as coordinates far from the origin would round more than the edges do
  return corners[0] + weights[1] * (corners[1] - corners[0]) + weights[2] * (corners[2] - corners[0]) +
         weights[3] * (corners[3] - corners[0]);
}

std::array<Point, 4> corners_of(const TetMesh& mesh, int tet) {
  const auto& v = mesh.tets[static_cast<std::size_t>(tet)];
  const auto at = [&](int i) -> const Point& { return mesh.vertices[static_cast<std::size_t>(i)]; };
  return {at(v[0]), at(v[1]), at(v[2]), at(v[3])};
}

}  // namespace plica
