// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <optional>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/files/parsed_mesh.hpp>
#include <plica/meshes/files/validated_mesh.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/weld_open_edges.hpp>
#include <utility>

namespace plica {

namespace {

constexpr double flat_triangle = 1e-12;       // twice the area over the longest edge squared
constexpr std::int64_t most_bad_faces = 100;  // one face in this many may be invalid

using Triangle = std::array<int, 3>;

// Corner of a face: its vertex, and the index of its texture coordinates, -1 without any
struct FaceCorner {
  int vertex;
  int texture;
};

class SurfaceMaker {
 public:
  SurfaceMaker(const ParsedMesh& raw, TriangleSurface& surface, SurfaceReport& report)
      : raw_(raw), numbering_(raw), surface_(surface), report_(report), bad_(raw.bad_faces) {
    for (const RawVertex& vertex : raw.vertices) surface.vertices.push_back(vertex.position);
  }

  // Adds the triangles. Their vertices are indices in raw.vertices: vertices of no triangle are
  // dropped later.
  void make() {
    for (const RawMention& mention : raw_.others)
      numbering_.at(mention.vertex, mention.place, [] { return std::string("an element"); });
    for (std::size_t i = 0; i < raw_.triangles.size(); ++i) {
      const RawTriangle& t = raw_.triangles[i];
      std::span<const int> texture;
      if (!raw_.triangle_texture.empty()) texture = raw_.triangle_texture[i];
      if (const auto v = corners(t.tag, t.vertices, texture, t.place))
        triangle((*v)[0], (*v)[1], (*v)[2], t.tag, t.place);
    }
    for (const RawPolygon& p : raw_.polygons)
      if (const auto v = corners(p.tag, p.corners, p.texture, p.place)) polygon(*v, p);
    const auto faces = static_cast<std::int64_t>(raw_.triangles.size() + raw_.polygons.size()) +
                       raw_.bad_faces.count;
    if (bad_.count * most_bad_faces > faces || (surface_.triangles.empty() && bad_.count > 0))
      refuse(
          raw_.file, bad_.place,
          bad_.message + (bad_.count == 1
                              ? ""
                              : "; " + std::to_string(bad_.count) + " of " + std::to_string(faces) +
                                    " faces are bad, and more than 1 % is too much"));
    report_.left_out = bad_.count;
    if (surface_.triangles.empty())
      refuse(raw_.file, Place{}, "all triangles of the file name a vertex twice");
  }

 private:
  std::optional<std::vector<FaceCorner>> corners(std::int64_t tag,
                                                 std::span<const std::int64_t> tags,
                                                 std::span<const int> texture, const Place& place) {
    const auto who = [&] {
      return (tags.size() == 3 ? "triangle " : "face ") + std::to_string(tag);
    };
    std::vector<FaceCorner> v;
    for (std::size_t k = 0; k < tags.size(); ++k) {
      v.push_back({numbering_.find(tags[k]), texture.empty() ? -1 : texture[k]});
      if (v.back().vertex >= 0) continue;
      bad_.add(place, who() + " names node " + std::to_string(tags[k]) +
                          ", which the file does not define");
      return {};
    }
    return v;
  }

  const Point& at(const FaceCorner& c) const {
    return surface_.vertices[static_cast<std::size_t>(c.vertex)];
  }
  std::array<double, 2> texture_at(const FaceCorner& c) const {
    const auto i = static_cast<std::size_t>(c.texture);
    return c.texture >= 0 && i < raw_.texture.size() ? raw_.texture[i] : std::array{0.0, 0.0};
  }
  static bool same(const FaceCorner& a, const FaceCorner& b) { return a.vertex == b.vertex; }

  void triangle(const FaceCorner& a, const FaceCorner& b, const FaceCorner& c, std::int64_t tag,
                const Place& place) {
    if (same(a, b) || same(b, c) || same(c, a)) {
      ++report_.collapsed;
      return;
    }
    const Point ab = at(b) - at(a), ac = at(c) - at(a);
    const double longest = std::max({ab.norm(), ac.norm(), (at(c) - at(b)).norm()});
    if (!(ab.cross(ac).norm() > flat_triangle * longest * longest))
      return bad_.add(
          place, "triangle " + std::to_string(tag) + " has no area: its vertices lie on a line");
    surface_.triangles.push_back({a.vertex, b.vertex, c.vertex});
    if (!raw_.texture.empty())
      surface_.texture.push_back({texture_at(a), texture_at(b), texture_at(c)});
  }

