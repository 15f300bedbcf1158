// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/checked.hpp>
#include <plica/meshes/grid_mesh.hpp>
#include <utility>

namespace plica {

namespace {

using Index = std::array<int, 3>;

int vertex_number(const Index& cells, const Index& at) {
  return (at[2] * (cells[1] + 1) + at[1]) * (cells[0] + 1) + at[0];
}

// Calls `visit` with every index below `counts`, x fastest
template <typename Visit>
void for_each(const Index& counts, Visit visit) {
  for (int k = 0; k < counts[2]; ++k)
    for (int j = 0; j < counts[1]; ++j)
      for (int i = 0; i < counts[0]; ++i) visit(Index{i, j, k});
}

// The six ways along the edges of a cell from one end of its diagonal to the other; `even` ones turn right-handed
struct Walk {
  Index axes;
  bool even;
};
constexpr Walk walks[6] = {{{0, 1, 2}, true}, {{0, 2, 1}, false}, {{1, 0, 2}, false},
                           {{1, 2, 0}, true}, {{2, 0, 1}, true},  {{2, 1, 0}, false}};

void cut_cell(const Index& cells, const std::array<bool, 3>& mirrored, const Index& cell, TetMesh& mesh) {
  Index start = cell, step = {1, 1, 1};
  bool right_handed = true;
  for (std::size_t a = 0; a < 3; ++a) {
    if (!mirrored[a] || 2 * cell[a] + 1 >= cells[a]) continue;
    start[a] += 1, step[a] = -1, right_handed = !right_handed;
  }
  for (const Walk& walk : walks) {
    Index at = start;
    std::array<int, 4> tet = {vertex_number(cells, at), 0, 0, 0};
    for (std::size_t s = 0; s < 3; ++s) {
      const auto axis = static_cast<std::size_t>(walk.axes[s]);
      at[axis] += step[axis];
      tet[s + 1] = vertex_number(cells, at);
    }
    if (walk.even != right_handed) std::swap(tet[2], tet[3]);
    mesh.tets.push_back(tet);
  }
}

}  // namespace

TetMesh grid_mesh(const Index& cells, const std::array<bool, 3>& mirrored,
                  const std::function<Point(const Point&)>& map) {
  double vertices = 1, tets = 6;
  for (const int n : cells) {
    checked_cells("the number of cells along an axis", n);
    vertices *= n + 1.0, tets *= n;
  }
  checked_count("the number of vertices", vertices);
  checked_count("the number of tetrahedra", tets);

  TetMesh mesh;
  mesh.vertices.reserve(static_cast<std::size_t>(vertices));
  mesh.tets.reserve(static_cast<std::size_t>(tets));
  for_each({cells[0] + 1, cells[1] + 1, cells[2] + 1}, [&](const Index& at) {
    const Point unit(double(at[0]) / cells[0], double(at[1]) / cells[1], double(at[2]) / cells[2]);
    mesh.vertices.push_back(map(unit));
  });
  for_each(cells, [&](const Index& cell) { cut_cell(cells, mirrored, cell, mesh); });
  return mesh;
}

}  // namespace plica
