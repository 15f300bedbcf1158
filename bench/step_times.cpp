// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/run/busy_cores.hpp>
#include <plica/version.hpp>

// plica_step_times SCENE [--set KEY.PATH=VALUE ...] [--threads N] [--precision WORD] [--limit
// SECONDS]: how long each macro step of a scene takes where the caller checks it and reads the
// obstacles' wrenches after it, as a simulator with a haptic device does. Prints JSON, writes no
// files. Exit: 0, also where the run diverges, which `status` says; 2 for a scene that is refused.
namespace plica::app {
namespace {

struct StepTimes {
  // of each step; the part of it in which its threads had no core [s]
  std::vector<double> wall, waited;
  std::vector<bool> touches;  // whether an obstacle's force is not zero
  std::string status = "completed", diagnosis;
};

template <class B>
StepTimes timed_steps(Simulation<B>& simulation, double duration, int threads, double limit) {
  StepTimes times;
  simulation.share_cores();
  const Kokkos::Timer since_start;
  while (simulation.time() < duration - 0.5 * simulation.macro_step()) {
    if (since_start.seconds() > limit) {
      times.status = "stopped";
      return times;
    }
    const CoreWait wait;
    const Kokkos::Timer timer;
    const std::optional<Diagnosis> failure = simulation.step_checked();
    const std::vector<Wrench> wrenches = simulation.wrenches();
    times.wall.push_back(timer.seconds());
    times.waited.push_back(wait.share(threads).value_or(0) * times.wall.back());
    times.touches.push_back(
        std::ranges::any_of(wrenches, [](const Wrench& w) { return w.force.norm() > 0; }));
    if (failure) {
      times.status = "diverged", times.diagnosis = failure->text();
      return times;
    }
  }
  return times;
}

template <class B>
nlohmann::json measured(const Scene& scene, Simulation<B>& simulation, const Machine& machine,
                        double set_up, double limit) {
  const StepTimes times = timed_steps(simulation, scene.duration, machine.threads, limit);
  const LevelReport& finest = simulation.levels().front();
  const std::vector<Wrench> wrenches = simulation.wrenches();
  return {{"status", times.status},
          {"diagnosis", times.diagnosis},
          {"tets", finest.tets},
          {"vertices", finest.vertices},
          {"critical_step", finest.critical_step},
          {"solver", finest.linear_solver},
          {"levels", simulation.levels().size()},
          {"macro_step", simulation.macro_step()},
          {"simulated", simulation.time()},
          {"set_up", set_up},
          {"force", wrenches.empty() ? 0 : wrenches.front().force.norm()},
          {"counters", simulation.counters()},
          {"machine", {machine.backend, machine.precision, machine.threads}},
          {"program", std::string(version()) + " " + git_revision() + ", " + compiler()},
          {"wall", times.wall},
          {"waited", times.waited},
          {"touches", times.touches}};
}

int print_step_times(int argc, char** argv) {
  CLI::App app("the wall time of each macro step of a scene");
  SceneArguments arguments;
  std::vector<std::string> sets;
  double limit = 1e9;
  app.add_option("SCENE", arguments.scene)->required();
  app.add_option("--set", sets);
  app.add_option("--threads", arguments.kokkos.threads);
  app.add_option("--precision", arguments.precision);
  app.add_option("--limit", limit, "stop after so many seconds of steps");
  CLI11_PARSE(app, argc, argv);
  for (const std::string& set : sets) arguments.overrides.push_back({set, "--set " + set});
  try {
    std::cout << with_simulation(arguments, [&](const Scene& scene, auto& simulation,
                                                const Machine& machine, double set_up) {
      return measured(scene, simulation, machine, set_up, limit);
    }) << '\n';
  } catch (const InputError& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  return 0;
}

}  // namespace
}  // namespace plica::app

int main(int argc, char** argv) { return plica::app::print_step_times(argc, argv); }
