// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <unsupported/Eigen/BVH>
#include <utility>

namespace plica {

namespace {

constexpr std::array<std::array<std::size_t, 2>, 6> corner_pairs = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

double length(const TetMesh& mesh, int a, int b) {
  return (mesh.vertices[static_cast<std::size_t>(b)] - mesh.vertices[static_cast<std::size_t>(a)])
      .norm();
}

// Returns the edges, sorted. A counting sort by the lower vertex, then a sort within each vertex,
// is several times faster than one sort of all.
template <std::size_t corners>
std::vector<std::array<int, 2>> edges_of(const std::vector<std::array<int, corners>>& cells,
                                         std::size_t vertices) {
  std::vector<std::size_t> start(vertices + 1, 0);
  const auto for_each = [&](auto visit) {
    for (const auto& cell : cells)
      for (std::size_t i = 0; i < corners; ++i)
        for (std::size_t j = i + 1; j < corners; ++j)
          visit(std::min(cell[i], cell[j]), std::max(cell[i], cell[j]));
  };
  for_each([&](int low, int) { ++start[static_cast<std::size_t>(low) + 1]; });
  for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
  std::vector<int> highs(start.back());
  std::vector<std::size_t> next(start.begin(), start.end() - 1);
  for_each([&](int low, int high) { highs[next[static_cast<std::size_t>(low)]++] = high; });

  std::vector<std::array<int, 2>> edges;
  edges.reserve(highs.size() / 4);
  for (std::size_t v = 0; v + 1 < start.size(); ++v) {
    const auto first = highs.begin() + static_cast<std::ptrdiff_t>(start[v]);
    const auto last = highs.begin() + static_cast<std::ptrdiff_t>(start[v + 1]);
    std::sort(first, last);
    std::for_each(first, std::unique(first, last), [&](int high) {
      edges.push_back({static_cast<int>(v), high});
    });
  }
  return edges;
}

}  // namespace

std::vector<std::array<int, 2>> mesh_edges(const TetMesh& mesh) {
  return edges_of(mesh.tets, mesh.vertices.size());
}

std::vector<std::array<int, 2>> mesh_edges(const TriangleSurface& surface) {
  return edges_of(surface.triangles, surface.vertices.size());
}

std::vector<double> local_edge_lengths(const TetMesh& mesh) {
  std::vector<double> sums(mesh.vertices.size(), 0.0);
  std::vector<int> counts(mesh.vertices.size(), 0);
  for (const auto& edge : mesh_edges(mesh)) {
    const double l = length(mesh, edge[0], edge[1]);
    for (const int v : edge)
      sums[static_cast<std::size_t>(v)] += l, ++counts[static_cast<std::size_t>(v)];
  }
  for (std::size_t v = 0; v < sums.size(); ++v) sums[v] /= std::max(1, counts[v]);
  return sums;
}

double mean_edge_length(const TetMesh& mesh) {
  const auto edges = mesh_edges(mesh);
  double sum = 0.0;
  for (const auto& [a, b] : edges) sum += length(mesh, a, b);
  return edges.empty() ? 0.0 : sum / static_cast<double>(edges.size());
}

double mean_edge_length(const TetMesh& mesh, int tet) {
  const auto& v = mesh.tets[static_cast<std::size_t>(tet)];
  double sum = 0.0;
  for (const auto& [i, j] : corner_pairs) sum += length(mesh, v[i], v[j]);
  return sum / 6.0;
}

namespace {

using Volume = Eigen::AlignedBox3d;

// Returns the lowest vertex known to be of v's part (union-find); paths are halved on the way
int root(std::vector<int>& parent, int v) {
  const auto at = [&](int i) -> int& { return parent[static_cast<std::size_t>(i)]; };
  while (at(v) != v) v = at(v) = at(at(v));
  return v;
}

template <std::size_t corners>
std::vector<int> parts_of(std::size_t vertices,
                          const std::vector<std::array<int, corners>>& elements) {
  std::vector<int> parent(vertices);
  std::iota(parent.begin(), parent.end(), 0);
  for (const auto& element : elements)
    for (std::size_t k = 1; k < corners; ++k) {
      const int a = root(parent, element[0]), b = root(parent, element[k]);
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  for (std::size_t v = 0; v < vertices; ++v) parent[v] = root(parent, static_cast<int>(v));
  return parent;
}

template <std::size_t corners>
int count_parts(std::size_t vertices, const std::vector<std::array<int, corners>>& elements) {
  const std::vector<int> part = parts_of(vertices, elements);
  std::vector<int> roots;
  for (const auto& element : elements) roots.push_back(part[static_cast<std::size_t>(element[0])]);
  std::sort(roots.begin(), roots.end());
  return static_cast<int>(std::unique(roots.begin(), roots.end()) - roots.begin());
}

struct LowerTwin {
  const std::vector<Point>& points;
  int self;
  double tolerance;
  int found = -1;

  bool intersectVolume(const Volume& box) const {
    return box.squaredExteriorDistance(points[static_cast<std::size_t>(self)]) <=
           tolerance * tolerance;
  }
  bool intersectObject(int other) {
    const Point& p = points[static_cast<std::size_t>(self)];
    if (other >= self || (points[static_cast<std::size_t>(other)] - p).norm() > tolerance)
      return false;
    found = other;
    return true;
  }
};

}  // namespace

std::vector<int> parts_of(const TetMesh& mesh) { return parts_of(mesh.vertices.size(), mesh.tets); }

int count_parts(const TetMesh& mesh) { return count_parts(mesh.vertices.size(), mesh.tets); }

int count_parts(const TriangleSurface& surface) {
  return count_parts(surface.vertices.size(), surface.triangles);
}

std::vector<int> lower_twins(const std::vector<Point>& points, double tolerance) {
  std::vector<int> vertices(points.size());
  std::iota(vertices.begin(), vertices.end(), 0);
  std::vector<Volume> boxes;
  for (const Point& p : points) boxes.emplace_back(p, p);
  const Eigen::KdBVH<double, 3, int> tree(vertices.begin(), vertices.end(), boxes.begin(),
                                          boxes.end());
  std::vector<int> twins;
  for (const int v : vertices) {
    LowerTwin twin{points, v, tolerance};
    Eigen::BVIntersect(tree, twin);
    twins.push_back(twin.found);
  }
  return twins;
}

int count_duplicate_vertices(const TetMesh& mesh, double tolerance) {
  const std::vector<int> twins = lower_twins(mesh.vertices, tolerance);
  return static_cast<int>(
      std::count_if(twins.begin(), twins.end(), [](int twin) { return twin >= 0; }));
}

namespace {

constexpr std::size_t worst_count = 10;
constexpr double duplicate_tolerance = 1e-9;  // relative to the mean edge

// Returns the angles between the faces at the six edges [degree]. `areas`: outward area vectors of
// the faces across each corner.
std::array<double, 6> dihedral_angles(const std::array<Point, 4>& areas) {
  std::array<double, 6> angles;
  std::size_t n = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      const double between = std::atan2(areas[i].cross(areas[j]).norm(), areas[i].dot(areas[j]));
      angles[n++] = 180.0 - between * 180.0 / std::numbers::pi;
    }
  return angles;
}

// Returns for each corner the outward area vector of the face across it [m^2]
std::array<Point, 4> face_areas(const std::array<Point, 4>& c) {
  const auto area = [&](const Point& p, const Point& q, const Point& r) -> Point {
    return (q - p).cross(r - p) / 2.0;
  };
  return {area(c[1], c[2], c[3]), area(c[0], c[3], c[2]), area(c[0], c[1], c[3]),
          area(c[0], c[2], c[1])};
}

struct Shape {
  TetShape summary;
  std::array<double, 6> angles;
};

Shape shape_of(const TetMesh& mesh, int tet) {
  const auto corners = corners_of(mesh, tet);
  const auto areas = face_areas(corners);
  double longest = 0.0, largest_face = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    largest_face = std::max(largest_face, areas[i].norm());
    for (std::size_t j = i + 1; j < 4; ++j)
      longest = std::max(longest, (corners[j] - corners[i]).norm());
  }
  Shape shape = {{}, dihedral_angles(areas)};
  TetShape& s = shape.summary;
  s.tet = tet;
  s.volume = tet_volume(corners[0], corners[1], corners[2], corners[3]);
  // The smallest height stands on the largest face
  s.height_ratio = longest * largest_face / (3.0 * s.volume);
  const auto [least, most] = std::minmax_element(shape.angles.begin(), shape.angles.end());
  s.smallest_angle = *least, s.largest_angle = *most;
  s.centroid = (corners[0] + corners[1] + corners[2] + corners[3]) / 4.0;
  return shape;
}

// Gathers a Range one value at a time
class Extent {
 public:
  void add(double value) {
    min_ = std::min(min_, value), max_ = std::max(max_, value);
    sum_ += value, ++count_;
  }
  Range range() const {
    return count_ == 0 ? Range{} : Range{min_, sum_ / static_cast<double>(count_), max_};
  }

