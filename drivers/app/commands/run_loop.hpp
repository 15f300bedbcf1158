// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <chrono>
#include <plica/drivers/app/commands/interrupt.hpp>
#include <plica/drivers/app/commands/run_output.hpp>
#include <plica/drivers/app/output/progress.hpp>
#include <plica/drivers/app/output/step_count.hpp>

namespace plica::app {

/// Steps on to the end of the scene, or until Ctrl-C or divergence, and keeps the files on disk up to date. Whole macro steps:
/// the last one may reach beyond the duration.
template <class B>
RunEnd run_loop(Simulation<B>& simulation, double duration, RunEnd end, RunOutput<B>& output, Progress& progress) {
  const double step = simulation.macro_step();
  const long steps = steps_to_cover(duration, step);
  output.record(end);
  while (end.macro_steps < steps && !interrupted()) {
    const auto start = std::chrono::steady_clock::now();
    simulation.step();
    end.diagnosis = simulation.check();
    end.wall_time += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (end.diagnosis) break;
    ++end.macro_steps;
    end.time = static_cast<double>(end.macro_steps) * step;
    output.record(end);
    progress.update(end.time, end.macro_steps, [&] { return halvings_of(simulation); });
  }
  double last = end.time;
  if (end.diagnosis) {
    simulation.return_to_last_good();
    last = simulation.time();
  }
  if (end.diagnosis || end.macro_steps < steps) end.status = end.diagnosis ? "diverged" : "interrupted";
  output.finish(end, last);
  return end;
}

}  // namespace plica::app
