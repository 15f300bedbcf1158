// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/box_meshes.hpp>
#include <plica/meshes/generators.hpp>
#include <span>

namespace plica {

namespace {
namespace delaunay {

#include <plica/meshes/data/delaunay/16x4x4.inc>
#include <plica/meshes/data/delaunay/4x4x2.inc>
#include <plica/meshes/data/delaunay/4x4x4.inc>
#include <plica/meshes/data/delaunay/6x6x6.inc>
#include <plica/meshes/data/delaunay/8x2x2.inc>
#include <plica/meshes/data/delaunay/8x8x2.inc>

struct Stored {
  std::array<int, 3> cells;
  std::span<const double[3]> vertices;
  std::span<const int[4]> tets;
};

constexpr Stored all[] = {
    {{8, 2, 2}, vertices_8x2x2, tets_8x2x2}, {{16, 4, 4}, vertices_16x4x4, tets_16x4x4},
    {{4, 4, 2}, vertices_4x4x2, tets_4x4x2}, {{8, 8, 2}, vertices_8x8x2, tets_8x8x2},
    {{4, 4, 4}, vertices_4x4x4, tets_4x4x4}, {{6, 6, 6}, vertices_6x6x6, tets_6x6x6}};

const Stored* find(const std::array<int, 3>& cells) {
  const auto found = std::ranges::find(all, cells, &Stored::cells);
  return found == std::end(all) ? nullptr : found;
}

TetMesh scaled(const Stored& stored, const Box& box) {
  const Point cell =
      (box.max - box.min).cwiseQuotient(Point(stored.cells[0], stored.cells[1], stored.cells[2]));
  TetMesh mesh;
  for (const auto& x : stored.vertices)
    mesh.vertices.push_back(box.min + cell.cwiseProduct(Point(x[0], x[1], x[2])));
  for (const auto& t : stored.tets) mesh.tets.push_back({t[0], t[1], t[2], t[3]});
  return mesh;
}

}  // namespace delaunay

TetMesh moved_box(const Box& box, const std::array<int, 3>& cells, double amount, int kept) {
  TetMesh mesh = box_mesh(box, cells);
  const auto moves = random_field(mesh.vertices.size(), amount, 1);
  const Point slack = 1e-9 * (box.max - box.min);
  for (std::size_t a = 0; a < moves.size(); ++a) {
    Point& x = mesh.vertices[a];
    if (kept >= 0 && x[kept] > box.max[kept] - slack[kept]) continue;
    for (int k = 0; k < 3; ++k)
      if (x[k] > box.min[k] + slack[k] && x[k] < box.max[k] - slack[k])
        x[k] += moves[a][k] * (box.max - box.min)[k] / cells[static_cast<std::size_t>(k)];
  }
  return mesh;
}

}  // namespace

bool has_box(const std::string& kind, const std::array<int, 3>& cells) {
  return kind != "delaunay" || delaunay::find(cells);
}

TetMesh box_of(const std::string& kind, const Box& box, const std::array<int, 3>& cells, int kept) {
  if (kind == "delaunay") return delaunay::scaled(*delaunay::find(cells), box);
  return moved_box(box, cells, kind == "jittered" ? 0.2 : 0, kept);
}

}  // namespace plica
