// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <plica/core/row_ranges.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/cut.hpp>
#include <tuple>
#include <utility>

namespace plica {

namespace {

using Tets = std::vector<std::array<int, 4>>;

/// A face as one of its two tetrahedra has it.
struct TetFace {
  std::array<int, 3> vertices;  // ascending
  std::int64_t number;          // 4 * tetrahedron + corner across

  bool operator<(const TetFace& o) const {
    return std::tie(vertices, number) < std::tie(o.vertices, o.number);
  }
};

/// Returns a face by its number: 4 * tetrahedron + corner across.
TetFace face_of(const Tets& tets, std::int64_t number) {
  TetFace face{{}, number};
  const auto tet = static_cast<std::size_t>(number / 4);
  const int across = static_cast<int>(number % 4);
  for (int k = 0, i = 0; k < 4; ++k)
    if (k != across) face.vertices[index_of(i++)] = tets[tet][index_of(k)];
  std::sort(face.vertices.begin(), face.vertices.end());
  return face;
}

/// Calls use(a, b) for every two sides of one face among these; a is that of the lower tetrahedron.
template <class Use>
void for_inner_faces(std::vector<TetFace> faces, const Use& use) {
  std::sort(faces.begin(), faces.end());
  for (std::size_t i = 1; i < faces.size(); ++i)
    if (faces[i].vertices == faces[i - 1].vertices) use(faces[i - 1].number, faces[i].number);
}

/// A triangle of a blade. Its normal does not depend on the order of the corners.
struct BladeTriangle {
  std::array<Point, 3> at;
  Point normal;

  explicit BladeTriangle(const std::array<Point, 3>& corners) : at(corners) {
    normal = (at[1] - at[0]).cross(at[2] - at[0]);
    const auto* first =
        std::find_if(normal.data(), normal.data() + 3, [](double c) { return c != 0; });
    if (first != normal.data() + 3 && *first < 0) std::swap(at[1], at[2]), normal = -normal;
  }

  /// Returns whether the line from p to q goes through the triangle. A point on its plane is on the
  /// side of the normal, so that a mesh with centroids on the plane is cut, too.
  bool crosses(const Point& p, const Point& q) const {
    constexpr double rounding = 1e-12;  // part of the triangle's area
    const double from = normal.dot(p - at[0]), to = normal.dot(q - at[0]);
    if ((from >= 0) == (to >= 0)) return false;
    const Point x = p + from / (from - to) * (q - p);
    const double area = normal.squaredNorm();
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &a = at[k], &b = at[(k + 1) % 3];
      if ((b - a).cross(x - a).dot(normal) < -rounding * area) return false;
    }
    return true;
  }
};

bool are_apart(const Box& a, const Box& b) {
  return (a.min.array() > b.max.array()).any() || (b.min.array() > a.max.array()).any();
}

/// Groups of numbers that are joined pair by pair.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  /// Returns the lowest number of a group.
  int of(int i) {
    while (parent_[index_of(i)] != i)
      i = parent_[index_of(i)] = parent_[index_of(parent_[index_of(i)])];
    return i;
  }
  void join(int i, int j) {
    i = of(i), j = of(j);
    parent_[index_of(std::max(i, j))] = std::min(i, j);
  }

 private:
  std::vector<int> parent_;
};

/// Adds to named sets the new vertices of their own.
void follow_sets(TetMesh& mesh, int before, const std::vector<int>& twin) {
  for (auto& [name, set] : mesh.vertex_sets) {
    const std::vector<int> old = set;
    for (std::size_t i = 0; i < twin.size(); ++i)
      if (std::binary_search(old.begin(), old.end(), twin[i]))
        set.push_back(before + static_cast<int>(i));
  }
}

/// Replaces named triangles by the faces that they have become. `around`: the tetrahedra at all
/// vertices that may have split.
void follow_triangles(TetMesh& mesh, const Tets& before, const std::vector<int>& around) {
  if (mesh.triangle_sets.empty()) return;
  // faces of these tetrahedra: as they were, and as they are
  std::vector<std::pair<std::array<int, 3>, std::array<int, 3>>> faces;
  for (const int tet : around)
    for (std::int64_t face = std::int64_t{4} * tet, end = face + 4; face < end; ++face)
      faces.emplace_back(face_of(before, face).vertices, face_of(mesh.tets, face).vertices);
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  for (auto& [name, set] : mesh.triangle_sets) {
    std::vector<std::array<int, 3>> now;
    for (const auto& triangle : set) {
      std::array<int, 3> key = triangle;
      std::sort(key.begin(), key.end());
      auto face = std::lower_bound(faces.begin(), faces.end(), std::pair(key, std::array{0, 0, 0}));
      if (face == faces.end() || face->first != key) now.push_back(triangle);
      for (; face != faces.end() && face->first == key; ++face) now.push_back(face->second);
    }
    set = std::move(now);
  }
}

}  // namespace

