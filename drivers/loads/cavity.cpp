// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/loads/cavity.hpp>
#include <set>
#include <utility>

namespace plica {

namespace {

using Triangle = std::array<int, 3>;

double cone(const Point& a, const Point& b, const Point& c) { return a.dot(b.cross(c)) / 6; }

using Edge = std::pair<int, int>;

/// Returns the edges that only one triangle has, in the direction of the triangles that are missing
/// there.
std::vector<Edge> rim_edges(const std::vector<Triangle>& triangles) {
  std::set<Edge> edges;
  for (const Triangle& t : triangles)
    for (std::size_t c = 0; c < 3; ++c) edges.emplace(t[c], t[(c + 1) % 3]);
  std::vector<Edge> alone;
  for (const auto& [a, b] : edges)
    if (!edges.contains({b, a})) alone.emplace_back(b, a);
  return alone;
}

/// Returns for each vertex on a rim the next one along the rim.
std::map<int, int> rims(const std::vector<Triangle>& triangles, const std::string& option) {
  std::map<int, int> next;
  for (const auto& [a, b] : rim_edges(triangles))
    if (!next.emplace(a, b).second)
      throw InputError(text(option, ": the rim of its triangles meets itself at vertex ", a));
  return next;
}

}  // namespace

bool has_still_rims(const std::vector<Triangle>& triangles, const std::vector<char>& still) {
  return std::ranges::all_of(rim_edges(triangles), [&](const Edge& e) {
    return still[static_cast<std::size_t>(e.first)] && still[static_cast<std::size_t>(e.second)];
  });
}

Point centre_of(const TetMesh& mesh, const std::vector<Triangle>& triangles) {
  Point sum = Point::Zero();
  for (const Triangle& t : triangles)
    for (const int v : t) sum += mesh.vertices[static_cast<std::size_t>(v)];
  return sum / (3.0 * static_cast<double>(triangles.size()));
}

Cavity make_cavity(const EnclosedVolume& given, int load, const TetMesh& mesh,
                   const std::vector<Triangle>& triangles, const std::vector<char>& still,
                   const Selecting& who) {
  const std::string option = who.option + ".enclosed_volume";
  const auto x = [&](int v) -> const Point& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  Cavity cavity{load, 0, 0, given.ratio, given.bulk_modulus, centre_of(mesh, triangles)};
  const auto from = [&](int v) -> Point { return x(v) - cavity.origin; };
  for (const Triangle& t : triangles) cavity.rest -= cone(from(t[0]), from(t[1]), from(t[2]));
  std::map<int, int> next = rims(triangles, option);
  while (!next.empty()) {
    std::vector<int> loop;
    for (int v = next.begin()->first; next.contains(v);) {
      if (!still[static_cast<std::size_t>(v)])
        throw InputError(
            text(option, ": its triangles on level ", who.level, " have a rim, and vertex ", v,
                 " on it may move; expected a closed surface, or rims that are fixed"));
      loop.push_back(v);
      const auto step = next.find(v);
      v = step->second, next.erase(step);
    }
    Point middle = Point::Zero();
    for (const int v : loop) middle += from(v) / static_cast<double>(loop.size());
    for (std::size_t i = 0; i < loop.size(); ++i)
      cavity.caps -= cone(from(loop[i]), from(loop[(i + 1) % loop.size()]), middle);
  }
  cavity.rest += cavity.caps;
  if (!(cavity.rest > 0))
    throw InputError(text(option, ": the volume on the outer side of its triangles on level ",
                          who.level, " is ", number(cavity.rest),
                          " m^3; expected the inside of a cavity"));
  return cavity;
}

}  // namespace plica
