// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/meshes/boundary_triangles.hpp>
#include <span>
#include <utility>

namespace plica {

namespace {

// Corners of the faces, counter-clockwise seen from outside; face k is across from corner k. Vertex
// 3 of the tetrahedron lies on the side of (1-0)x(2-0).
constexpr std::array<std::array<std::size_t, 3>, 4> outward_faces = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

struct Face {
  std::array<int, 2> others;  // the two higher vertices, ascending: equal from both sides
  std::size_t number;         // 4 * tetrahedron + corner across
};

// Calls visit(faces) for every three vertices that form a face. `faces` are those of the tetrahedra
// there, ascending by number. Faces are grouped by their lowest vertex with a counting sort, then
// sorted for each vertex: several times faster than one sort of all.
template <class Visit>
void for_faces(const TetMesh& mesh, const Visit& visit) {
  std::vector<std::size_t> start(mesh.vertices.size() + 1, 0);
  const auto for_each = [&](auto use) {
    std::size_t number = 0;
    for (const auto& tet : mesh.tets)
      for (const auto& [i, j, k] : outward_faces) {
        std::array<int, 3> key = {tet[i], tet[j], tet[k]};
        std::sort(key.begin(), key.end());
        use(static_cast<std::size_t>(key[0]), Face{{key[1], key[2]}, number++});
      }
  };
  for_each([&](std::size_t lowest, const Face&) { ++start[lowest + 1]; });
  for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
  std::vector<Face> faces(start.back());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for_each([&](std::size_t lowest, const Face& face) { faces[next[lowest]++] = face; });

  for (std::size_t v = 0; v + 1 < start.size(); ++v) {
    const auto first = faces.begin() + static_cast<std::ptrdiff_t>(start[v]);
    const auto last = faces.begin() + static_cast<std::ptrdiff_t>(start[v + 1]);
    std::sort(first, last, [](const Face& a, const Face& b) {
      // a strict order, so that the result is equal on every machine
      return a.others != b.others ? a.others < b.others : a.number < b.number;
    });
    for (auto face = first; face != last;) {
      auto other = face + 1;
      while (other != last && other->others == face->others) ++other;
      visit(std::span<const Face>(face, other));
      face = other;
    }
  }
}

/// Returns whether the outward order of a face's vertices is an even permutation of the ascending
/// one. The outward order is counter-clockwise seen from outside the tetrahedron.
bool is_even(const TetMesh& mesh, const Face& face) {
  const auto& tet = mesh.tets[face.number / 4];
  const auto& [i, j, k] = outward_faces[face.number % 4];
  return ((tet[i] < tet[j]) + (tet[j] < tet[k]) + (tet[k] < tet[i])) == 2;
}

const Point& vertex(const TriangleSurface& surface, int v) {
  return surface.vertices[static_cast<std::size_t>(v)];
}

}  // namespace

std::vector<std::size_t> overlap_at_a_face(const TetMesh& mesh) {
  std::vector<std::size_t> crowd, same_side;
  for_faces(mesh, [&](std::span<const Face> same) {
    if (same.size() > 2 && crowd.empty())
      crowd = {same[0].number / 4, same[1].number / 4, same[2].number / 4};
    else if (same.size() == 2 && same_side.empty() &&
             is_even(mesh, same[0]) == is_even(mesh, same[1]))
      same_side = {same[0].number / 4, same[1].number / 4};
  });
  return crowd.empty() ? same_side : crowd;
}

std::vector<std::array<int, 3>> boundary_triangles(const TetMesh& mesh) {
  std::vector<std::size_t> single;
  for_faces(mesh, [&](std::span<const Face> same) {
    if (same.size() == 1) single.push_back(same[0].number);
  });
  std::sort(single.begin(), single.end());
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(single.size());
  for (const std::size_t number : single) {
    const auto& tet = mesh.tets[number / 4];
    const auto& [i, j, k] = outward_faces[number % 4];
    triangles.push_back({tet[i], tet[j], tet[k]});
  }
  if (!mesh.inner_faces.empty())
    std::erase_if(triangles, [&](std::array<int, 3> triangle) {
      std::sort(triangle.begin(), triangle.end());
      return std::binary_search(mesh.inner_faces.begin(), mesh.inner_faces.end(), triangle);
    });
  return triangles;
}

BoundarySurface boundary_surface(const TetMesh& mesh) {
  BoundarySurface result;
  result.surface.triangles = boundary_triangles(mesh);
  std::vector<int> number(mesh.vertices.size(), -1);
  for (const auto& triangle : result.surface.triangles)
    for (const int v : triangle) number[static_cast<std::size_t>(v)] = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(result.mesh_vertex.size());
    result.mesh_vertex.push_back(static_cast<int>(v));
    result.surface.vertices.push_back(mesh.vertices[v]);
  }
  for (auto& triangle : result.surface.triangles)
    for (int& v : triangle) v = number[static_cast<std::size_t>(v)];
  return result;
}

