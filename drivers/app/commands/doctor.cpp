// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/machine_limits.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/generators.hpp>

namespace plica::app {
namespace {

using DoctorClock = std::chrono::steady_clock;
double since(DoctorClock::time_point start) {
  return std::chrono::duration<double>(DoctorClock::now() - start).count();
}

// sizes of the test arrays: of all threads together, of each thread [bytes]
constexpr double in_memory = 256e6, in_cache = 256e3;

struct Limits {
  double memory = 0, cache = 0;       ///< bandwidth [bytes/s]
  double flops = 0, flops_float = 0;  ///< peak in double and in float [flop/s]
};

Limits measure_limits() {
  return {triad_bandwidth(in_memory),
          triad_bandwidth(in_cache * Kokkos::DefaultExecutionSpace().concurrency()),
          fma_peak<double>(), fma_peak<float>()};
}

/// One number of the self-test, computed and stored
struct Answer {
  std::string name, unit;
  double got = 0, stored = 0;
  double tolerance = 0;  ///< absolute: far above the effect of rounding on another processor, and
                         ///< far below the effect of a wrong force
  bool ok() const { return std::abs(got - stored) <= tolerance; }
};

/// Returns the problem of the self-test: a soft ball falls obliquely into a bowl. The ball has
/// three meshes of nodal elements, stepped by cycle him.
Problem ball_in_bowl() {
  Problem p;
  for (const int cells : {14, 9, 5}) p.body.levels.push_back(ball_mesh({0, 0, 0.1}, 0.05, cells));
  p.body.material = {"neo_hookean", 50e3, 0.4, 1000};
  p.body.damping.mass = 5;
  p.body.element = {"nodal"};
  p.body.surface = sphere_surface({0, 0, 0.1}, 0.05, 3);
  p.body.initial.velocity = {0.2, 0, -0.7};
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({BowlOptions{{0.01, 0, 0.13}, 0.13, 0.08}, 0.3, {}});
  p.integration.cycle = "him", p.integration.macro_step = 1e-3;
  return p;
}

std::vector<Answer> self_test() {
  Simulation<Backend<double, Kokkos::DefaultExecutionSpace>> simulation(ball_in_bowl());
  constexpr double end = 0.09;  // [s]
  while (simulation.time() < end - simulation.macro_step() / 2)
    if (const auto bad = simulation.step_checked())
      throw std::runtime_error("the self-test diverged: " + bad->text());
  Point centre = Point::Zero();
  const std::vector<Point> x = simulation.positions();
  for (const Point& vertex : x) centre += vertex / static_cast<double>(x.size());
  const Energies e = simulation.energies();
  return {{"centre x", "m", centre.x(), 0.012778931, 1e-6},
          {"centre z", "m", centre.z(), 0.044724175, 1e-6},
          {"kinetic energy", "J", e.kinetic, 0.190430723, 1e-4},
          {"elastic energy", "J", e.elastic, 0.042193214, 1e-4},
          {"contact energy", "J", e.contact, 0.000442263, 3e-6}};
}

std::string with_digits(double value, const Answer& answer) {
  return fmt::format("{:.7f} {}", value, answer.unit);
}

const Table<Answer> answer_columns = {
    {"name", &Answer::name, {"self-test"}},
    {"unit", &Answer::unit},
    {"got", &Answer::got},
    {"", [](const Answer& a) { return with_digits(a.got, a); }, {"", "{}"}},
    {"stored", &Answer::stored},
    {"", [](const Answer& a) { return with_digits(a.stored, a); }, {"stored", "{}"}},
    {"tolerance", &Answer::tolerance},
    {"ok", &Answer::ok},
    {"", [](const Answer& a) { return a.ok() ? "ok" : "WRONG"; }, {""}}};

}  // namespace

ExitStatus doctor(bool json, const KokkosArguments& kokkos) {
  const KokkosSession session(kokkos);
  const StudyMachine machine = this_machine();
  const auto measuring = DoctorClock::now();
  const Limits limits = measure_limits();
  const double measured = since(measuring);
  const auto testing = DoctorClock::now();
  const std::vector<Answer> answers = self_test();
  const double tested = since(testing);
  const bool ok = std::ranges::all_of(answers, &Answer::ok);
  const ExitStatus status = ok ? ExitStatus::done : ExitStatus::failed;
  if (json) {
    std::cout << json_text(
        {{"machine", machine_json(machine)},
         {"vector_bytes", PLICA_VECTOR_BYTES},
         {"limits",
          {{"memory_bandwidth", limits.memory},
           {"cache_bandwidth", limits.cache},
           {"flops_double", limits.flops},
           {"flops_float", limits.flops_float},
           {"wall_time", measured}}},
         {"self_test",
          {{"ok", ok}, {"wall_time", tested}, {"answers", answer_columns.json(answers)}}}});
    return status;
  }
  const auto giga = [](double value, const char* unit) {
    return fmt::format("{:.1f} {}", value / 1e9, unit);
  };
  std::cout
      << version_text() << "\n\n"
      << text_table(
             {{"processor", fmt::format("{}, {}", machine.cpu, counted(machine.cores, "core"))},
              {"back end",
               fmt::format("{}, {}", machine.backend, counted(machine.threads, "thread"))},
              {"vectors",
               fmt::format("{} bytes: {} numbers in double, {} in float", PLICA_VECTOR_BYTES,
                           Backend<double, Kokkos::DefaultExecutionSpace>::lanes,
                           Backend<float, Kokkos::DefaultExecutionSpace>::lanes)},
              {"memory", giga(limits.memory, "GB/s")},
              {"cache", giga(limits.cache, "GB/s")},
              {"arithmetic", giga(limits.flops, "Gflop/s in double, ") +
                                 giga(limits.flops_float, "Gflop/s in float")}},
             "<<")
      << fmt::format(
             "  (measured in {:.1f} s: triad over {} in all and {} a thread, multiply-adds)\n\n",
             measured, in_bytes(static_cast<std::size_t>(in_memory)),
             in_bytes(static_cast<std::size_t>(in_cache)));
  std::cout << answer_columns.text(answers)
            << fmt::format("  a ball falls into a bowl, cycle him, {:.1f} s: {}\n", tested,
                           ok ? "all ok" : "not the stored answer");
  return status;
}

}  // namespace plica::app
