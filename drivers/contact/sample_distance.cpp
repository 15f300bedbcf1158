// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/contact/sample_distance.hpp>
#include <plica/meshes/signed_distance.hpp>

namespace plica {

namespace {

constexpr int cells_around = 3;      // cells of margin on each side
constexpr double cells_across = 10;  // least cells along the shortest extent, by default
constexpr double affordable = 1 << 23, most_nodes = 1 << 27;

double nodes_of(const Point& extent, double cell) {
  return (extent / cell)
      .array()
      .ceil()
      .unaryExpr([](double n) { return n + 1 + 2 * cells_around; })
      .prod();
}

/// Returns the edge of a cell [m]. `cells`: number along the longest extent; 0: chosen here.
/// `sheet`: thickness of a sheet [m]; 0: the surface is closed.
double cell_size(const Point& extent, int cells, double sheet) {
  if (cells > 0) return extent.maxCoeff() / cells;
  double cell =
      std::min(extent.maxCoeff() / 64, sheet > 0 ? sheet / 3 : extent.minCoeff() / cells_across);
  while (nodes_of(extent, cell) > affordable) cell *= 1.1;
  return cell;
}

}  // namespace

double distance_cell(const TriangleSurface& surface, int cells, double thickness) {
  const Box box = bounding_box(surface.vertices);
  return cell_size(box.max - box.min, cells, thickness);
}

DistanceGrid sample_distance(const TriangleSurface& surface, int cells, double thickness) {
  Box box = bounding_box(surface.vertices);
  box.min.array() -= thickness / 2, box.max.array() += thickness / 2;
  const Point extent = box.max - box.min;
  DistanceGrid grid;
  grid.cell = distance_cell(surface, cells, thickness);
  grid.margin = cells_around * grid.cell;
  const std::string size =
      text(number(extent[0], 3), " x ", number(extent[1], 3), " x ", number(extent[2], 3), " m");
  if (const double nodes = nodes_of(extent, grid.cell); nodes > most_nodes)
    throw InputError(text("cells is ", cells, ", a grid of ", number(nodes, 3), " nodes around ",
                          size, "; expected at most ", number(most_nodes, 3)));
  std::size_t total = 1;
  for (int k = 0; k < 3; ++k) {
    const int across = static_cast<int>(std::ceil(extent[k] / grid.cell)) + 2 * cells_around;
    grid.nodes[static_cast<std::size_t>(k)] = across + 1;
    grid.origin[k] = 0.5 * (box.min[k] + box.max[k] - across * grid.cell);
    total *= static_cast<std::size_t>(across + 1);
  }
  grid.value.reserve(total);
  const SignedDistance distance(surface);
  double last = std::numeric_limits<double>::infinity();
  for (int z = 0; z < grid.nodes[2]; ++z)
    for (int y = 0; y < grid.nodes[1]; ++y)
      for (int x = 0; x < grid.nodes[0]; ++x) {
        const double bound =
            x > 0 ? std::abs(last) + grid.cell : std::numeric_limits<double>::infinity();
        last = distance(grid.origin + grid.cell * Point(x, y, z), bound);
        grid.value.push_back(thickness > 0 ? std::abs(last) - thickness / 2 : last);
      }
  if (*std::min_element(grid.value.begin(), grid.value.end()) >= 0)
    throw InputError(text("no node of its distance grid, with cells of ", number(grid.cell, 3),
                          " m, lies inside the surface of ", size, "; give cells above ",
                          number(std::ceil(extent.maxCoeff() / grid.cell), 15)));
  return grid;
}

}  // namespace plica
