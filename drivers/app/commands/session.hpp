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
#include <plica/drivers/run/validate.hpp>
#include <plica/drivers/study/choose_cycle.hpp>
#include <string>
#include <thread>
#include <type_traits>

namespace plica::app {

/// Says on the standard error what a set-up is doing, once it takes more than two seconds: one line
/// per phase, on a terminal or not. The library names its phases as regions of Kokkos' profiling
/// interface, "plica: ...", and this listens to them. One at a time.
class SetUpProgress {
 public:
  explicit SetUpProgress(bool quiet);
  ~SetUpProgress();
  SetUpProgress(const SetUpProgress&) = delete;
  SetUpProgress& operator=(const SetUpProgress&) = delete;

  /// A phase of the application's own begins; the last one ends.
  void phase(const std::string& name);
  /// From here on listens to the library, until finish(). Needs Kokkos.
  void listen();
  /// The set-up is over; nothing is said any more. The time since the start [s].
  double finish();

 private:
  using Clock = std::chrono::steady_clock;
  static void begin_region(const char* name);
  static void end_region();
  void enter(const std::string& name);
  void say() const;
  void wait();

  bool quiet_, listening_ = false, late_ = false, over_ = false;
  int depth_ = 0;  // regions within a region are part of its phase
  std::string current_;
  Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable changed_;
  std::thread thread_;
};

/// Kokkos from here to the end of the scope.
class KokkosSession {
 public:
  explicit KokkosSession(const KokkosArguments& arguments);
  ~KokkosSession() { Kokkos::finalize(); }
  KokkosSession(const KokkosSession&) = delete;
  KokkosSession& operator=(const KokkosSession&) = delete;
};

/// With elements as the mesh files number them.
std::vector<LevelReport> in_input_numbers(std::vector<LevelReport> levels, const Scene& scene);
/// The same with the element as the mesh file numbers it.
SubstepRefused in_input_numbers(const SubstepRefused& error, const Scene& scene);

/// What the scene's author should know, on the standard error.
void warn(const Scene& scene);

/// Where and how a simulation runs, for people.
struct Machine {
  std::string backend;  ///< "OpenMP"
  int threads = 0;      ///< on a GPU: how many it runs at a time
  std::string precision;
  std::optional<CycleChoice> choice = {};  ///< of cycle auto: what it has come to
};

/// What becomes of cycle auto at a set-up.
struct CycleAuto {
  bool trials = true;                      ///< false: level 0 alone, and nothing is tried
  std::optional<CycleChoice> choice = {};  ///< that was made before: of the run that goes on
};

/// The simulation of a scene, and what cycle auto has come to.
template <class B>
std::optional<CycleChoice> set_up(std::optional<Simulation<B>>& simulation, const Scene& scene,
                                  const CycleAuto& made) {
  const Problem& problem = scene.problem;
  if (problem.integration.cycle != "auto") return simulation.emplace(problem), std::nullopt;
  validate(problem);
  std::optional<CycleChoice> choice = made.choice;
  if (!choice) simulation.emplace(level_0_alone(problem));
  if (!choice && made.trials) choice = choose_cycle<B>(problem, *simulation, {scene.duration, {}});
  if (choice && (!simulation || choice->cycle != "single"))
    simulation.emplace(with_choice(problem, choice));
  return choice;
}

/// Starts Kokkos and calls action(scene, simulation, machine, set-up time since `progress` began
/// [s]).
template <class Action>
auto with_simulation(const Scene& scene, const std::string& precision,
                     const KokkosArguments& kokkos, SetUpProgress& progress, const Action& action,
                     const CycleAuto& made = {}) {
  const KokkosSession session(kokkos);
  progress.listen();
  const auto run = [&]<class B>(std::type_identity<B>) {
    std::optional<CycleChoice> choice;
    std::optional<Simulation<B>> simulation;
    try {
      choice = set_up<B>(simulation, scene, made);
    } catch (const SubstepRefused& error) {
      throw located(in_input_numbers(error, scene), scene.source);
    } catch (const InputError& error) {
      throw located(error, scene.source);
    }
    using Exec = typename B::Exec;
    const Machine machine{Exec::name(), Exec().concurrency(),
                          std::is_same_v<typename B::Real, float> ? "float" : "double", choice};
    return action(scene, *simulation, machine, progress.finish());
  };
  using Exec = Kokkos::DefaultExecutionSpace;
  return in_precision<Exec>(precision.empty() ? "double" : precision, run);
}

/// The scene that the arguments name, with its meshes; its warnings go to the standard error.
Scene loaded(const SceneArguments& arguments, SetUpProgress& progress);

/// The same for that scene.
template <class Action>
auto with_simulation(const SceneArguments& arguments, const Action& action,
                     const CycleAuto& made = {}) {
  SetUpProgress progress(false);
  const Scene scene = loaded(arguments, progress);
  return with_simulation(scene, arguments.precision, arguments.kokkos, progress, action, made);
}

}  // namespace plica::app