  // Returns the normal of a triangle, twice its area long. Its corners are `first` and those k and
  // k + 1 after it.
  Point area(const std::vector<FaceCorner>& v, std::size_t first, std::size_t k) const {
    const auto corner = [&](std::size_t i) -> const Point& {
      return at(v[(first + i) % v.size()]);
    };
    return (corner(k) - corner(0)).cross(corner(k + 1) - corner(0));
  }

  // Cuts a polygon into triangles that all look to one side, from the first corner for which that
  // is possible
  void polygon(std::vector<FaceCorner> v, const RawPolygon& face) {
    v.erase(std::unique(v.begin(), v.end(), same), v.end());
    while (v.size() > 1 && same(v.front(), v.back())) v.pop_back();
    if (v.size() < 3) {
      ++report_.collapsed;
      return;
    }
    Point sum = Point::Zero();
    for (std::size_t k = 1; k + 1 < v.size(); ++k) sum += area(v, 0, k);
    for (std::size_t first = 0; first < v.size(); ++first) {
      bool one_side = true;
      for (std::size_t k = 1; k + 1 < v.size(); ++k)
        one_side = one_side && area(v, first, k).dot(sum) > 0.0;
      if (!one_side) continue;
      for (std::size_t k = 1; k + 1 < v.size(); ++k)
        triangle(v[first], v[(first + k) % v.size()], v[(first + k + 1) % v.size()], face.tag,
                 face.place);
      return;
    }
    bad_.add(face.place, "a face with " + std::to_string(v.size()) +
                             " corners cannot be cut into triangles from one of them");
  }

  const ParsedMesh& raw_;
  const VertexNumbers numbering_;
  TriangleSurface& surface_;
  SurfaceReport& report_;
  BadFaces bad_;
};

// Returns the triangle with its smallest vertex first, in its orientation
Triangle turned(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

// Drops triangles that repeat an earlier one in the same orientation; the others keep their order
void drop_repeats(TriangleSurface& surface, SurfaceReport& report) {
  std::vector<std::size_t> order(surface.triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t t) { return turned(surface.triangles[t]); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  std::vector<bool> again(order.size(), false);
  for (std::size_t k = 1; k < order.size(); ++k)
    again[order[k]] = key(order[k]) == key(order[k - 1]);
  std::size_t kept = 0;
  for (std::size_t t = 0; t < again.size(); ++t) {
    if (again[t]) continue;
    if (!surface.texture.empty()) surface.texture[kept] = surface.texture[t];
    surface.triangles[kept++] = surface.triangles[t];
  }
  report.repeated = static_cast<int>(surface.triangles.size() - kept);
  surface.triangles.resize(kept);
  if (!surface.texture.empty()) surface.texture.resize(kept);
}

void drop_unreferenced(TriangleSurface& surface, SurfaceReport& report) {
  std::vector<int> number(surface.vertices.size(), -1);
  for (const Triangle& triangle : surface.triangles)
    for (const int v : triangle) number[static_cast<std::size_t>(v)] = 0;
  std::size_t kept = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(kept);
    surface.vertices[kept++] = surface.vertices[v];
  }
  report.unreferenced = static_cast<int>(surface.vertices.size() - kept);
  surface.vertices.resize(kept);
  for (Triangle& triangle : surface.triangles)
    for (int& v : triangle) v = number[static_cast<std::size_t>(v)];
}

}  // namespace

TriangleSurface validated_surface(const ParsedMesh& raw, const MeshReport& found,
                                  SurfaceReport& report, double weld) {
  if (raw.triangles.empty() && raw.polygons.empty() && raw.bad_faces.count == 0)
    refuse(raw.file, Place{}, "the file holds no triangle");
  checked_count("the number of vertices", static_cast<double>(raw.vertices.size()));
  checked_count("the number of triangles", static_cast<double>(raw.triangles.size()));
  report.format = found.format;
  report.linearised = found.linearised;
  report.notes = found.notes;
  TriangleSurface surface;
  SurfaceMaker(raw, surface, report).make();
  drop_repeats(surface, report);
  drop_unreferenced(surface, report);
  count_edges(surface, report);
  if (weld > 0.0 && report.open_edges > 0) {
    const Box box = bounding_box(surface.vertices);
    report.welded = weld_open_edges(surface, weld * (box.max - box.min).norm());
    const int unused = report.unreferenced;
    drop_unreferenced(surface, report);  // corners of slivers that the weld has closed
    report.unreferenced = unused;
    report.open_edges = report.crowded_edges = report.inconsistent_edges = 0;
    count_edges(surface, report);
  }
  report.parts = count_parts(surface);
  report.turned = report.closed() && enclosed_volume(surface) < 0.0;
  if (report.turned) {
    for (Triangle& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
    for (CornerTexture& corners : surface.texture) std::swap(corners[1], corners[2]);
  }
  return surface;
}

}  // namespace plica
