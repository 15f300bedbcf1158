// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Core.hpp>
#include <chrono>
#include <optional>
#include <plica/drivers/app/commands/arguments.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/solver/set_up/plan_steps.hpp>
#include <plica/drivers/solver/simulation.hpp>
#include <type_traits>

namespace plica::app {

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
};

using Clock = std::chrono::steady_clock;

/// Starts Kokkos and calls action(scene, simulation, machine, set-up time since `start` [s]).
template <class Action>
auto with_simulation(const Scene& scene, const std::string& precision, const KokkosArguments& kokkos,
                     Clock::time_point start, const Action& action) {
  const KokkosSession session(kokkos);
  const auto run = [&]<class B>(std::type_identity<B>) {
    std::optional<Simulation<B>> simulation;
    try {
      simulation.emplace(scene.problem);
    } catch (const SubstepRefused& error) {
      throw located(in_input_numbers(error, scene), scene.source);
    } catch (const InputError& error) {
      throw located(error, scene.source);
    }
    using Exec = typename B::Exec;
    const Machine machine{Exec::name(), Exec().concurrency(),
                          std::is_same_v<typename B::Real, float> ? "float" : "double"};
    const std::chrono::duration<double> set_up = Clock::now() - start;
    return action(scene, *simulation, machine, set_up.count());
  };
  using Exec = Kokkos::DefaultExecutionSpace;
  return precision == "float" ? run(std::type_identity<Backend<float, Exec>>{})
                              : run(std::type_identity<Backend<double, Exec>>{});
}

/// The same for the scene that the arguments name.
template <class Action>
auto with_simulation(const SceneArguments& arguments, const Action& action) {
  const auto start = Clock::now();
  const Scene scene = load_scene(arguments.scene, arguments.overrides);
  warn(scene);
  return with_simulation(scene, arguments.precision, arguments.kokkos, start, action);
}

}  // namespace plica::app
