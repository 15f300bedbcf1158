// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/elastic/build_patches.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/run/build_hierarchy.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/kernels/transfer/transfer.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "beam.hpp"
#include "case.hpp"
#include "measure.hpp"
#include "suites.hpp"

namespace plica::bench {

namespace {

using Exec = Kokkos::DefaultExecutionSpace;

const std::vector<Cells> four_levels{medium_beam, {16, 16, 39}, {13, 13, 32}, {10, 10, 25}};

/// The ball of the main scene, resting in its bowl, on the first `levels` of its meshes.
Problem ball_problem(std::size_t levels, int subdivisions) {
  Problem p;
  p.body.element = {"linear"};
  for (int cells : {17, 15, 12, 10})
    if (p.body.levels.size() < levels)
      p.body.levels.push_back(
          box_mesh({Point::Zero(), Point::Constant(0.11)}, {cells, cells, cells}));
  p.body.material = {"neo_hookean", 50e3, 0.4, 1000};
  p.body.damping.mass = 5;
  p.body.initial.position = Point(0, 0, 0.049);
  p.body.surface = sphere_surface(Point::Constant(0.055), 0.05, subdivisions);
  p.gravity = Point(0, 0, -9.81);
  p.contact.obstacles.push_back({BowlOptions{Point(0, 0, 0.13), 0.13, 0.08}, 0.3, {}});
  p.integration.cycle = levels > 1 ? "rsv" : "single";
  return p;
}

/// A ball of 20 480 triangles in 105 456 tetrahedra, and a probe that is pressed into its top.
Problem probe_problem() {
  Problem p = ball_problem(1, 5);
  p.body.levels = {box_mesh({Point::Zero(), Point::Constant(0.11)}, {26, 26, 26})};
  p.body.initial.position = Point::Zero();
  p.contact.obstacles = {
      {CapsuleOptions{{0.055, 0.055, 0.112}, {0.055, 0.055, 0.2}, 0.008}, 0.3, {}}};
  return p;
}

/// Two blocks of 48 600 tetrahedra and 2 882 points each, one a little inside the other.
Problem blocks_problem() {
  const auto block = [](double z) {
    Body body;
    body.element = {"linear"};
    body.levels = {box_mesh({{0, 0, z}, {0.3, 0.3, z + 0.09}}, {30, 30, 9})};
    body.surface = boundary_surface(body.levels[0]).surface;
    return body;
  };
  Problem p;
  p.body = join_bodies({{"lower", block(0)}, {"upper", block(0.0897)}});
  return p;
}

template <class B>
std::shared_ptr<BuiltHierarchy<B>> built(const Problem& problem) {
  return std::make_shared<BuiltHierarchy<B>>(build_hierarchy<B>(problem, {}));
}

/// The switched mapping between the two finest of four levels. Compulsory: rows, both fields of the
/// source now and at the start, and of the target in and out, with its switching distance.
template <class Real>
void transfer(benchmark::State& state, bool down) {
  using B = Backend<Real, Exec>;
  auto& b = fixture<BuiltHierarchy<B>>(std::string("transfer ") + precision_name<Real>(), [&] {
    Problem problem = beam_problem(four_levels, "st_venant_kirchhoff");
    problem.integration.cycle = "rsv";
    return built<B>(problem);
  });
  const LevelData<B>&fine = (*b.hierarchy)[0], &coarse = (*b.hierarchy)[1];
  const LevelData<B>&from = down ? fine : coarse, &to = down ? coarse : fine;
  const Transfer<B>& rows = down ? coarse.from_finer : coarse.to_finer;
  const double s = sizeof(Real),
               bytes = rows.rows * (4 + 16 + 4 * s + 13 * s) + from.model.vertices * 12 * s;
  const double time = measure<Real>(state, b.hierarchy->exec(), {0, bytes, rows.rows * 120.0}, [&] {
    map_fields<B, MapSwitched>(b.hierarchy->exec(), "bench::transfer", rows, from.state, from.start,
                               to.start, to.state, to.drift_limit);
  });
  state.counters["rows_per_second"] = rows.rows / time;
}

/// Contact of one step, from where points are to the forces on vertices; what is found is kept from
/// call to call, as in slow steps. Compulsory: points with their rows, their transpose,
/// displacement and velocity of the vertices touched, force in and out.
template <class Real>
void contact(benchmark::State& state, const std::string& name, Problem (*scene)()) {
  using B = Backend<Real, Exec>;
  auto& b = fixture<BuiltHierarchy<B>>("contact " + name, [&] { return built<B>(scene()); });
  Level<B>& h = (*b.hierarchy)[0];
  const auto& surface = h.surface;
  const double s = sizeof(Real), points = surface.points;
  const double bytes = points * (3 * s + 2 * (16 + 4 * s)) + surface.touched * (8 + 12 * s);
  const double time = measure<Real>(state, b.hierarchy->exec(), {0, bytes, points * 120}, [&] {
    h.response().add_forces(b.hierarchy->exec(), h, h.state, 0, {.span = 1e-4}, h.f);
  });
  state.counters["points_per_second"] = points / time;
}

/// One macro step of the main scene on all four levels, contact included; its launches as graphs,
/// where the device has any, or one by one.
template <class Real>
void cycle(benchmark::State& state, std::size_t levels, bool graphs) {
  using B = Backend<Real, Exec>;
  auto& simulation = fixture<Simulation<B>>(
      std::string("cycle ") + precision_name<Real>() + std::to_string(levels),
      [&] { return std::make_shared<Simulation<B>>(ball_problem(levels, 3)); });
  simulation.use_graphs(graphs);
  double tets = 0;
  for (const LevelReport& level : simulation.levels()) tets += level.tets * level.substeps;
  const double time = measure<Real>(state, Exec(), {}, [&] { simulation.step(); });
  state.counters["tets_per_second"] = tets / time;
  state.counters["simulated_per_second"] = simulation.macro_step() / time;
}

template <class Real>
void set_up_hierarchy(benchmark::State& state) {
  using B = Backend<Real, Exec>;
  Problem problem = beam_problem(four_levels, "st_venant_kirchhoff");
  problem.integration.cycle = "rsv";
  for (auto _ : state) benchmark::DoNotOptimize(Simulation<B>(problem).macro_step());
}

template <class Real>
void set_up_patches(benchmark::State& state) {
  const TetMesh mesh = beam_mesh(medium_beam);
  const MaterialInfo& info = *find_material("st_venant_kirchhoff");
  const auto constants =
      info.kernel_constants(parameter_values(info, {"st_venant_kirchhoff", 1e5, 0.45}, {}));
  for (auto _ : state)
    benchmark::DoNotOptimize(build_patches<Backend<Real, Exec>>(mesh, {constants}).count);
}

template <class Real>
void register_precision() {
  const std::string real = precision_name<Real>(), medium = std::to_string(beam_tets(medium_beam));
  const auto add = [](const std::string& name, auto function, auto... arguments) {
    return benchmark::RegisterBenchmark(name.c_str(), function, arguments...);
  };
  add("transfer/restrict/" + real + "/" + medium, transfer<Real>, true);
  add("transfer/interpolate/" + real + "/" + medium, transfer<Real>, false);
  const auto add_contact = [&](const std::string& scene, const std::string& points,
                               Problem (*make)()) {
    const std::string name = "contact/" + scene + "/" + real + "/" + points;
    add(name, contact<Real>, name, make);
  };
  add_contact("bowl", "642", [] { return ball_problem(1, 3); });
  add_contact("bowl", "10242", [] { return ball_problem(1, 5); });
  add_contact("probe", "10242", probe_problem);
  add_contact("bodies", "5764", blocks_problem);
  for (const bool graphs : {true, false}) {
    if (!graphs && !gathers<Exec>) continue;
    const std::string how = graphs ? "" : "/one_by_one";
    add("cycle/single/neo_hookean/" + real + "/29478" + how, cycle<Real>, std::size_t{1}, graphs);
    add("cycle/rsv/neo_hookean/" + real + "/29478" + how, cycle<Real>, std::size_t{4}, graphs);
  }
  add("set_up/patches/" + real + "/" + medium, set_up_patches<Real>);
  add("set_up/hierarchy_of_4/" + real + "/" + medium, set_up_hierarchy<Real>)
      ->Unit(benchmark::kMillisecond);
}

}  // namespace

void register_levels() {
  register_precision<double>();
  register_precision<float>();
}

}  // namespace plica::bench
