// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <plica/drivers/app/scene/describe.hpp>
#include <plica/drivers/app/scene/order_levels.hpp>

namespace plica::app {

std::vector<Choice> mesh_orders() {
  return {{"auto", "of a file: its own, or along a Hilbert curve where that is better"},
          {"hilbert", "along a Hilbert curve, whatever the order of the input"}};
}

Reordering better_order(const TetMesh& mesh) {
  Reordering order = locality_order(mesh);
  if (mean_vertex_span(reordered(mesh, order)) < mean_vertex_span(mesh)) return order;
  std::ranges::sort(order.vertices), std::ranges::sort(order.tets);
  return order;
}

namespace {

// Puts the numbers of one kind of items, vertices or tetrahedra, in a new order
void renumber(std::vector<int>& input, std::vector<int>& ids, const std::vector<int>& order,
              const std::vector<int>& new_number) {
  if (input.empty())
    input = new_number;
  else
    for (int& number : input) number = new_number[static_cast<std::size_t>(number)];
  ids = ids.empty() ? order : permuted(ids, order);
}

}  // namespace

void order_levels(Scene& scene) {
  if (scene.order != "hilbert") return;
  for (std::size_t i = 0; i < scene.problem.body.levels.size(); ++i) {
    TetMesh& mesh = scene.problem.body.levels[i];
    const Reordering order = locality_order(mesh), new_number = inverse(order);
    mesh = reordered(mesh, order);
    Numbering& numbering = scene.numbering[i];
    renumber(numbering.input.vertices, numbering.vertex_ids, order.vertices, new_number.vertices);
    renumber(numbering.input.tets, numbering.tet_ids, order.tets, new_number.tets);
  }
}

}  // namespace plica::app
