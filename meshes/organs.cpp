// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/organs.hpp>
#include <utility>

namespace plica {

namespace {

constexpr double inclusion = 0.5;  // half edge of the inclusion over that of the cube

// Maps the unit ball to a lump with x in [-1, 1]. First the inside moves towards the thick end, and
// the surface stays; the determinant, 1 - 2 s.p with the shift s at the centre, is above 0. Then y
// depends on x and y only, and z on x and z only. Each grows with its own coordinate, so that the
// orientation stays.
Point lump(const Point& ball) {
  const Point p = ball + (1 - ball.squaredNorm()) * Point(-0.25, 0, 0);
  return {p.x(), 0.7 * p.y() * (1 - 0.2 * p.x()),
          0.5 * p.z() * (1 - 0.45 * p.x()) - 0.18 * p.x() * p.x()};
}

}  // namespace

TetMesh blob_mesh(const Point& centre, double length, int cells) {
  checked_point("the centre of the blob", centre);
  checked_size("the length of the blob", length);
  if (cells < 4 || cells % 4 != 0)
    throw InputError(
        text("the number of cells across the blob is ", cells, "; it must be a multiple of 4"));
  TetMesh mesh = ball_mesh(Point::Zero(), 1, cells);
  mesh.region_names = {"tissue", "inclusion"};
  mesh.region.reserve(mesh.tets.size());
  // Cells [first, last) along each axis are the inclusion; each has six tetrahedra
  const int first = static_cast<int>((1 - inclusion) / 2 * cells), last = cells - first;
  const auto inside = [&](int at) { return first <= at && at < last; };
  for (int k = 0; k < cells; ++k)
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i)
        mesh.region.insert(mesh.region.end(), 6, inside(i) && inside(j) && inside(k) ? 1 : 0);
  std::vector<int>& base = mesh.vertex_sets["base"];  // x is the fastest of the grid's indices
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); v += cells + 1) base.push_back(v);
  for (Point& p : mesh.vertices) p = centre + length / 2 * lump(p);
  return mesh;
}

namespace {

void check(const Tube& t) {
  checked_point("the start of the tube", t.start);
  checked_size("the radius of the tube", t.radius);
  checked_size("the wall of the tube", t.wall);
  checked_size("the length of the tube", t.length);
  if (t.around < 3)
    throw InputError(
        text("the number of cells around the tube is ", t.around, "; it must be 3 or more"));
  const double most = t.length / (t.radius + t.wall);
  if (!(t.bend >= 0 && t.bend < most))
    throw InputError(text("the tube bends by ", number(t.bend),
                          " rad; at its length and width it can bend by less than ", number(most),
                          " rad, and not back"));
}

// Returns the point at a radius, an angle and a length along the axis, each scaled to [0, 1]. The
// map keeps the orientation.
Point on_tube(const Tube& t, const Point& unit) {
  const double r = t.radius + t.wall * unit.x(), angle = 2 * std::numbers::pi * unit.y();
  const double turned = t.bend * unit.z(), side = r * std::cos(angle), y = r * std::sin(angle);
  // The circle's radius is length / bend. The chord is written with sin(x)/x, which has a limit
  // where there is no bend.
  const double half = std::sin(turned / 2), arc = t.length * unit.z();
  const double sinc = turned > 0 ? half / (turned / 2) : 1;
  const Point axis(arc * sinc * half, 0, arc * sinc * std::cos(turned / 2));
  return t.start + axis + Point(side * std::cos(turned), y, -side * std::sin(turned));
}

}  // namespace

TetMesh tube_mesh(const Tube& tube) {
  check(tube);
  TetMesh mesh = grid_mesh({tube.across, tube.around, tube.along}, {false, false, false},
                           [&](const Point& unit) { return on_tube(tube, unit); });
  // The last vertices around become the first ones. Their faces fit, as all cells are cut in one
  // way.
  const int across = tube.across + 1, around = tube.around + 1;
  std::vector<int> place(mesh.vertices.size());
  std::vector<Point> vertices;
  for (int v = 0; v < static_cast<int>(place.size()); ++v) {
    const int i = v % across, j = v / across % around, k = v / across / around;
    const bool again = j == tube.around;
    place[static_cast<std::size_t>(v)] =
        again ? place[static_cast<std::size_t>(v - tube.around * across)]
              : static_cast<int>(vertices.size());
    if (again) continue;
    const int here = static_cast<int>(vertices.size());
    vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    if (k == 0) mesh.vertex_sets["inlet"].push_back(here);
    if (k == tube.along) mesh.vertex_sets["outlet"].push_back(here);
    if (i == 0) mesh.vertex_sets["lumen"].push_back(here);
    if (i == tube.across) mesh.vertex_sets["outside"].push_back(here);
  }
  mesh.vertices = std::move(vertices);
  for (auto& tet : mesh.tets)
    for (int& v : tet) v = place[static_cast<std::size_t>(v)];
  return mesh;
}

}  // namespace plica
