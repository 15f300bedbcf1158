// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/diagnose.hpp>
#include <plica/drivers/study/study_run.hpp>

namespace plica {

namespace {

using Clock = std::chrono::steady_clock;
using Exec = Kokkos::DefaultExecutionSpace;

constexpr double short_run = 0.2;  // [s]
constexpr int runs_if_short = 5;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

template <class E>
E instance(int threads) {
  const int most = E().concurrency();
  if (threads == 0 || threads == most) return {};
  if (threads < 0 || threads > most)
    throw InputError("study.threads: " + std::to_string(threads) + " threads; " + E::name() + " has " +
                     std::to_string(most));
#if defined(KOKKOS_ENABLE_OPENMP)
  if constexpr (std::is_same_v<E, Kokkos::OpenMP>) return E(threads);
#endif
  throw InputError("study.threads: " + std::string(E::name()) + " runs with all it has; leave study.threads out");
}

// Nothing takes energy out or brings it in, other than gravity
bool keeps_energy(const Problem& p) {
  return p.body.loads.empty() && p.body.prescribed.empty() && !damps_by_mass(p.body) && !damps_by_stiffness(p.body) &&
         p.contact.obstacles.empty();
}

template <class B>
class Measured {
 public:
  Measured(const Problem& problem, const Exec& exec, const StudyRunOptions& options)
      : options_(options),
        exec_(exec),
        start_(Clock::now()),
        simulation_(problem, exec),
        conserves_(keeps_energy(problem)),
        part_(0, 1 + options.timed_runs) {
    result_.setup_time = since(start_);
    result_.macro_step = simulation_.macro_step();
    result_.macro_steps = std::lround(std::ceil(options.duration / result_.macro_step - 1e-9));
    at_start_ = simulation_.save();
  }

  StudyRun all() {
    sampled();
    int runs = options_.timed_runs;
    for (int i = 0; i < runs && result_.status == "completed"; ++i) {
      simulation_.restore(at_start_);
      if (i == 0) wall_times_.clear();
      part_ = {i + 1, 1 + runs};
      timed();
      if (i == 0 && !wall_times_.empty()) runs = timed_runs_of(wall_times_[0], runs);
    }
    if (!wall_times_.empty()) {
      std::ranges::sort(wall_times_);
      result_.wall_time = wall_times_[wall_times_.size() / 2];
      result_.wall_time_spread = wall_times_.back() - wall_times_.front();
      result_.timed_runs = static_cast<int>(wall_times_.size());
    }
    return std::move(result_);
  }

 private:
  // One macro step; false where the run ends here
  bool step(double& wall_time) {
    const auto start = Clock::now();
    simulation_.step();
    const auto diagnosis = simulation_.check();
    wall_time += since(start);
    if (diagnosis) result_.status = "diverged", result_.reason = diagnosis->text();
    if (!diagnosis) result_.reached = simulation_.time();
    if (!diagnosis && options_.go_on && since(asked_) > 0.05) {
      asked_ = Clock::now();
      const double run = static_cast<double>(simulation_.macro_steps()) / static_cast<double>(result_.macro_steps);
      if (!options_.go_on((part_.first + run) / part_.second)) result_.status = "stopped";
    }
    return result_.status == "completed";
  }

  void sampled() {
    TrajectorySampler sampler(options_.sample_times, result_.macro_step, result_.macro_steps);
    const double before = conserves_ ? simulation_.energies().total() : 0;
    double most = 0, wall_time = 0;
    for (long n = 0;; ++n) {
      if (sampler.wants(n)) {
        sampler.add(n, to_host<B>(exec_, simulation_.displacement()), to_host<B>(exec_, simulation_.velocity()));
        if (conserves_) {
          const Energies e = simulation_.energies();
          most = std::max(most, e.kinetic + e.elastic + e.contact);
        }
      }
      if (n == result_.macro_steps) break;
      if (!step(wall_time)) return;
    }
    if (conserves_ && most > 0) result_.energy_drift = (simulation_.energies().total() - before) / most;
    result_.trajectory = sampler.take();
    result_.tet_evaluations = simulation_.counters().at("tet_evaluations");
    wall_times_.push_back(wall_time);
  }

  void timed() {
    double wall_time = 0;
    for (long n = 0; n < result_.macro_steps; ++n)
      if (!step(wall_time)) return;
    wall_times_.push_back(wall_time);
  }

  const StudyRunOptions& options_;
  Exec exec_;
  Clock::time_point start_, asked_{};
  Simulation<B> simulation_;
  bool conserves_;
  SavedState at_start_;
  StudyRun result_;
  std::vector<double> wall_times_;
  std::pair<int, int> part_;  // which of how many runs
};

template <class Real>
StudyRun run(const Problem& problem, const StudyRunOptions& options) {
  const Exec exec = instance<Exec>(options.threads);
  try {
    return Measured<Backend<Real, Exec>>(problem, exec, options).all();
  } catch (const InputError& error) {
    StudyRun refused;
    refused.status = "refused", refused.reason = error.what();
    return refused;
  }
}

}  // namespace

int timed_runs_of(double wall_time, int asked) {
  return asked > 0 && wall_time < short_run ? std::max(asked, runs_if_short) : asked;
}

void check_threads(int threads) { instance<Exec>(threads); }

StudyRun study_run(const Problem& problem, const StudyRunOptions& options) {
  if (options.precision == "double") return run<double>(problem, options);
  if (options.precision == "float") return run<float>(problem, options);
  throw InputError("study.precision: " + unknown_name("precision", options.precision, {"float", "double"}));
}

}  // namespace plica
