// SPDX-License-Identifier: BSD-3-Clause
#include <benchmark/benchmark.h>

#include <algorithm>
#include <plica/core/text.hpp>
#include <plica/drivers/level/part_of_level.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/reordering.hpp>

#include "case.hpp"
#include "suites.hpp"

// What ranks would have and receive of large bodies, by plans alone: no rank runs.
namespace plica::bench {

namespace {

/// A cube in the order that ranks share it out in.
struct OrderedCube {
  TetMesh mesh;
  std::vector<std::vector<int>> runs;

  explicit OrderedCube(int cells)
      : mesh(box_mesh({Point::Zero(), Point::Ones()}, {cells, cells, cells})) {
    mesh = reordered(mesh, locality_order(mesh));
    runs = runs_of_patches(mesh);
  }
};

void plan(benchmark::State& state, int cells, Element element, int ranks) {
  constexpr double bytes_per_tet = 150;  // of the mesh, its order and a plan
  if (!has_room_for(bytes_per_tet * 6 * cells * cells * cells))
    return state.SkipWithError("not enough memory");
  const OrderedCube& cube = fixture<OrderedCube>(
      text("ordered cube ", cells), [&] { return std::make_shared<OrderedCube>(cells); });
  std::vector<RankPlan> plans;
  for (auto _ : state) plans = plan_ranks(cube.mesh, element, cube.runs, ranks);
  const auto count = [&](const std::string& name, const auto& value) {
    double sum = 0, most = 0;
    for (const RankPlan& one : plans) {
      const auto its = static_cast<double>(value(one));
      sum += its, most = std::max(most, its);
    }
    state.counters[name] = sum / ranks, state.counters["most " + name] = most;
  };
  count("tets", [](const RankPlan& one) { return one.tets; });
  count("vertices", [](const RankPlan& one) { return one.vertices; });
  count("copies", [](const RankPlan& one) { return one.copies; });
  count("received", [](const RankPlan& one) { return one.received; });
  count("neighbours", [](const RankPlan& one) { return one.neighbours; });
}

}  // namespace

void register_ranks() {
  for (const int cells : {55, 256})  // 998 250 and 100 663 296 tetrahedra
    for (const Element element : {Element::linear, Element::nodal})
      for (const int ranks : {2, 8, 64, 256, 1024})
        benchmark::RegisterBenchmark(
            text("ranks/", name_of(element), "/", 6 * cells * cells * cells, "/", ranks).c_str(),
            plan, cells, element, ranks)
            ->Iterations(1);
}

}  // namespace plica::bench
