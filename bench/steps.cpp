// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/solver/linear/conjugate_gradients.hpp>
#include <plica/drivers/solver/set_up/build_hierarchy.hpp>
#include <plica/kernels/materials/list.hpp>

#include "case.hpp"
#include "counted.hpp"
#include "fixture.hpp"
#include "measure.hpp"
#include "suites.hpp"

namespace plica::bench {

namespace {

constexpr int iterations = 25;           // of conjugate gradients, what other simulators are measured with
constexpr double implicit_step = 10e-3;  // [s]
constexpr ImplicitWeights weights{implicit_step * implicit_step, implicit_step};

Problem implicit_beam(const Case& c) {
  Problem problem = beam_problem({c.cells}, c.material);
  problem.integration.integrator = {"implicit_euler"};
  problem.integration.macro_step = implicit_step;
  problem.integration.implicit.iterations = iterations;
  return problem;
}

/// One step at 0.9 of the limit of a beam that begins to sag. Compulsory: elements, mass and its inverse, displacement and
/// velocity in and out.
template <class B>
void explicit_beam_step(benchmark::State& state, const Case& c, double flops) {
  constexpr double s = sizeof(typename B::Real);
  auto& simulation = fixture<Simulation<B>>(
      "explicit " + c.name, [&] { return std::make_shared<Simulation<B>>(beam_problem({c.cells}, c.material)); });
  const LevelReport& level = simulation.levels().front();
  const double tets = level.tets, vertices = level.vertices;
  measure<typename B::Real>(state, typename B::Exec(),
                            {tets, tets * (8 + 10 * s) + vertices * 14 * s, tets * flops + vertices * 12},
                            [&] { simulation.step(); });
}

/// One linearly implicit step with a fixed number of iterations, to be set beside other simulators' figures.
template <class B>
void implicit_beam_step(benchmark::State& state, const Case& c) {
  auto& simulation =
      fixture<Simulation<B>>("implicit " + c.name, [&] { return std::make_shared<Simulation<B>>(implicit_beam(c)); });
  measure<typename B::Real>(state, typename B::Exec(), {}, [&] { simulation.step(); });
  state.counters["iterations"] = iterations;
}

/// A beam whose implicit system is linearised, with a right-hand side.
template <class B>
struct LinearSystem {
  BuiltHierarchy<B> built;
  Vectors<B> right_side;
  CgVectors<B> vectors;
  BlockSums<B> blocks;

  explicit LinearSystem(const Case& c) : built(build_hierarchy<B>(implicit_beam(c), {})) {
    HierarchyLevel<B>& h = (*built.hierarchy)[0];
    const int n = h.level.model.vertices;
    vectors = CgVectors<B>(n), blocks = BlockSums<B>(n);
    vectors.r = Vectors<B>("bench::r", n), vectors.x = Vectors<B>("bench::x", n);
    right_side = to_field<B>(bent(built.meshes.front(), 0.1 / c.cells[0]));
    h.forces->linearise(h.level, h.level.state, 0, weights, implicit_step, h.level.f);
    h.forces->diagonal(h.level, h.level.state, weights, vectors.preconditioner);
    update_vertices<B>(built.hierarchy->exec(), "invert", n, InvertBlocks<B>{h.level.model, vectors.preconditioner, 0});
  }
};

/// Compulsory per iteration: elements, mass, displacement; solution, residual and direction in and out; preconditioner.
template <class B>
void cg_iteration(benchmark::State& state, const Case& c, double flops) {
  constexpr double s = sizeof(typename B::Real);
  auto& system = fixture<LinearSystem<B>>("cg " + c.name, [&] { return std::make_shared<LinearSystem<B>>(c); });
  HierarchyLevel<B>& h = (*system.built.hierarchy)[0];
  const auto& exec = system.built.hierarchy->exec();
  const double tets = h.level.model.tets, vertices = h.level.model.vertices;
  const double bytes = tets * (8 + 10 * s) + vertices * 28 * s, work = tets * flops + vertices * 50;
  const double time =
      measure<typename B::Real>(state, exec, {tets * iterations, bytes * iterations, work * iterations}, [&] {
        Kokkos::deep_copy(exec, system.vectors.r, system.right_side);
        conjugate_gradients<B>(exec, system.vectors, system.blocks, h.level.model.vertices, 1e-6, iterations,
                               iterations, [&](const Vectors<B>& p, const Vectors<B>& q) {
                                 h.forces->product(h.level, h.level.state, p, weights, q);
                               });
      });
  state.counters["per_iteration"] = time / iterations;
}

}  // namespace

void register_steps() {
  for_each_case<Materials>([]<class B, class Material>(const Case& c) {
    benchmark::RegisterBenchmark(("explicit_step/" + c.name).c_str(), explicit_beam_step<B>, c,
                                 flops_per_tet<Material>(1));
    benchmark::RegisterBenchmark(("implicit_step/" + c.name).c_str(), implicit_beam_step<B>, c);
    benchmark::RegisterBenchmark(("cg_iteration/" + c.name).c_str(), cg_iteration<B>, c, flops_per_tet<Material>(2));
  });
}

}  // namespace plica::bench