Faces faces_across(const Tets& tets, const std::vector<Point>& positions, const Blade& blade) {
  std::vector<BladeTriangle> triangles;
  std::vector<Point> corners;
  for (const auto& at : blade) {
    const BladeTriangle one(at);
    if (!(one.normal.squaredNorm() > 0)) continue;
    triangles.push_back(one);
    corners.insert(corners.end(), at.begin(), at.end());
  }
  if (triangles.empty()) return {};
  const Box around = bounding_box(corners);
  std::vector<TetFace> near;
  std::vector<Box> boxes(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    boxes[i] = bounding_box(std::vector<Point>(triangles[i].at.begin(), triangles[i].at.end()));
  for (std::size_t e = 0; e < tets.size(); ++e) {
    Box box{positions[index_of(tets[e][0])], positions[index_of(tets[e][0])]};
    for (const int v : tets[e]) {
      box.min = box.min.cwiseMin(positions[index_of(v)]);
      box.max = box.max.cwiseMax(positions[index_of(v)]);
    }
    // A line between two centroids may leave both tetrahedra, by less than one of them is large.
    const Point size = box.max - box.min;
    box.min -= size, box.max += size;
    if (!are_apart(box, around))
      for (std::size_t k = 0; k < 4; ++k)
        near.push_back(face_of(tets, static_cast<std::int64_t>(4 * e + k)));
  }
  const auto centroid = [&](std::int64_t face) {
    Point sum = Point::Zero();
    for (const int v : tets[static_cast<std::size_t>(face / 4)]) sum += positions[index_of(v)];
    return Point(sum / 4);
  };
  Faces opened;
  for_inner_faces(std::move(near), [&](std::int64_t a, std::int64_t b) {
    const Point p = centroid(a), q = centroid(b);
    const Box line{p.cwiseMin(q), p.cwiseMax(q)};
    for (std::size_t i = 0; i < triangles.size(); ++i)
      if (!are_apart(line, boxes[i]) && triangles[i].crosses(p, q)) {
        opened.push_back(a);
        break;
      }
  });
  std::sort(opened.begin(), opened.end());
  return opened;
}

CutMesh open_faces(const TetMesh& mesh, const Faces& open) {
  CutMesh cut{mesh, {}};
  std::vector<char> touched(mesh.vertices.size(), 0);
  for (const std::int64_t face : open)
    for (const int v : face_of(mesh.tets, face).vertices) touched[index_of(v)] = 1;
  // corners of tetrahedra at these vertices, 4 tet + corner, and the faces there
  std::vector<std::pair<int, std::size_t>> corners;  // vertex, corner
  std::vector<int> place(4 * mesh.tets.size(), -1);
  std::vector<int> around;
  std::vector<TetFace> faces;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    bool any = false;
    for (std::size_t k = 0; k < 4; ++k)
      if (const int v = mesh.tets[e][k]; touched[index_of(v)] != 0)
        corners.emplace_back(v, 4 * e + k), any = true;
    if (!any) continue;
    around.push_back(static_cast<int>(e));
    for (std::size_t k = 0; k < 4; ++k)
      faces.push_back(face_of(mesh.tets, static_cast<std::int64_t>(4 * e + k)));
  }
  std::sort(corners.begin(), corners.end());
  for (std::size_t i = 0; i < corners.size(); ++i) place[corners[i].second] = static_cast<int>(i);
  Groups groups(corners.size());
  const auto place_of = [&](std::int64_t face, int v) {
    const auto e = static_cast<std::size_t>(face / 4);
    const auto& tet = mesh.tets[e];
    const auto corner = std::find(tet.begin(), tet.end(), v) - tet.begin();
    return place[4 * e + static_cast<std::size_t>(corner)];
  };
  for_inner_faces(std::move(faces), [&](std::int64_t a, std::int64_t b) {
    if (std::binary_search(open.begin(), open.end(), a)) return;
    for (const int v : face_of(mesh.tets, a).vertices)
      if (touched[index_of(v)] != 0) groups.join(place_of(a, v), place_of(b, v));
  });
  std::vector<int> number(corners.size());  // vertex of each group, at its lowest corner
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto [v, corner] = corners[i];
    const int group = groups.of(static_cast<int>(i));
    const bool first = i == 0 || corners[i - 1].first != v;
    if (group == static_cast<int>(i) && !first) {
      number[i] = static_cast<int>(cut.mesh.vertices.size());
      cut.mesh.vertices.push_back(mesh.vertices[index_of(v)]);
      cut.twin.push_back(v);
    } else if (first) {
      number[i] = v;
    }
    cut.mesh.tets[corner / 4][corner % 4] = number[index_of(group)];
  }
  follow_sets(cut.mesh, static_cast<int>(mesh.vertices.size()), cut.twin);
  follow_triangles(cut.mesh, mesh.tets, around);
  return cut;
}

