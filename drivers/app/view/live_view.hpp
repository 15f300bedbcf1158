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

/// Options of a live view.
struct LiveOptions {
  const Port& port;         ///< port of the page's address
  std::string method = {};  ///< method that runs, as text
  /// called once with the page's address
  std::function<void(const std::string&)> listening = {};
  /// called between macro steps, at least fifty times a second; true ends the view
  std::function<bool()> ended = {};
};

/// Returns the method as text: the cycle, its macro step, and the error class of its choice, if
/// any.
template <class B>
std::string live_method(const Scene& scene, const Simulation<B>& simulation,
                        const std::optional<CycleChoice>& choice);

/// Simulates from the present state and serves a page that shows it. A user of the page can pull
/// the body, push it with a ball and change gravity. The simulation pauses while no page is open.
/// The user's forces are added to `forces`, the simulation's external forces; at the end `forces`
/// act alone again. Throws InputError if the back end is not on the host.
template <class B>
void show_live(const Scene& scene, Simulation<B>& simulation, const LiveOptions& options,
               const ExternalForces<B>& forces = {});

}  // namespace plica::app
