// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <numbers>
#include <plica/core/error.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/generators.hpp>
#include <unordered_map>
#include <utility>

namespace plica {

Point rounded(const Point& p) {
  // Scale of the cube at the centre, relative to the ball. Found by trial: 0.57 to 0.9 give sound
  // meshes, 0.8 the best ones.
  constexpr double core = 0.8;
  const double shell = p.lpNorm<Eigen::Infinity>();
  if (shell == 0.0) return Point::Zero();
  const Point even =
      (p / shell).unaryExpr([](double c) { return std::tan(c * std::numbers::pi / 4.0); });
  return shell * (shell * even.normalized()) + (1.0 - shell) * (core * p);
}

namespace {

using Index = std::array<int, 3>;

int vertex_number(const Index& cells, const Index& at) {
  return (at[2] * (cells[1] + 1) + at[1]) * (cells[0] + 1) + at[0];
}

// Calls `visit` with every index below `counts`, x fastest
template <typename Visit>
void for_each(const Index& counts, Visit visit) {
  for (int k = 0; k < counts[2]; ++k)
    for (int j = 0; j < counts[1]; ++j)
      for (int i = 0; i < counts[0]; ++i) visit(Index{i, j, k});
}

// Path along the edges of a cell from one end of its diagonal to the other: one of six. `even`: the
// order of the axes is an even permutation, and the path turns right-handed.
struct Walk {
  Index axes;
  bool even;
};
constexpr Walk walks[6] = {{{0, 1, 2}, true}, {{0, 2, 1}, false}, {{1, 0, 2}, false},
                           {{1, 2, 0}, true}, {{2, 0, 1}, true},  {{2, 1, 0}, false}};

void cut_cell(const Index& cells, const std::array<bool, 3>& mirrored, const Index& cell,
              TetMesh& mesh) {
  Index start = cell, step = {1, 1, 1};
  bool right_handed = true;
  for (std::size_t a = 0; a < 3; ++a) {
    if (!mirrored[a] || 2 * cell[a] + 1 >= cells[a]) continue;
    start[a] += 1, step[a] = -1, right_handed = !right_handed;
  }
  for (const Walk& walk : walks) {
    Index at = start;
    std::array<int, 4> tet = {vertex_number(cells, at), 0, 0, 0};
    for (std::size_t s = 0; s < 3; ++s) {
      const auto axis = static_cast<std::size_t>(walk.axes[s]);
      at[axis] += step[axis];
      tet[s + 1] = vertex_number(cells, at);
    }
    if (walk.even != right_handed) std::swap(tet[2], tet[3]);
    mesh.tets.push_back(tet);
  }
}

}  // namespace

TetMesh grid_mesh(const Index& cells, const std::array<bool, 3>& mirrored,
                  const std::function<Point(const Point&)>& map) {
  double vertices = 1, tets = 6;
  for (const int n : cells) {
    checked_cells("the number of cells along an axis", n);
    vertices *= n + 1.0, tets *= n;
  }
  checked_count("the number of vertices", vertices);
  checked_count("the number of tetrahedra", tets);

  TetMesh mesh;
  mesh.vertices.reserve(static_cast<std::size_t>(vertices));
  mesh.tets.reserve(static_cast<std::size_t>(tets));
  for_each({cells[0] + 1, cells[1] + 1, cells[2] + 1}, [&](const Index& at) {
    const Point unit(double(at[0]) / cells[0], double(at[1]) / cells[1], double(at[2]) / cells[2]);
    mesh.vertices.push_back(map(unit));
  });
  for_each(cells, [&](const Index& cell) { cut_cell(cells, mirrored, cell, mesh); });
  return mesh;
}

TetMesh box_mesh(const Box& box, const std::array<int, 3>& cells) {
  checked_point("the lowest corner of the box", box.min);
  checked_point("the highest corner of the box", box.max);
  const char* const axes[] = {"x", "y", "z"};
  for (int a = 0; a < 3; ++a)
    checked_size(std::string("the size of the box along ") + axes[a], box.max[a] - box.min[a]);
  return grid_mesh(cells, {false, false, false}, [&](const Point& unit) {
    return Point(std::lerp(box.min.x(), box.max.x(), unit.x()),
                 std::lerp(box.min.y(), box.max.y(), unit.y()),
                 std::lerp(box.min.z(), box.max.z(), unit.z()));
  });
}

TetMesh ball_mesh(const Point& centre, double radius, int cells) {
  checked_point("the centre of the ball", centre);
  checked_size("the radius of the ball", radius);
  return grid_mesh({cells, cells, cells}, {true, true, true}, [&](const Point& unit) -> Point {
    return centre + radius * rounded(2.0 * unit - Point::Ones());
  });
}

TetMesh cylinder_mesh(const Point& base, double radius, double length, int across, int along) {
  checked_point("the base of the cylinder", base);
  checked_size("the radius of the cylinder", radius);
  checked_size("the length of the cylinder", length);
  return grid_mesh({across, across, along}, {true, true, false}, [&](const Point& unit) -> Point {
    const Point disc = rounded(Point(2.0 * unit.x() - 1.0, 2.0 * unit.y() - 1.0, 0.0));
    return base + Point(radius * disc.x(), radius * disc.y(), length * unit.z());
  });
}

namespace {

using Triangle = std::array<int, 3>;

// Returns an icosahedron of radius 1. Its corners are the cyclic permutations of (0, +-1, +-golden
// ratio), scaled to length 1.
TriangleSurface icosahedron() {
  constexpr double g = std::numbers::phi;
  TriangleSurface surface;
  surface.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (Point& p : surface.vertices) p.normalize();
  surface.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                       {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                       {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                       {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  return surface;
}

// Cuts each triangle into four, with the middles of the edges moved out to radius 1
void subdivide(TriangleSurface& surface) {
  std::unordered_map<std::uint64_t, int> middles;
  middles.reserve(surface.triangles.size() * 3 / 2);
  const auto middle = [&](int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    const auto key = (static_cast<std::uint64_t>(low) << 32) | static_cast<std::uint64_t>(high);
    const auto [entry, is_new] =
        middles.try_emplace(key, static_cast<int>(surface.vertices.size()));
    if (is_new) {
      const Point sum = surface.vertices[static_cast<std::size_t>(a)] +
                        surface.vertices[static_cast<std::size_t>(b)];
      surface.vertices.push_back(sum.normalized());
    }
    return entry->second;
  };
  std::vector<Triangle> finer;
  finer.reserve(surface.triangles.size() * 4);
  for (const auto& [a, b, c] : surface.triangles) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.insert(finer.end(), {Triangle{a, ab, ca}, Triangle{b, bc, ab}, Triangle{c, ca, bc},
                               Triangle{ab, bc, ca}});
  }
  surface.triangles = std::move(finer);
}

}  // namespace

TriangleSurface sphere_surface(const Point& centre, double radius, int subdivisions) {
  checked_point("the centre of the sphere", centre);
  checked_size("the radius of the sphere", radius);
  if (subdivisions < 0)
    throw InputError("the number of subdivisions is " + std::to_string(subdivisions) +
                     "; it must be 0 or more");
  checked_count("the number of triangles", 20.0 * std::pow(4.0, subdivisions));

  TriangleSurface surface = icosahedron();
  for (int s = 0; s < subdivisions; ++s) subdivide(surface);
  for (Point& p : surface.vertices) p = centre + radius * p;
  return surface;
}

}  // namespace plica
