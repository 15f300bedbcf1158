// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <optional>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/app/view/web_server.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/choose_cycle.hpp>
#include <string>

namespace plica::app {

/// How a simulation is watched.
struct LiveOptions {
  const Port& port;         ///< of the page's address
  std::string method = {};  ///< that runs, in words
  /// is called once with the page's address
  std::function<void(const std::string&)> listening = {};
  std::function<bool()> ended =
      {};  ///< is asked between macro steps, fifty times a second or more often: whether to return
};

/// The method in words: the cycle, its macro step, and which error it was chosen for, if it was.
template <class B>
std::string live_method(const Scene& scene, const Simulation<B>& simulation,
                        const std::optional<CycleChoice>& choice);

/// Serves a page that shows the simulation while it goes on, from the state that it has, and lets
/// one pull at the body, push it with a ball and change gravity. It rests while no page is open.
/// Adds its forces to `forces`, the simulation's own, which are alone again at the end. InputError
/// where the back end is not on the host.
template <class B>
void show_live(const Scene& scene, Simulation<B>& simulation, const LiveOptions& options,
               const ExternalForces<B>& forces = {});

}  // namespace plica::app
