// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/box_mesh.hpp>
#include <random>
#include <vector>

namespace plica {

/// Vectors whose components are evenly spread over [-size, size].
inline std::vector<Point> random_field(std::size_t count, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> within(-size, size);
  std::vector<Point> field(count);
  for (Point& p : field) p = {within(random), within(random), within(random)};
  return field;
}

/// Whether a vertex lies on one of the box's faces.
inline bool on_boundary(const Box& box, const Point& p) {
  const double slack = 1e-9 * (box.max - box.min).norm();
  return ((p - box.min).array() < slack).any() || ((box.max - p).array() < slack).any();
}

/// A box whose inner vertices are moved at random by up to `amount` of a cell: no two elements alike.
inline TetMesh jittered_box(const Box& box, const std::array<int, 3>& cells, double amount = 0.15, unsigned seed = 7) {
  TetMesh mesh = box_mesh(box, cells);
  const auto moves = random_field(mesh.vertices.size(), amount, seed);
  for (std::size_t a = 0; a < moves.size(); ++a)
    if (!on_boundary(box, mesh.vertices[a]))
      for (int k = 0; k < 3; ++k) mesh.vertices[a][k] += moves[a][k] * (box.max - box.min)[k] / cells[std::size_t(k)];
  return mesh;
}

}  // namespace plica
