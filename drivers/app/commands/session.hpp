// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Core.hpp>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <plica/core/precision.hpp>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/cycles/plan_steps.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/choose_cycle.hpp>
#include <string>
#include <thread>
#include <type_traits>

namespace plica::app {

/// Prints the phases of a set-up that takes more than two seconds, one line each, on the standard
/// error. The library names its phases as regions "plica: ..." of Kokkos' profiling interface;
/// this class listens to them. At most one object may exist at a time.
class SetUpProgress {
 public:
  explicit SetUpProgress(bool quiet);
  ~SetUpProgress();
  SetUpProgress(const SetUpProgress&) = delete;
  SetUpProgress& operator=(const SetUpProgress&) = delete;

  /// Begins a phase of the application, and ends the phase before it.
  void phase(const std::string& name);
  /// Starts to listen to the library's phases, until finish(). Needs Kokkos.
  void listen();
  /// Ends the messages: the set-up is over. Returns the time since the start [s].
  double finish();

 private:
  using Clock = std::chrono::steady_clock;
  static void begin_region(const char* name);
  static void end_region();
  void enter(const std::string& name);
  void say() const;
  void wait();

  bool quiet_, listening_ = false, late_ = false, over_ = false;
  // nesting depth of regions; an inner region belongs to the phase of the outer one
  int depth_ = 0;
  std::string current_;
  Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable changed_;
  std::thread thread_;
};

/// Initialises Kokkos, and finalises it at the end of the scope.
class KokkosSession {
 public:
  explicit KokkosSession(const KokkosArguments& arguments);
  ~KokkosSession() { Kokkos::finalize(); }
  KokkosSession(const KokkosSession&) = delete;
  KokkosSession& operator=(const KokkosSession&) = delete;
};

/// Returns the reports with the numbers that the elements have in the mesh files.
std::vector<LevelReport> in_input_numbers(std::vector<LevelReport> levels, const Scene& scene);
/// Returns the error with the number that its element has in the mesh file.
SubstepRefused in_input_numbers(const SubstepRefused& error, const Scene& scene);

/// Prints the scene's warnings on the standard error.
void warn(const Scene& scene);

/// Hardware and settings of a simulation, to be printed.
struct Machine {
  std::string backend;  ///< "OpenMP"
  int threads = 0;      ///< number of threads; on a GPU: of those that run at a time
  std::string precision;
  std::optional<CycleChoice> choice = {};  ///< choice of cycle auto; none: another cycle
};

/// Options of a set-up with cycle auto.
struct CycleAuto {
  bool trials = true;                      ///< false: sets up level 0 alone, without trials
  std::optional<CycleChoice> choice = {};  ///< choice of the run that is resumed
  Ranks* ranks = nullptr;                  ///< ranks that share the body; null: one process
};

/// Makes the simulation of a scene, which load_scene() has validated. Returns what cycle auto has
/// chosen; none for other cycles.
template <class B>
std::optional<CycleChoice> set_up(std::optional<Simulation<B>>& simulation, const Scene& scene,
                                  const CycleAuto& made) {
  const Problem& problem = scene.problem;
  if (made.ranks)
    return simulation.emplace(problem, typename B::Exec{}, *made.ranks, Validation::done),
           std::nullopt;
  if (problem.integration.cycle != "auto")
    return simulation.emplace(problem, typename B::Exec{}, Validation::done), std::nullopt;
  std::optional<CycleChoice> choice = made.choice;
  if (!choice) simulation.emplace(level_0_alone(problem));
  if (!choice && made.trials) choice = choose_cycle<B>(problem, *simulation, {scene.duration, {}});
  if (choice && (!simulation || choice->cycle != "single"))
    simulation.emplace(with_choice(problem, choice));
  return choice;
}

/// Sets the simulation up, and calls action(scene, simulation, machine). Needs Kokkos. Throws
/// InputError with the location in the scene.
template <class Action>
auto with_set_up(const Scene& scene, const std::string& precision, const Action& action,
                 const CycleAuto& made = {}) {
  const auto run = [&]<class B>(std::type_identity<B>) {
    std::optional<CycleChoice> choice;
    std::optional<Simulation<B>> simulation;
    const auto make = [&] {
      try {
        choice = set_up<B>(simulation, scene, made);
      } catch (const SubstepRefused& error) {
        throw located(in_input_numbers(error, scene), scene.source);
      } catch (const InputError& error) {
        throw located(error, scene.source);
      }
    };
    made.ranks ? made.ranks->together(make) : make();  // all ranks refuse the same
    using Exec = typename B::Exec;
    const Machine machine{Exec::name(), Exec().concurrency(),
                          std::is_same_v<typename B::Real, float> ? "float" : "double", choice};
    return action(scene, *simulation, machine);
  };
  using Exec = Kokkos::DefaultExecutionSpace;
  return in_precision<Exec>(precision.empty() ? "double" : precision, run);
}

/// Starts Kokkos, sets the simulation up, and calls action(scene, simulation, machine, seconds).
/// The last argument is the time of the set-up, since `progress` began [s].
template <class Action>
auto with_simulation(const Scene& scene, const std::string& precision,
                     const KokkosArguments& kokkos, SetUpProgress& progress, const Action& action,
                     const CycleAuto& made = {}) {
  const KokkosSession session(kokkos);
  progress.listen();
  const auto run = [&](const Scene& of, auto& simulation, const Machine& machine) {
    return action(of, simulation, machine, progress.finish());
  };
  return with_set_up(scene, precision, run, made);
}

/// Returns the scene that the arguments name, with its meshes. Prints its warnings.
Scene loaded(const SceneArguments& arguments, SetUpProgress& progress);

/// Loads the scene that the arguments name, then calls with_simulation() for it.
template <class Action>
auto with_simulation(const SceneArguments& arguments, const Action& action,
                     const CycleAuto& made = {}) {
  SetUpProgress progress(false);
  const Scene scene = loaded(arguments, progress);
  return with_simulation(scene, arguments.precision, arguments.kokkos, progress, action, made);
}

}  // namespace plica::app
