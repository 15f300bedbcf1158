// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/row_ranges.hpp>
#include <plica/meshes/blade_front.hpp>

namespace plica {

namespace {

std::array<Point, 4> corners_at(const std::vector<Point>& positions,
                                const std::array<int, 4>& tet) {
  return {positions[index_of(tet[0])], positions[index_of(tet[1])], positions[index_of(tet[2])],
          positions[index_of(tet[3])]};
}

}  // namespace

BladeFront::BladeFront(const Edge& edge, double spacing) {
  constexpr double most = 1e4;  // parts of an edge
  const double parts = std::ceil((edge[1] - edge[0]).norm() / spacing);
  places_.resize(1 + static_cast<std::size_t>(std::clamp(parts, 1., most)));
}

bool BladeFront::fits(std::size_t tets) const {
  return std::ranges::all_of(places_, [&](const Place& place) {
    return place.tet >= -1 && (place.tet < 0 || index_of(place.tet) < tets);
  });
}

Blade BladeFront::advance(const std::vector<std::array<int, 4>>& tets,
                          const std::vector<Point>& positions, const Edge& from, const Edge& to) {
  constexpr double rounding = 1e-9;  // part of the way
  const Point way = to[0] - from[0];
  if (way.isZero(0)) return {};
  if (way.dot(last_way_) < 0) places_.assign(places_.size(), {});
  last_way_ = way;
  const std::vector<Point> shift = shifts(tets, positions, from);
  std::vector<Point> start, end;
  std::vector<char> moved;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Point blade = on(from, i), goal = on(to, i);
    const Point at = shift[i].norm() < rounding * way.norm() ? blade : Point(blade + shift[i]);
    moved.push_back((goal - at).dot(way) > 0 ? 1 : 0);
    start.push_back(at), end.push_back(moved.back() != 0 ? goal : at);
  }
  locate(tets, positions, end, moved);
  Blade swept;
  for (std::size_t i = 1; i < places_.size(); ++i) {
    swept.push_back({start[i - 1], start[i], end[i]});
    swept.push_back({start[i - 1], end[i], end[i - 1]});
  }
  return swept;
}

/// Returns how far the body has carried each place from the blade. A place outside goes with the
/// next one inside: cuts of two steps thus meet up to the body's surface.
std::vector<Point> BladeFront::shifts(const std::vector<std::array<int, 4>>& tets,
                                      const std::vector<Point>& positions,
                                      const Edge& blade) const {
  std::vector<Point> shift(places_.size(), Point::Zero());
  std::vector<std::size_t> inside;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (places_[i].tet < 0) continue;
    const auto corners = corners_at(positions, tets[index_of(places_[i].tet)]);
    shift[i] = weighted(places_[i].weights, corners) - on(blade, i), inside.push_back(i);
  }
  for (std::size_t i = 0, next = 0; i < places_.size() && !inside.empty(); ++i) {
    while (next + 1 < inside.size() && inside[next] + inside[next + 1] < 2 * i) ++next;
    shift[i] = shift[inside[next]];
  }
  return shift;
}

/// Finds the tetrahedra of the places that have moved: of several that touch, the first.
void BladeFront::locate(const std::vector<std::array<int, 4>>& tets,
                        const std::vector<Point>& positions, const std::vector<Point>& ends,
                        const std::vector<char>& moved) {
  constexpr double rounding = 1e-9;  // weight
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (moved[i] != 0) places_[i] = {};
  const Box all = bounding_box(ends);
  const auto is_in = [](const Point& p, const Box& box) {
    return (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
  };
  for (std::size_t e = 0; e < tets.size(); ++e) {
    const std::array<Point, 4> corners = corners_at(positions, tets[e]);
    const Box box{corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]).cwiseMin(corners[3]),
                  corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]).cwiseMax(corners[3])};
    if ((box.min.array() > all.max.array()).any() || (box.max.array() < all.min.array()).any())
      continue;
    if (!(tet_volume(corners[0], corners[1], corners[2], corners[3]) > 0)) continue;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (moved[i] == 0 || places_[i].tet >= 0 || !is_in(ends[i], box)) continue;
      const Weights weights = barycentric(ends[i], corners);
      if (std::ranges::min(weights) >= -rounding) places_[i] = {static_cast<int>(e), weights};
    }
  }
}

}  // namespace plica
