// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/error.hpp>
#include <plica/drivers/study/stability_scene.hpp>

namespace plica {

namespace {

/// Why the run did not come to its end; none where it did.
template <class B>
std::optional<SceneLimit> failure_of(const Problem& problem, double duration, const std::function<void()>& go_on) {
  SceneLimit failed;
  failed.failed_step = problem.integration.macro_step;
  try {
    Simulation<B> simulation(problem);
    const long steps = std::lround(std::ceil(duration / simulation.macro_step() - 1e-9));
    for (long n = 0; n < steps; ++n) {
      failed.failed_time = simulation.time();
      simulation.step();
      failed.failure = simulation.check();
      if (failed.failure) {
        failed.reason = failed.failure->text();
        return failed;
      }
      go_on();
    }
  } catch (const InputError& error) {
    failed.reason = error.what();
    return failed;
  }
  return {};
}

}  // namespace

template <class B>
SceneLimit scene_limit(const Problem& problem, double duration, const StepRange& range,
                       const std::function<void()>& go_on) {
  SceneLimit found;
  Problem p = problem;
  p.integration.allow_unstable = true;
  const LargestStep largest = largest_stable(range, [&](double step) {
    p.integration.macro_step = step;
    const auto failed = failure_of<B>(p, duration, go_on);
    if (failed && (!found.failed_step || step < *found.failed_step)) found = *failed;
    return !failed;
  });
  if (largest.kind != LargestStep::Kind::growing) found.step = largest.step;
  return found;
}

#define PLICA_INSTANTIATE(Real, Exec)                                                            \
  template SceneLimit scene_limit<Backend<Real, Exec>>(const Problem&, double, const StepRange&, \
                                                       const std::function<void()>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
