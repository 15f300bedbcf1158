// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/meshes/common_volume.hpp>
#include <utility>

namespace plica {

namespace {

using Corners = std::array<Point, 4>;
using Heights = std::array<double, 4>;

// Plane of a face; its normal points into the tetrahedron
struct InnerPlane {
  Point point, normal;

  Heights heights(const Corners& x) const {
    Heights above;
    for (std::size_t k = 0; k < 4; ++k) above[k] = normal.dot(x[k] - point);
    return above;
  }
};

std::array<InnerPlane, 4> inner_planes(const Corners& x) {
  static constexpr std::array<std::array<std::size_t, 3>, 4> outward = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  std::array<InnerPlane, 4> planes;
  for (std::size_t f = 0; f < 4; ++f) {
    const auto& [i, j, k] = outward[f];
    planes[f] = {x[i], (x[k] - x[i]).cross(x[j] - x[i])};
  }
  return planes;
}

bool lies_below_a_plane(const Corners& x, const std::array<InnerPlane, 4>& planes) {
  return std::ranges::any_of(planes, [&](const InnerPlane& plane) {
    return std::ranges::all_of(plane.heights(x), [](double h) { return h <= 0; });
  });
}

// Some tetrahedra that cut none of each other
struct Pieces {
  static constexpr std::size_t most = 81;  // a plane leaves up to three of each
  std::array<Corners, most> tet;
  std::size_t count = 0;

  void add(const Point& a, const Point& b, const Point& c, const Point& d) {
    tet[count++] = {a, b, c, d};
  }
};

// Adds what of a tetrahedron lies above a plane: up to three tetrahedra, of either orientation
void add_above(const Corners& x, const Heights& height, Pieces& to) {
  std::array<std::size_t, 4> at = {};  // corners above the plane first
  std::size_t above = 0, below = 4;
  for (std::size_t k = 0; k < 4; ++k) at[height[k] >= 0 ? above++ : --below] = k;
  const auto corner = [&](std::size_t i) -> const Point& { return x[at[i]]; };
  const auto cut = [&](std::size_t i, std::size_t j) -> Point {
    const double from = height[at[i]], to_other = height[at[j]];
    return corner(i) + from / (from - to_other) * (corner(j) - corner(i));
  };
  if (above == 4) to.add(x[0], x[1], x[2], x[3]);
  if (above == 1) to.add(corner(0), cut(0, 1), cut(0, 2), cut(0, 3));
  if (above == 2) {
    const Point a2 = cut(0, 2), a3 = cut(0, 3), b2 = cut(1, 2), b3 = cut(1, 3);
    to.add(corner(0), a2, a3, corner(1));
    to.add(corner(1), a2, a3, b2);
    to.add(corner(1), a3, b2, b3);
  }
  if (above == 3) {
    const Point a = cut(0, 3), b = cut(1, 3), c = cut(2, 3);
    to.add(corner(0), corner(1), corner(2), a);
    to.add(corner(1), corner(2), a, b);
    to.add(corner(2), a, b, c);
  }
}

double volume_of(const Corners& x) { return std::abs(tet_volume(x[0], x[1], x[2], x[3])); }

}  // namespace

double common_volume(const std::array<Point, 4>& a, const std::array<Point, 4>& b) {
  const auto planes = inner_planes(b);
  if (lies_below_a_plane(a, planes) || lies_below_a_plane(b, inner_planes(a))) return 0;
  std::array<Pieces, 2> of_rounds;
  Pieces *rest = &of_rounds[0], *next = &of_rounds[1];
  rest->add(a[0], a[1], a[2], a[3]);
  for (const InnerPlane& plane : planes) {
    next->count = 0;
    for (std::size_t i = 0; i < rest->count; ++i)
      add_above(rest->tet[i], plane.heights(rest->tet[i]), *next);
    std::swap(rest, next);
  }
  double sum = 0;
  for (std::size_t i = 0; i < rest->count; ++i) sum += volume_of(rest->tet[i]);
  return sum;
}

}  // namespace plica