 private:
  double min_ = std::numeric_limits<double>::infinity(), max_ = -min_, sum_ = 0.0;
  std::size_t count_ = 0;
};

Range range_of(const std::vector<std::array<int, 2>>& edges, const std::vector<Point>& vertices) {
  Extent extent;
  const auto at = [&](int v) -> const Point& { return vertices[static_cast<std::size_t>(v)]; };
  for (const auto& [a, b] : edges) extent.add((at(b) - at(a)).norm());
  return extent.range();
}

bool worse(const TetShape& a, const TetShape& b) {
  return a.height_ratio != b.height_ratio ? a.height_ratio > b.height_ratio : a.tet < b.tet;
}

void keep_if_among_worst(const TetShape& shape, std::vector<TetShape>& worst) {
  if (worst.size() == worst_count && !worse(shape, worst.back())) return;
  worst.insert(std::upper_bound(worst.begin(), worst.end(), shape, worse), shape);
  if (worst.size() > worst_count) worst.pop_back();
}

void measure_tets(const TetMesh& mesh, MeshQuality& quality) {
  for (const std::string& name : mesh.region_names) quality.regions.push_back({name});
  if (mesh.region.empty()) quality.regions.assign(1, {});
  Extent ratios, angles;
  for (int t = 0; t < quality.tets; ++t) {
    const Shape shape = shape_of(mesh, t);
    ratios.add(shape.summary.height_ratio);
    quality.height_ratio_counts.add(shape.summary.height_ratio);
    for (const double angle : shape.angles)
      angles.add(angle), quality.dihedral_angle_counts.add(angle);
    quality.volume += shape.summary.volume;
    const int region = mesh.region.empty() ? 0 : mesh.region[static_cast<std::size_t>(t)];
    RegionSize& size = quality.regions[static_cast<std::size_t>(region)];
    size.volume += shape.summary.volume, ++size.tets;
    keep_if_among_worst(shape.summary, quality.worst);
  }
  quality.height_ratios = ratios.range();
  quality.dihedral_angles = angles.range();
}

}  // namespace

