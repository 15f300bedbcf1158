// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <chrono>
#include <cmath>
#include <plica/drivers/app/commands/interrupt.hpp>
#include <plica/drivers/app/output/progress.hpp>
#include <plica/drivers/app/output/run_files.hpp>

namespace plica::app {

/// How a run ended.
struct RunEnd {
  std::string status = "completed";  ///< completed | interrupted | diverged
  long macro_steps = 0;              ///< that passed the checks
  double time = 0;                   ///< after them [s]
  double wall_time = 0;              ///< of the steps and their checks [s]
  std::optional<Diagnosis> diagnosis;
};

/// Steps to the end of the scene, or until Ctrl-C or divergence, and keeps the files on disk up to date. Whole macro steps:
/// the last one may reach beyond the duration; frames come at the first step at or after each multiple of `every`.
template <class B>
RunEnd run_loop(Simulation<B>& simulation, double duration, double every, RunFiles& files, Progress& progress) {
  constexpr double rounding = 1e-9;  // of a step: 3 s are 100 steps of 30 ms
  const double step = simulation.macro_step();
  const long steps = std::lround(std::ceil(duration / step - rounding));
  RunEnd end;
  files.write(take_snapshot(simulation, 0));
  long next_frame = 1;
  while (end.macro_steps < steps && !interrupted()) {
    const auto start = std::chrono::steady_clock::now();
    simulation.step();
    end.diagnosis = simulation.check();
    end.wall_time += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (end.diagnosis) break;
    ++end.macro_steps;
    end.time = static_cast<double>(end.macro_steps) * step;
    if (end.time > static_cast<double>(next_frame) * every - rounding * step) {
      files.write(take_snapshot(simulation, end.time));
      next_frame = static_cast<long>(end.time / every + rounding) + 1;
    }
    progress.update(end.time, end.macro_steps);
  }
  double last = end.time;
  if (end.diagnosis) {
    simulation.return_to_last_good();
    last = simulation.time();
  }
  if (end.diagnosis || end.macro_steps < steps) end.status = end.diagnosis ? "diverged" : "interrupted";
  if (files.last_time() < last) files.write(take_snapshot(simulation, last));
  return end;
}

}  // namespace plica::app
