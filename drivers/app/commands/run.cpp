// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <sys/resource.h>

#include <iostream>
#include <plica/drivers/app/commands/run.hpp>
#include <plica/drivers/app/commands/run_loop.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/summary.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/write_file.hpp>

namespace plica::app {
namespace {

std::size_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

template <class B>
void announce(const Scene& scene, const Simulation<B>& simulation, const Machine& machine) {
  std::string tets;
  for (const LevelReport& level : simulation.levels()) tets += (tets.empty() ? "" : " + ") + std::to_string(level.tets);
  message(fmt::format("{}: {} tetrahedra, {}, macro step {}; {} on {}, {}", scene.name, tets,
                      scene.problem.integration.cycle, in_units(simulation.macro_step(), "s"), machine.precision,
                      machine.backend, counted(machine.threads, "thread")));
}

template <class B>
Summary summary_of(const Scene& scene, const Simulation<B>& simulation, const Machine& machine, const RunEnd& end) {
  Summary summary;
  summary.status = end.status;
  summary.simulated_time = end.time;
  summary.macro_step = simulation.macro_step();
  summary.macro_steps = end.macro_steps;
  summary.wall_time = end.wall_time;
  summary.peak_memory = peak_memory();
  summary.precision = machine.precision;
  summary.backend = machine.backend;
  summary.threads = machine.threads;
  summary.cycle = scene.problem.integration.cycle;
  summary.levels = simulation.levels();
  summary.stages = simulation.stages();
  summary.counters = simulation.counters();
  summary.residual = simulation.worst_residual();
  summary.diagnosis = end.diagnosis;
  return summary;
}

// As the mesh file numbers them
Diagnosis in_input_numbers(Diagnosis diagnosis, const Scene& scene) {
  const Numbering& numbering = scene.numbering[static_cast<std::size_t>(std::max(diagnosis.level, 0))];
  diagnosis.element = input_number(numbering.tet_ids, diagnosis.element);
  diagnosis.vertex = input_number(numbering.vertex_ids, diagnosis.vertex);
  return diagnosis;
}

ExitStatus status_of(const RunEnd& end) {
  if (end.diagnosis) return ExitStatus::diverged;
  return end.status == "interrupted" ? ExitStatus::interrupted : ExitStatus::done;
}

}  // namespace

ExitStatus run(const RunArguments& arguments) {
  catch_interrupts();
  const auto simulate = [&]<class B>(const Scene& scene, Simulation<B>& simulation, const Machine& machine,
                                     double set_up_time) {
    const std::filesystem::path folder = arguments.folder.empty() ? "out" / arguments.scene.stem() : arguments.folder;
    make_folder(folder);
    RunFiles files(scene, folder);
    if (!arguments.quiet) announce(scene, simulation, machine);
    simulation.time_stages(B::on_host || arguments.time_stages);  // on a host there is nothing to wait for
    const double every = scene.output.every.value_or(scene.duration / 60);
    RunEnd end = [&] {
      Progress progress(scene.duration, arguments.quiet);
      return run_loop(simulation, scene.duration, every, files, progress);
    }();
    if (end.diagnosis) end.diagnosis = in_input_numbers(*end.diagnosis, scene);
    Summary summary = summary_of(scene, simulation, machine, end);
    summary.setup_time = set_up_time;
    summary.frames = files.frames();
    summary.last_good_time = files.last_time();
    write_file(folder / "summary.json", summary_json(scene, summary, arguments.words));
    if (end.diagnosis) message(coloured("diverged: ", Colour::red) + end.diagnosis->text());
    if (!arguments.quiet) std::cout << summary_text(scene, summary, folder.string());
    return status_of(end);
  };
  return with_simulation(arguments, simulate);
}

}  // namespace plica::app
