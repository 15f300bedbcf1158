// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <functional>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/cell_contents.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/lattice.hpp>
#include <plica/meshes/signed_distance.hpp>

namespace plica {

namespace {

constexpr double most_cells = 8e6;
// Scale of a cube in the overlap test: a face that only touches a cube is not in it
constexpr double inner_part = 1 - 1e-6;
constexpr int fewest_vertices = 30;
constexpr double least_part = 0.02;  // least fraction of a tetrahedron that is body

// Returns whether a triangle reaches into a cube around the origin with edges of 2 `half`. It does
// if none of 13 planes separates them (Akenine-Moeller, Fast 3D triangle-box overlap testing,
// Journal of Graphics Tools 6, 2001).
bool reaches_into(const std::array<Point, 3>& t, double half) {
  const auto apart = [&](const Point& axis) {
    const double a = t[0].dot(axis), b = t[1].dot(axis), c = t[2].dot(axis),
                 reach = half * axis.lpNorm<1>();
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  for (int i = 0; i < 3; ++i)
    if (apart(Point::Unit(i))) return false;
  for (std::size_t k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i)
      if (apart((t[(k + 1) % 3] - t[k]).cross(Point::Unit(i)))) return false;
  return !apart((t[1] - t[0]).cross(t[2] - t[0]));
}

}  // namespace

void check_cell_size(const std::vector<Point>& points, double size) {
  const Box box = bounding_box(points);
  const Point extent = box.max - box.min;
  if (size > extent.maxCoeff())
    throw InputError(text("the size of cells, ", number(size), " m, is larger than the body, ",
                          number(extent[0], 4), " x ", number(extent[1], 4), " x ",
                          number(extent[2], 4), " m"));
}

namespace {

class Lattice {
 public:
  Lattice(const std::vector<Point>& points, double size)
      : size_(checked_size("the size of cells", size)) {
    for (const Point& p : points) checked_point("a vertex of the surface", p);
    const Box box = bounding_box(points);
    const Point extent = box.max - box.min;
    check_cell_size(points, size);
    double all = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const double along = std::max(1.0, std::ceil(extent[static_cast<int>(a)] / size - 1e-6));
      all *= along;
      cells_[a] = static_cast<int>(std::min(along, most_cells));
    }
    if (all > most_cells)
      throw InputError(text("the size of cells, ", number(size), " m, makes ", number(all),
                            " of them in the body's bounding box; ", number(most_cells),
                            " at most"));
    const Point edges = size * Point(cells_[0], cells_[1], cells_[2]);
    low_ = (box.min + box.max - edges) / 2;
    marked_.assign(static_cast<std::size_t>(all), false);
  }

  void mark(const TriangleSurface& surface) {
    for (const auto& triangle : surface.triangles) {
      std::array<Point, 3> t;
      for (std::size_t k = 0; k < 3; ++k)
        t[k] = (surface.vertices[static_cast<std::size_t>(triangle[k])] - low_) / size_;
      const Point from = t[0].cwiseMin(t[1]).cwiseMin(t[2]),
                  to = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
      std::array<int, 3> first, last;
      for (std::size_t a = 0; a < 3; ++a) {
        const auto cell = [&](double x) {
          return static_cast<int>(std::clamp(std::floor(x), 0.0, cells_[a] - 1.0));
        };
        first[a] = cell(from[static_cast<int>(a)] - 1e-6),
        last[a] = cell(to[static_cast<int>(a)] + 1e-6);
      }
      for (int k = first[2]; k <= last[2]; ++k)
        for (int j = first[1]; j <= last[1]; ++j)
          for (int i = first[0]; i <= last[0]; ++i) {
            const Point centre(i + 0.5, j + 0.5, k + 0.5);
            if (!marked_[index(i, j, k)] &&
                reaches_into({t[0] - centre, t[1] - centre, t[2] - centre}, inner_part / 2))
              marked_[index(i, j, k)] = true;
          }
    }
  }

  // Keeps the cells that are inside or that the surface reaches into. Two neighbours that the
  // surface does not reach into are on one side of it: only the first one is tested.
  void fill(const std::function<bool(const Point&)>& inside) {
    kept_ = marked_;
    for_cells([&](int i, int j, int k) {
      const std::size_t c = index(i, j, k);
      if (marked_[c]) return;
      kept_[c] = i > 0 && !marked_[c - 1] ? kept_[c - 1]
                                          : inside(low_ + size_ * Point(i + 0.5, j + 0.5, k + 0.5));
    });
  }

