// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <numbers>
#include <plica/core/error.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/sphere_surface.hpp>
#include <unordered_map>
#include <utility>

namespace plica {

namespace {

using Triangle = std::array<int, 3>;

// Radius 1; the corners are the cyclic permutations of (0, +-1, +-golden ratio)
TriangleSurface icosahedron() {
  constexpr double g = std::numbers::phi;
  TriangleSurface surface;
  surface.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (Point& p : surface.vertices) p.normalize();
  surface.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return surface;
}

// Each triangle in four, the middles of the edges pushed out to radius 1
void subdivide(TriangleSurface& surface) {
  std::unordered_map<std::uint64_t, int> middles;
  middles.reserve(surface.triangles.size() * 3 / 2);
  const auto middle = [&](int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    const auto key = (static_cast<std::uint64_t>(low) << 32) | static_cast<std::uint64_t>(high);
    const auto [entry, is_new] = middles.try_emplace(key, static_cast<int>(surface.vertices.size()));
    if (is_new) {
      const Point sum = surface.vertices[static_cast<std::size_t>(a)] + surface.vertices[static_cast<std::size_t>(b)];
      surface.vertices.push_back(sum.normalized());
    }
    return entry->second;
  };
  std::vector<Triangle> finer;
  finer.reserve(surface.triangles.size() * 4);
  for (const auto& [a, b, c] : surface.triangles) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.insert(finer.end(), {Triangle{a, ab, ca}, Triangle{b, bc, ab}, Triangle{c, ca, bc}, Triangle{ab, bc, ca}});
  }
  surface.triangles = std::move(finer);
}

}  // namespace

TriangleSurface sphere_surface(const Point& centre, double radius, int subdivisions) {
  checked_point("the centre of the sphere", centre);
  checked_size("the radius of the sphere", radius);
  if (subdivisions < 0)
    throw InputError("the number of subdivisions is " + std::to_string(subdivisions) + "; it must be 0 or more");
  checked_count("the number of triangles", 20.0 * std::pow(4.0, subdivisions));

  TriangleSurface surface = icosahedron();
  for (int s = 0; s < subdivisions; ++s) subdivide(surface);
  for (Point& p : surface.vertices) p = centre + radius * p;
  return surface;
}

}  // namespace plica
