// SPDX-License-Identifier: BSD-3-Clause
// How a simulation goes back: states that are kept, steps that are taken again, states from outside.
#include <algorithm>
#include <cmath>
#include <plica/core/text.hpp>
#include <plica/drivers/solver/move_obstacles.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/drivers/solver/simulation_inside.hpp>

namespace plica {

namespace {

constexpr double time_rounding = 1e-9;  // relative
constexpr int keep_every = 20;          // macro steps
constexpr int long_ago = 200;           // macro steps, at least, between the two states that are kept
constexpr int most_repairs = 8;         // of a stepper, until its steps stay stable to where the run was

}  // namespace

// --- Recover ----------------------------------------------------------------------------------------------------------------

template <class B>
std::optional<Diagnosis> Simulation<B>::recover(const Diagnosis& bad) {
  Inside& s = *inside_;
  std::optional<Diagnosis> still = bad;
  if (s.built.stepper->repairs(bad) && repair(bad)) still.reset();
  if (still && s.retries()) still = s.retry(*still);
  if (!still) s.keep_at_times();
  return still;
}

/// From the last kept state once more to where it is, by a stepper that can do better; then by the same from the state long before; then by
/// one that does better still from there. False where the stepper cannot.
template <class B>
bool Simulation<B>::repair(const Diagnosis& bad) {
  Inside& s = *inside_;
  const bool late = bad.kind == "stability" && s.built.stepper->sees_late();  // the last kept one is no better
  const double there = s.time;
  const auto go_on = [&] {
    while (s.time < there) step();
    return !s.examine();
  };
  for (int attempt = late ? 2 : 0; attempt < most_repairs; ++attempt) {
    s.go_back(attempt == 0 ? s.kept : *s.older);
    if (attempt != 1 && !s.built.stepper->repair(s.hierarchy(), s.built.macro_step)) return go_on();
    if (go_on()) return true;
  }
  return false;
}

/// Once more from the last kept state: a macro step that is bad is halved, each half likewise, so often at most. Every macro
/// step starts whole and ends at its own time. What is left of `bad` where that does not help.
template <class B>
std::optional<Diagnosis> Simulation<B>::Inside::retry(const Diagnosis& bad) {
  const double there = time;
  go_back(kept);
  // Where it was the only step since, it is known to be bad as a whole.
  const bool known = there <= time + (1 + time_rounding) * next_span();
  ++rejected;
  std::optional<Diagnosis> still = bad;
  while (time < there) {
    const int left = problem.integration.retry.halvings;
    still = known ? halves(time, next_span(), left) : cover(time, next_span(), left);
    if (still) return still;
    arrive();
  }
  return {};
}

/// A span from `time`, whole, and in halves where that is bad.
template <class B>
std::optional<Diagnosis> Simulation<B>::Inside::cover(double from, double span, int left) {
  Kept before;
  keep(before);
  advance(from, span);
  const auto bad = examine(span / built.macro_step);
  if (!bad) return {};
  ++rejected;
  if (left == 0) return bad;
  go_back(before);
  return halves(from, span, left);
}

template <class B>
std::optional<Diagnosis> Simulation<B>::Inside::halves(double from, double span, int left) {
  ++halvings;
  if (const auto bad = cover(from, span / 2, left - 1)) return bad;
  return cover(from + span / 2, span / 2, left - 1);
}

// --- Kept states, and states from outside -----------------------------------------------------------------------------------

template <class B>
void Simulation<B>::return_to_last_good() {
  inside_->go_back(inside_->kept);
}

template <class B>
void Simulation<B>::Inside::keep_at_times() {
  if (!retries() && steps - kept.steps < keep_every) return;
  if (older && kept.steps - older->steps >= long_ago) std::swap(kept, *older);
  keep(kept);
  motions.forget_before(older ? older->time : kept.time);
}

/// The state and the time as they are.
template <class B>
void Simulation<B>::Inside::keep(Kept& to) {
  const Exec& exec = hierarchy().exec();
  const auto& levels = hierarchy().levels;
  if (to.levels.empty())
    for (const auto& level : levels) to.levels.emplace_back("kept", level.model.vertices);
  for (std::size_t i = 0; i < levels.size(); ++i) to.levels[i].copy(exec, levels[i].state);
  if (is_viscous(problem.body)) {
    to.stress.resize(levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i) levels[i].viscosity->keep(exec, levels[i], to.stress[i]);
  }
  copy_memory(exec, memory, to.memory);
  if (hierarchy()[0].contact()) {
    to.contact.resize(levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i) levels[i].response().keep(exec, to.contact[i]);
  }
  to.time = time, to.steps = steps, to.put_in = put_in, to.drift = drift;
}

/// Nothing before it counts any more.
template <class B>
void Simulation<B>::Inside::keep_anew() {
  keep(kept);
  if (older) keep(*older);
  motions.forget();
}

/// What is about to be changed from outside, or was.
template <class B>
void Simulation<B>::Inside::remember() {
  for (const auto& level : hierarchy().levels) level.remember(time);
}

/// To a state of all levels; coarser ones start from level 0's anew.
template <class B>
void Simulation<B>::Inside::go_back(const Kept& to) {
  copy_memory(hierarchy().exec(), to.memory, memory);
  for (std::size_t i = 0; i < to.levels.size(); ++i) hierarchy().levels[i].state.copy(hierarchy().exec(), to.levels[i]);
  for (std::size_t i = 0; i < to.stress.size(); ++i)
    hierarchy().levels[i].viscosity->put_back(hierarchy().exec(), hierarchy().levels[i], to.stress[i]);
  time = to.time, steps = to.steps, put_in = to.put_in, drift = to.drift;
  hierarchy().clear_flags();
  hierarchy().forget();
  for (std::size_t i = 0; i < to.contact.size(); ++i) {
    SolverLevel<B>& level = hierarchy().levels[i];
    level.response().put_back(hierarchy().exec(), level, to.contact[i]);
  }
  if (const Contact<B>* contact = hierarchy()[0].contact()) {
    contact->take_lost(hierarchy().exec());
    motions.go_back(*contact, time);
  }
  built.stepper->begin(hierarchy());
}

/// Level 0's state has been replaced: the other levels follow.
template <class B>
void Simulation<B>::Inside::restart() {
  hierarchy().clear_flags();
  hierarchy().forget();
  built.stepper->begin(hierarchy());
  remember();
  keep_anew();
  budget_opens = true;
}

template <class B>
void Simulation<B>::Inside::open_budget() {
  const Energies e = meter.all(time);
  start = put_in = e.total();
  drift = meter.motion(Point::Zero()).drift;
  kept.put_in = put_in, kept.drift = drift;
  if (older) older->put_in = put_in, older->drift = drift;
  budget_opens = false;
}

template <class B>
void Simulation<B>::set_state(const std::vector<Point>& displacement, const std::vector<Point>& velocity) {
  Inside& s = *inside_;
  const State<B>& state = s.hierarchy()[0].state;
  const auto expect = [&](const std::vector<Point>& all, const char* what) {
    if (all.size() != state.u.extent(0))
      throw InputError(text("set_state: ", all.size(), " ", what, " for ", state.u.extent(0), " vertices of level 0"));
    const auto bad = std::ranges::find_if(all, [](const Point& p) { return !p.allFinite(); });
    if (bad != all.end())
      throw InputError(text("set_state: ", what, " ", bad - all.begin(), " is not finite; expected finite numbers"));
  };
  expect(displacement, "displacements"), expect(velocity, "velocities");
  const auto copy = [&](const std::vector<Point>& from, const Vectors<B>& to, const char* what) {
    plica::copy(s.hierarchy().exec(), to, to_device<Vectors<B>>(what, rows<typename B::Real>(from)));
  };
  s.remember();
  s.hierarchy().exec().fence("plica::set_state");
  copy(displacement, state.u, "displacements"), copy(velocity, state.v, "velocities");
  s.restart();
}

template <class B>
void Simulation<B>::set_time(double time) {
  if (!std::isfinite(time)) throw InputError("set_time: the time is " + number(time) + "; expected a finite one");
  Inside& s = *inside_;
  s.remember();
  for (const auto& level : s.hierarchy().levels)
    if (level.viscosity) level.viscosity->set_time(time);
  s.time = time, s.origin = time - static_cast<double>(s.steps) * s.built.macro_step;
  s.hierarchy().forget();
  s.keep_anew();
}

#define PLICA_INSTANTIATE(Real, Exec) template class Simulation<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