int count_pieces(const TetMesh& mesh) {
  Groups groups(mesh.vertices.size());
  for (const auto& tet : mesh.tets)
    for (const int v : tet) groups.join(tet[0], v);
  int pieces = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    pieces += groups.of(static_cast<int>(v)) == static_cast<int>(v) ? 1 : 0;
  return pieces;
}

std::vector<int> boundary_vertices_of(const TriangleSurface& surface, const TetMesh& mesh) {
  const BoundarySurface boundary = boundary_surface(mesh);
  if (boundary.surface.triangles.size() != surface.triangles.size()) return {};
  using Place = std::tuple<double, double, double>;
  const auto place = [](const Point& p) { return Place(p[0], p[1], p[2]); };
  std::vector<std::pair<Place, int>> at;
  for (std::size_t i = 0; i < boundary.mesh_vertex.size(); ++i)
    at.emplace_back(place(boundary.surface.vertices[i]), boundary.mesh_vertex[i]);
  std::sort(at.begin(), at.end());
  const auto at_one_place = [](const auto& a, const auto& b) { return a.first == b.first; };
  if (std::adjacent_find(at.begin(), at.end(), at_one_place) != at.end()) return {};
  std::vector<int> vertex;
  for (const Point& p : surface.vertices) {
    const auto found = std::lower_bound(at.begin(), at.end(), std::pair(place(p), -1));
    if (found == at.end() || found->first != place(p)) return {};
    vertex.push_back(found->second);
  }
  return vertex;
}

void follow_cut(const TetMesh& mesh, TriangleSurface& surface, std::vector<int>& vertex) {
  std::vector<int> point(mesh.vertices.size(), -1);
  for (std::size_t p = 0; p < vertex.size(); ++p) point[index_of(vertex[p])] = static_cast<int>(p);
  surface.triangles = boundary_triangles(mesh);
  surface.texture.clear();
  std::vector<char> is_new(mesh.vertices.size(), 0);
  for (const auto& triangle : surface.triangles)
    for (const int v : triangle) is_new[index_of(v)] = point[index_of(v)] < 0 ? 1 : 0;
  for (std::size_t v = 0; v < is_new.size(); ++v) {
    if (is_new[v] == 0) continue;
    point[v] = static_cast<int>(vertex.size());
    vertex.push_back(static_cast<int>(v)), surface.vertices.push_back(mesh.vertices[v]);
  }
  for (auto& triangle : surface.triangles)
    for (int& v : triangle) v = point[index_of(v)];
}

Embedding embed_at_vertices(const TetMesh& mesh, const std::vector<int>& vertex) {
  std::vector<std::size_t> corner(mesh.vertices.size());  // 4 * tetrahedron + corner
  for (std::size_t e = mesh.tets.size(); e-- > 0;)
    for (std::size_t k = 0; k < 4; ++k) corner[index_of(mesh.tets[e][k])] = 4 * e + k;
  Embedding embedding;
  embedding.outside.resize(vertex.size(), 0);
  for (const int v : vertex) {
    const std::size_t at = corner[index_of(v)];
    embedding.vertices.push_back(mesh.tets[at / 4]);
    embedding.weights.push_back({});
    embedding.weights.back()[at % 4] = 1;
  }
  return embedding;
}

}  // namespace plica
