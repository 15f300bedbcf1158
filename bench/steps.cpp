// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/linear/krylov.hpp>
#include <plica/drivers/run/build_hierarchy.hpp>
#include <plica/kernels/materials/list.hpp>

#include "case.hpp"
#include "counted.hpp"
#include "measure.hpp"
#include "suites.hpp"

namespace plica::bench {

namespace {

// of conjugate gradients, what other simulators are measured with
constexpr int iterations = 25;
constexpr double implicit_step = 10e-3;  // [s]
constexpr ImplicitWeights weights{implicit_step * implicit_step, implicit_step};

Problem implicit_beam(const Case& c) {
  Problem problem = beam_problem({c.cells}, c.material);
  problem.integration.integrator = {"implicit_euler"};
  problem.integration.macro_step = implicit_step;
  problem.integration.implicit.iterations = iterations;
  return problem;
}

/// One step at 0.9 of the limit of a beam that begins to sag. Compulsory: elements, mass and its
/// inverse, displacement and velocity in and out.
template <class B>
void explicit_beam_step(benchmark::State& state, const Case& c, double flops) {
  constexpr double s = sizeof(typename B::Real);
  auto& simulation = fixture<Simulation<B>>("explicit " + c.name, [&] {
    return std::make_shared<Simulation<B>>(beam_problem({c.cells}, c.material));
  });
  const LevelReport& level = simulation.levels().front();
  const double tets = level.tets, vertices = level.vertices;
  measure<typename B::Real>(
      state, typename B::Exec(),
      {tets, tets * (8 + 10 * s) + vertices * 14 * s, tets * flops + vertices * 12},
      [&] { simulation.step(); });
}

/// One linearly implicit step with a fixed number of iterations, to be set beside other simulators'
/// figures.
template <class B>
void implicit_beam_step(benchmark::State& state, const Case& c) {
  auto& simulation = fixture<Simulation<B>>(
      "implicit " + c.name, [&] { return std::make_shared<Simulation<B>>(implicit_beam(c)); });
  measure<typename B::Real>(state, typename B::Exec(), {}, [&] { simulation.step(); });
  state.counters["iterations"] = iterations;
}

/// A beam whose implicit system is linearised, with a right-hand side.
template <class B>
struct LinearSystem {
  BuiltHierarchy<B> built;
  Vectors<B> right_side, r, x;
  StageSystem<B> system;
  Krylov<B> krylov;

  LinearSystem(const Case& c, bool assembled)
      : built(build_hierarchy<B>(implicit_beam(c), {})),
        system(level(), assembled),
        krylov(vertices()) {
    right_side = to_field<B>(bent(built.meshes.front(), 0.1 / c.cells[0]));
    r = Vectors<B>("bench::r", right_side.extent(0)),
    x = Vectors<B>("bench::x", right_side.extent(0));
    Level<B>& h = level();
    h.linearise(h.state, 0, weights, implicit_step, h.f);
    prepare();
  }
  Level<B>& level() { return (*built.hierarchy)[0]; }
  int vertices() { return level().model.vertices; }
  void prepare() {
    Level<B>& h = level();
    system.prepare(h, h.state, weights, false);
  }
};

template <class B>
LinearSystem<B>& linear_system(const Case& c, bool assembled) {
  return fixture<LinearSystem<B>>((assembled ? "assembled " : "free ") + c.name,
                                  [&] { return std::make_shared<LinearSystem<B>>(c, assembled); });
}

/// Compulsory per iteration: elements, mass, displacement; solution, residual and direction in and
/// out; preconditioner.
template <class B>
void cg_iteration(benchmark::State& state, const Case& c, double flops) {
  constexpr double s = sizeof(typename B::Real);
  auto& system = linear_system<B>(c, false);
  const auto& exec = system.built.hierarchy->exec();
  const double tets = system.level().model.tets, vertices = system.vertices();
  const double bytes = tets * (8 + 10 * s) + vertices * 28 * s, work = tets * flops + vertices * 50;
  ImplicitOptions options;
  options.iterations = iterations;
  const double time = measure<typename B::Real>(
      state, exec, {tets * iterations, bytes * iterations, work * iterations}, [&] {
        Kokkos::deep_copy(exec, system.r, system.right_side);
        system.krylov.solve(exec, system.system, nullptr, nullptr, options, system.r, system.x);
      });
  state.counters["per_iteration"] = time / iterations;
}

/// Compulsory: elements and displacement in, the matrix out.
template <class B>
void assembly(benchmark::State& state, const Case& c) {
  constexpr double s = sizeof(typename B::Real);
  auto& system = linear_system<B>(c, true);
  const double tets = system.level().model.tets, stored = system.system.pattern().stored();
  measure<typename B::Real>(
      state, system.built.hierarchy->exec(),
      {tets, tets * (8 + 10 * s) + system.vertices() * 3 * s + stored * 9 * s, 0},
      [&] { system.prepare(); });
}

/// Compulsory: the matrix and a vector in, another out.
template <class B>
void block_product(benchmark::State& state, const Case& c) {
  constexpr double s = sizeof(typename B::Real);
  auto& system = linear_system<B>(c, true);
  const BlockMatrix<B>& A = system.system.pattern();
  const double tets = system.level().model.tets, blocks = A.blocks(), stored = A.stored(),
               vertices = system.vertices();
  measure<typename B::Real>(
      state, system.built.hierarchy->exec(),
      {tets, stored * 9 * s + blocks * 8 + vertices * (6 * s + 8), 18 * blocks},
      [&] { system.system.product(system.built.hierarchy->exec(), system.right_side, system.x); });
}

}  // namespace

void register_steps() {
  for_each_case<Materials>([]<class B, class Material>(const Case& c) {
    benchmark::RegisterBenchmark(("explicit_step/" + c.name).c_str(), explicit_beam_step<B>, c,
                                 flops_per_tet<Material>(1));
    benchmark::RegisterBenchmark(("implicit_step/" + c.name).c_str(), implicit_beam_step<B>, c);
    benchmark::RegisterBenchmark(("assembly/" + c.name).c_str(), assembly<B>, c);
    benchmark::RegisterBenchmark(("block_product/" + c.name).c_str(), block_product<B>, c);
    benchmark::RegisterBenchmark(("cg_iteration/" + c.name).c_str(), cg_iteration<B>, c,
                                 flops_per_tet<Material>(2));
  });
}

}  // namespace plica::bench
