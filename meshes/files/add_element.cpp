// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/files/raw_mesh.hpp>
#include <string>

namespace plica {

namespace {

using Quadrangle = std::array<int, 4>;  // corners, outward; -1 at the end: a triangle

// The faces of a cell with so many corners, as Gmsh, VTK and Medit number them
std::span<const Quadrangle> faces_of(int corners) {
  static constexpr Quadrangle pyramid[] = {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}},
                              prism[] = {{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}},
                              hexahedron[] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                              {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  if (corners == 5) return pyramid;
  if (corners == 6) return prism;
  return hexahedron;
}

using Triangle = std::array<std::int64_t, 3>;

// From the corner with the lowest number
std::vector<Triangle> cut_face(const Quadrangle& face, std::span<const std::int64_t> cell) {
  std::vector<std::int64_t> corners;
  for (const int k : face)
    if (k >= 0) corners.push_back(cell[static_cast<std::size_t>(k)]);
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  std::vector<Triangle> triangles;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) triangles.push_back({corners[0], corners[k], corners[k + 1]});
  return triangles;
}

bool names_twice(const std::array<std::int64_t, 4>& v) {
  for (std::size_t k = 1; k < 4; ++k)
    if (std::count(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(k), v[k]) > 0) return true;
  return false;
}

// Collapsed corners, such as a prism written as a hexahedron, leave out the tetrahedra that they collapse
void cut_cell(const ElementKind& kind, std::int64_t tag, std::span<const std::int64_t> corners, const Place& place,
              RawMesh& raw) {
  const std::size_t begin = raw.tets.size();
  const std::int64_t lowest = *std::min_element(corners.begin(), corners.end());
  for (const Quadrangle& face : faces_of(static_cast<int>(corners.size())))
    for (const Triangle& t : cut_face(face, corners)) {
      const std::array<std::int64_t, 4> tet = {t[0], t[2], t[1], lowest};
      if (!names_twice(tet)) raw.tets.push_back({tag, tet, 0, place});
    }
  if (raw.tets.size() == begin)
    refuse(raw.file, place, std::string(kind.name) + " " + std::to_string(tag) + " names too few vertices");
  raw.cut.insert(raw.cut.end(), {begin, raw.tets.size()});
}

}  // namespace

void add_face(std::int64_t tag, std::span<const std::int64_t> corners, const Place& place, RawMesh& raw) {
  if (corners.size() == 3)
    raw.triangles.push_back({tag, {corners[0], corners[1], corners[2]}, 0, place});
  else
    raw.polygons.push_back({tag, {corners.begin(), corners.end()}, place});
}

std::size_t add_element(const ElementKind& kind, std::int64_t tag, std::span<const std::int64_t> vertices,
                        const Place& place, RawMesh& raw, MeshReport& report) {
  const auto corners = vertices.first(kind.corners > 0 ? static_cast<std::size_t>(kind.corners) : vertices.size());
  if (corners.size() < vertices.size()) ++report.linearised[kind.name];
  for (const std::int64_t v : vertices.subspan(corners.size())) raw.middles.push_back({v, place});
  if (kind.dimension < 3) {
    ++report.other_elements[kind.name];
    if (kind.dimension == 2)
      add_face(tag, corners, place, raw);
    else
      for (const std::int64_t v : corners) raw.others.push_back({v, place});
    return 0;
  }
  const std::size_t before = raw.tets.size();
  if (corners.size() == 4) {
    raw.tets.push_back({tag, {corners[0], corners[1], corners[2], corners[3]}, 0, place});
  } else {
    ++report.cut[kind.name];
    cut_cell(kind, tag, corners, place, raw);
  }
  return raw.tets.size() - before;
}

void add_to_group(const ElementKind& kind, std::int64_t tag, std::span<const std::int64_t> vertices, const Place& place,
                  RawGroup& group) {
  std::vector<std::int64_t> v(vertices.begin(), vertices.begin() + kind.corners);
  if (kind.dimension < 2) {
    group.elements.push_back({tag, {v.front(), v.back(), v.back()}, 0, place});
    return;
  }
  std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
  for (std::size_t k = 1; k + 1 < v.size(); ++k) group.elements.push_back({tag, {v[0], v[k], v[k + 1]}, 0, place});
}

}  // namespace plica