  // Returns the fraction of each tetrahedron of mesh() that is body, and drops almost empty cells.
  // An element that is connected to such a cell only would turn inside out long before the body
  // does. Adds the number of cells with several parts of the body to `shared`.
  std::vector<double> filled(const TriangleSurface& surface, int& shared) {
    const CellContents contents(surface, low_, size_, cells_);
    std::vector<double> parts;
    for_cells([&](int i, int j, int k) {
      const std::size_t c = index(i, j, k);
      if (!kept_[c]) return;
      if (!marked_[c]) return void(parts.insert(parts.end(), 6, 1.0));
      const CellContents::Contents here = contents.of(i, j, k);
      // sum over the cell's tetrahedra, and of the fractions above the least one
      double whole = 0, above = 0;
      for (const double part : here.filled)
        whole += part, above += std::max(part - least_part, 0.0);
      kept_[c] = whole > 6 * least_part;
      if (!kept_[c]) return;
      for (const double part : here.filled)  // the sum over the cell stays
        parts.push_back(std::min(
            1.0, least_part + std::max(part - least_part, 0.0) * (whole - 6 * least_part) / above));
      shared += here.parts > 1;
    });
    return parts;
  }

  // Returns the six tetrahedra of each cell that is kept, cell after cell
  TetMesh mesh() const {
    const TetMesh box =
        box_mesh({low_, low_ + size_ * Point(cells_[0], cells_[1], cells_[2])}, cells_);
    TetMesh mesh;
    std::vector<int> number(box.vertices.size(), -1);
    for (std::size_t t = 0; t < box.tets.size(); ++t) {
      if (!kept_[t / 6]) continue;
      std::array<int, 4> tet = box.tets[t];
      for (int& v : tet) {
        int& n = number[static_cast<std::size_t>(v)];
        if (n < 0)
          n = static_cast<int>(mesh.vertices.size()),
          mesh.vertices.push_back(box.vertices[static_cast<std::size_t>(v)]);
        v = n;
      }
      mesh.tets.push_back(tet);
    }
    return mesh;
  }

 private:
  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(cells_[1]) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(cells_[0]) +
           static_cast<std::size_t>(i);
  }

  template <class Visit>
  void for_cells(const Visit& visit) const {
    for (int k = 0; k < cells_[2]; ++k)
      for (int j = 0; j < cells_[1]; ++j)
        for (int i = 0; i < cells_[0]; ++i) visit(i, j, k);
  }

  double size_;
  std::array<int, 3> cells_;
  Point low_;
  // per cell: whether the surface reaches into it; whether it has tetrahedra
  std::vector<bool> marked_, kept_;
};

}  // namespace

namespace {

Lattice lattice_over(const TriangleSurface& surface, double size) {
  Lattice lattice(surface.vertices, size);
  const SignedDistance distance(surface);
  lattice.mark(surface);
  lattice.fill([&](const Point& p) { return distance(p) < 0; });
  return lattice;
}

}  // namespace

TetMesh lattice_mesh(const TriangleSurface& surface, double size) {
  return lattice_over(surface, size).mesh();
}

WeightedLattice weighted_lattice(const TriangleSurface& surface, double size) {
  Lattice lattice = lattice_over(surface, size);
  WeightedLattice result;
  const std::vector<double> filled = lattice.filled(surface, result.shared_cells);
  result.mesh = lattice.mesh();
  result.mesh.filled = filled;
  return result;
}

TetMesh coarse_lattice(const TetMesh& mesh, int vertices) {
  const auto most = static_cast<int>(mesh.vertices.size());
  if (most < fewest_vertices)
    throw InputError(
        text("the mesh has ", most, " vertices; a coarser one has at least ", fewest_vertices));
  if (vertices < fewest_vertices || vertices > most)
    throw InputError(text("the number of vertices of a coarser mesh is ", vertices, "; it must be ",
                          fewest_vertices, " to ", most, ", which the mesh has"));
  const TriangleSurface surface = boundary_surface(mesh).surface;
  const TetLocator locator(mesh);
  const auto lattice_of = [&](double size) {
    Lattice lattice(surface.vertices, size);
    lattice.mark(surface);
    lattice.fill([&](const Point& p) { return locator.locate(p).distance == 0.0; });
    return lattice.mesh();
  };
  const Box box = bounding_box(mesh.vertices);
  double large = (box.max - box.min).maxCoeff(),
         small = std::cbrt(enclosed_volume(surface) / (4.0 * vertices));
  TetMesh best = lattice_of(large);
  for (int i = 0; i < 16; ++i) {
    const double size = std::sqrt(small * large);
    TetMesh next = lattice_of(size);
    const auto count = static_cast<int>(next.vertices.size());
    (count > vertices ? small : large) = size;
    if (count <= vertices && next.vertices.size() > best.vertices.size()) best = std::move(next);
  }
  best.region_names = mesh.region_names;
  for (std::size_t t = 0; t < best.tets.size() && !mesh.region.empty(); ++t) {
    if (t % 6 > 0) {
      best.region.push_back(best.region.back());
      continue;
    }
    const std::array<Point, 4> corners = corners_of(best, static_cast<int>(t));
    // Each of the six tetrahedra of a cube has the cube as its bounding box
    Box cube = bounding_box({corners.begin(), corners.end()});
    best.region.push_back(
        mesh.region[static_cast<std::size_t>(locator.locate((cube.min + cube.max) / 2).tet)]);
  }
  return best;
}

}  // namespace plica