Histogram::Histogram(std::vector<double> interval_bounds)
    : bounds(std::move(interval_bounds)), counts(bounds.size() - 1, 0) {}

void Histogram::add(double value) {
  const auto above = std::upper_bound(bounds.begin() + 1, bounds.end() - 1, value);
  ++counts[static_cast<std::size_t>(above - bounds.begin() - 1)];
}

Range edge_range(const TetMesh& mesh) { return range_of(mesh_edges(mesh), mesh.vertices); }

Range edge_range(const TriangleSurface& surface) {
  return range_of(mesh_edges(surface), surface.vertices);
}

TetShape tet_shape(const TetMesh& mesh, int tet) { return shape_of(mesh, tet).summary; }

MeshQuality mesh_quality(const TetMesh& mesh) {
  MeshQuality quality;
  quality.vertices = static_cast<int>(mesh.vertices.size());
  quality.tets = static_cast<int>(mesh.tets.size());
  const TriangleSurface boundary = boundary_surface(mesh).surface;
  quality.boundary_triangles = static_cast<int>(boundary.triangles.size());
  quality.boundary_area = surface_area(boundary);
  quality.box = bounding_box(mesh.vertices);
  quality.edges = edge_range(mesh);
  quality.parts = count_parts(mesh);
  quality.duplicate_vertices =
      count_duplicate_vertices(mesh, duplicate_tolerance * quality.edges.mean);
  measure_tets(mesh, quality);
  return quality;
}

}  // namespace plica
