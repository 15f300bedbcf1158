// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Core.hpp>
#include <chrono>
#include <optional>
#include <plica/drivers/app/commands/arguments.hpp>
#include <plica/drivers/app/output/terminal.hpp>
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

/// Where and how a simulation runs, for people.
struct Machine {
  std::string backend;  ///< "OpenMP"
  int threads = 0;      ///< on a GPU: how many it runs at a time
  std::string precision;
};

/// Loads the scene, starts Kokkos and calls action(scene, simulation, machine, set-up time [s]).
template <class Action>
auto with_simulation(const SceneArguments& arguments, const Action& action) {
  const auto start = std::chrono::steady_clock::now();
  const Scene scene = load_scene(arguments.scene, arguments.overrides);
  for (const std::string& warning : scene.warnings) message(coloured("warning: ", Colour::yellow) + warning);
  const KokkosSession session(arguments.kokkos);
  const auto run = [&]<class B>(std::type_identity<B>) {
    std::optional<Simulation<B>> simulation;
    try {
      simulation.emplace(scene.problem);
    } catch (const InputError& error) {
      throw located(error, scene.source);
    }
    using Exec = typename B::Exec;
    const Machine machine{Exec::name(), Exec().concurrency(), arguments.precision};
    const std::chrono::duration<double> set_up = std::chrono::steady_clock::now() - start;
    return action(scene, *simulation, machine, set_up.count());
  };
  using Exec = Kokkos::DefaultExecutionSpace;
  return arguments.precision == "float" ? run(std::type_identity<Backend<float, Exec>>{})
                                        : run(std::type_identity<Backend<double, Exec>>{});
}

}  // namespace plica::app