double surface_area(const TriangleSurface& surface) {
  double sum = 0.0;
  for (const auto& [a, b, c] : surface.triangles) {
    const Point& p = vertex(surface, a);
    sum += (vertex(surface, b) - p).cross(vertex(surface, c) - p).norm() / 2.0;
  }
  return sum;
}

std::vector<double> areas_of_points(const TriangleSurface& surface) {
  std::vector<double> area(surface.vertices.size(), 0.0);
  for (const auto& t : surface.triangles) {
    const Point& p = vertex(surface, t[0]);
    const double part = (vertex(surface, t[1]) - p).cross(vertex(surface, t[2]) - p).norm() / 6.0;
    for (const int v : t) area[static_cast<std::size_t>(v)] += part;
  }
  return area;
}

std::vector<Point> normals_of_points(const TriangleSurface& surface) {
  std::vector<Point> normals(surface.vertices.size(), Point(Point::Zero()));
  for (const auto& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Point& p = vertex(surface, t[k]);
      const Point one = vertex(surface, t[(k + 1) % 3]) - p;
      const Point other = vertex(surface, t[(k + 2) % 3]) - p;
      const Point normal = one.cross(other);
      if (const double length = normal.norm(); length > 0)
        normals[static_cast<std::size_t>(t[k])] +=
            std::atan2(length, one.dot(other)) / length * normal;
    }
  for (Point& normal : normals)
    if (const double length = normal.norm(); length > 0) normal /= length;
  return normals;
}

double enclosed_volume(const TriangleSurface& surface) {
  if (surface.vertices.empty()) return 0.0;
  // The origin may be any point; a near one keeps the terms small
  const Point& origin = surface.vertices.front();
  double sum = 0.0;
  for (const auto& [a, b, c] : surface.triangles)
    sum += tet_volume(origin, vertex(surface, a), vertex(surface, b), vertex(surface, c));
  return sum;
}

void count_edges(const TriangleSurface& surface, SurfaceReport& report) {
  // vertices of each edge, ascending; true where the triangle has them in this order
  std::vector<std::pair<std::array<int, 2>, bool>> edges;
  edges.reserve(surface.triangles.size() * 3);
  for (const std::array<int, 3>& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      edges.push_back({{std::min(a, b), std::max(a, b)}, a < b});
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t e = 0, end = 0; e < edges.size(); e = end) {
    while (end < edges.size() && edges[end].first == edges[e].first) ++end;
    const bool sound = end == e + 2 && edges[e].second != edges[e + 1].second;
    if (!sound && report.closed())
      report.open_at =
          (vertex(surface, edges[e].first[0]) + vertex(surface, edges[e].first[1])) / 2;
    if (end == e + 1) ++report.open_edges;
    if (end > e + 2) ++report.crowded_edges;
    if (end == e + 2 && edges[e].second == edges[e + 1].second) ++report.inconsistent_edges;
  }
}

}  // namespace plica
