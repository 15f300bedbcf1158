// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/launch_queue.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>

#include "beam.hpp"
#include "case.hpp"
#include "measure.hpp"
#include "suites.hpp"

// Whole macro steps by the size of the body, for `bench/gpu`: with launches as graphs, where the
// device has any, and one by one.
namespace plica::bench {

namespace {

using Device = Kokkos::DefaultExecutionSpace;
constexpr const char* law = "neo_hookean";

/// These cells and `levels` - 1 times half of them.
std::vector<Cells> halved(Cells cells, int levels) {
  std::vector<Cells> all{cells};
  while (static_cast<int>(all.size()) < levels) {
    for (int& n : cells) n = std::max(2, n / 2);
    all.push_back(cells);
  }
  return all;
}

Problem on_one_level(const Cells& cells) { return beam_problem({cells}, law); }

Problem by_rsv(const Cells& cells) {
  Problem p = beam_problem(halved(cells, 4), law);
  p.integration.cycle = "rsv";
  return p;
}

Problem by_hierarchical_mass(const Cells& cells) {
  Problem p = beam_problem(halved(cells, 4), law);
  p.integration.cycle = "him";
  return p;
}

void solve_implicitly(Problem& p, double residual) {
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 10e-3;
  p.integration.implicit.newton_iterations = 1;
  p.integration.implicit.preconditioner = "multigrid";
  p.integration.implicit.relative_residual = residual;
}

Problem by_multigrid(const Cells& cells) {
  Problem p = beam_problem(halved(cells, 4), law);
  solve_implicitly(p, 1e-6);
  return p;
}

/// A tool of 8 mm radius stands 1.5 mm deep in the beam's free end; no weight, so that they stay
/// in touch.
Problem under_a_tool(const Cells& cells) {
  Problem p = beam_problem({cells}, law);
  p.gravity = Point::Zero();
  p.body.damping.mass = 5;
  p.body.surface = boundary_surface(p.body.levels.front()).surface;
  p.contact.obstacles = {{CapsuleOptions{{0.05, 0.05, 0.2565}, {0.05, 0.05, 0.4}, 0.008}, 0.3, {}}};
  return p;
}

/// The beam of SOFA's benchmarks of its CUDA plugin: 16 x 16 x 76 nodes, corotational, implicit
/// Euler.
Problem sofa_beam(const Cells& cells, int levels) {
  Problem p = on_one_level(cells);
  p.body.levels.clear();
  for (const Cells& c : halved(cells, levels))
    p.body.levels.push_back(box_mesh({Point::Zero(), Point(0.1, 0.1, 0.5)}, c));
  p.body.material = complete({"corotational", 1e5, 0.45, 1000});
  solve_implicitly(p, 1e-8);
  return p;
}

Problem sofa_beam_of_10_iterations(const Cells& cells) {
  Problem p = sofa_beam(cells, 1);
  p.integration.implicit.preconditioner = "block_jacobi";
  p.integration.implicit.iterations = 10;
  return p;
}

Problem sofa_beam_converged(const Cells& cells) { return sofa_beam(cells, 3); }

struct Step {
  std::string name;
  Cells cells;
  Problem (*problem)(const Cells&);
};

template <class Real>
void scale_step(benchmark::State& state, const Step& step, bool graphs) {
  using B = Backend<Real, Device>;
  auto& simulation = fixture<Simulation<B>>(
      "scale " + step.name + " " + precision_name<Real>(),
      [&] { return std::make_shared<Simulation<B>>(step.problem(step.cells)); });
  simulation.use_graphs(graphs);
  for (int n = 0; n < 4; ++n) simulation.step();  // what comes for the second time is a graph
  double tets = 0;
  for (const LevelReport& level : simulation.levels()) tets += level.tets * level.substeps;
  const auto iterations = [&] {
    const auto& counters = simulation.counters();
    const auto found = counters.find("cg_iterations");
    return found == counters.end() ? 0.0 : static_cast<double>(found->second);
  };
  const double before = iterations();
  const double time = measure<Real>(state, Device(), {}, [&] { simulation.step(); });
  state.counters["tets_per_second"] = tets / time;
  state.counters["simulated_per_second"] = simulation.macro_step() / time;
  // measure() makes one more step
  state.counters["cg_iterations"] =
      (iterations() - before) / (static_cast<double>(state.iterations()) + 1);
}

template <class Real>
void register_step(const std::string& kind, const Cells& cells, Problem (*problem)(const Cells&)) {
  for (const bool graphs : {true, false}) {
    if (!graphs && !gathers<Device>) continue;
    const std::string name = "scale/" + kind + "/" + precision_name<Real>() + "/" +
                             std::to_string(beam_tets(cells)) + (graphs ? "" : "/one_by_one");
    benchmark::RegisterBenchmark(name.c_str(), scale_step<Real>, Step{kind, cells, problem},
                                 graphs);
  }
}

template <class Real>
void register_scale_in() {
  constexpr Cells smallest{4, 4, 10}, largest{88, 88, 218}, of_sofa{15, 15, 75};
  const bool device = !Backend<Real, Device>::on_host;  // large bodies are for devices
  for (const Cells& cells : {smallest, small_beam, medium_beam, large_beam, largest})
    if (device || beam_tets(cells) <= beam_tets(medium_beam))
      register_step<Real>("explicit", cells, on_one_level);
  for (const Cells& cells : {medium_beam, large_beam}) {
    if (!device && beam_tets(cells) > beam_tets(medium_beam)) continue;
    register_step<Real>("rsv", cells, by_rsv);
    register_step<Real>("him", cells, by_hierarchical_mass);
    register_step<Real>("multigrid", cells, by_multigrid);
    register_step<Real>("tool", cells, under_a_tool);
  }
  register_step<Real>("sofa_beam", of_sofa, sofa_beam_of_10_iterations);
  register_step<Real>("sofa_beam_converged", of_sofa, sofa_beam_converged);
}

}  // namespace

void register_scale() {
  register_scale_in<double>();
  register_scale_in<float>();
}

}  // namespace plica::bench
