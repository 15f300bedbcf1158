// SPDX-License-Identifier: BSD-3-Clause
// Recovery of a simulation: snapshots, steps that are taken again, states from outside.
#include <algorithm>
#include <cmath>
#include <plica/core/text.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/methods/rest.hpp>
#include <plica/drivers/run/move_obstacles.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/drivers/run/simulation_impl.hpp>
#include <plica/kernels/followers.hpp>

namespace plica {

namespace {

constexpr double time_rounding = 1e-9;  // relative
// macro steps between two snapshots; where macro steps can be halved, there is one after each
constexpr int keep_every = 20;
// least number of macro steps between the two snapshots
constexpr int long_ago = 200;
// maximum number of repairs of a stepper, until its steps stay stable to where the run was
constexpr int most_repairs = 8;

}  // namespace

// --- Recover -------------------------------------------------------------------------------------

template <class B>
std::optional<Diagnosis> Simulation<B>::recover(const Diagnosis& bad) {
  Impl& s = *impl_;
  const std::vector<Choice> kinds = diagnosis_kinds();
  const auto kind = std::ranges::find(kinds, bad.kind, &Choice::name) - kinds.begin();
  const LedCall led(s, Call::recover, static_cast<double>(kind));
  std::optional<Diagnosis> still = bad;
  if (s.built.stepper->repairs(bad) && repair(bad)) still.reset();
  if (still && s.control.halves()) still = s.retry(*still);
  if (!still) s.keep_at_times();
  return still;
}

/// Steps again to the present time, with a stepper that repairs itself. First it is repaired and
/// starts from the last snapshot. Then it starts from the older snapshot, if that is another one.
/// Then it is repaired once more and starts from there, and so on. Returns false where that does
/// not help.
template <class B>
bool Simulation<B>::repair(const Diagnosis& bad) {
  Impl& s = *impl_;
  const Stepper<B>& stepper = *s.built.stepper;
  const bool detects_late = stepper.detects_late();
  const bool late = bad.kind == "stability" && detects_late;  // the last snapshot is no better
  const double there = s.time;
  const auto go_on = [&] {
    while (s.time < there) {
      step();
      if (const auto now = s.examine();
          now && (now->kind == "non_finite" || now->kind == "inverted"))
        return false;
      s.call_after_repeated();
    }
    return !s.examine();
  };
  for (int attempt = late ? 2 : 0; attempt < most_repairs; ++attempt) {
    if (attempt == 1 && s.fallback->steps == s.kept.steps) continue;
    s.restore_snapshot(attempt == 0 ? s.kept : *s.fallback);
    if (attempt != 1 && !s.built.stepper->repair(s.hierarchy(), s.built.macro_step)) return go_on();
    // Explicit steps cannot continue what has grown in the last snapshot, and may take very long to
    // fail from it.
    if (attempt == 0 && !detects_late && stepper.detects_late())
      s.restore_snapshot(*s.fallback), attempt = 1;
    if (go_on()) return true;
  }
  return false;
}

/// Steps again from the last snapshot to the present time, in shorter parts. Returns a diagnosis
/// where that does not help.
template <class B>
std::optional<Diagnosis> Simulation<B>::Impl::retry(const Diagnosis& bad) {
  const double there = time;
  restore_snapshot(kept);
  ++rejected;
  // A step that is the only one since the snapshot is known to be bad in this division.
  if (there <= time + (1 + time_rounding) * next_span() && !control.halve()) return bad;
  while (time < there) {
    if (const auto still = stepped([&] { return cover(true); })) return still;
    arrive();
    call_after_repeated();
  }
  return {};
}

/// Adds the wrenches of a part of a macro step, weighted by its size, to the sum over the parts.
template <class B>
struct AddPart {
  Doubles<B> part, sum;
  Changing<B, double> size;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const { sum(i) += *size * part(i); }
};

/// Takes the next macro step, in parts as the control says. With `checks`, each part must pass all
/// of them, else it must only be solved. A part that is not solved is halved as long as that leaves
/// less unsolved. The shortest part is taken as it is.
template <class B>
std::optional<Diagnosis> Simulation<B>::Impl::cover(bool checks) {
  constexpr double all = std::numeric_limits<double>::infinity();
  const Exec& exec = hierarchy().exec();
  const double span = next_span();
  const int numbers = static_cast<int>(wrench_sum.extent(0));
  double least = all, size = 1;
  for (control.begin(); !control.done();) {
    size = control.size();
    keep(*part_start);
    advance(time + control.start() * span, size * span);
    const double left = left_unsolved();
    const auto bad = checks ? examine(size * span / built.macro_step) : std::nullopt;
    if (bad || (left > 0 && left < least)) {
      if (control.halve()) {
        ++rejected, least = bad ? all : left;
        restore_snapshot(*part_start);
        continue;
      }
      if (bad) return ++rejected, bad;
    }
    least = all, unsolved += left > 0 ? 1 : 0;
    if (left > 0 && seeks_rest(problem.integration)) break;  // the next check ends the run
    if (size < 1 && control.start() == 0) fill(exec, wrench_sum, 0.0);
    if (size < 1)
      update_vertices<B>(exec, "plica::add_wrenches", numbers,
                         AddPart<B>{wrench, wrench_sum, size});
    control.pass();
  }
  if (size < 1) copy_memory(exec, wrench_sum, wrench);
  return {};
}

template <class B>
double Simulation<B>::Impl::left_unsolved() const {
  double most = 0;
  for (const auto& level : built.hierarchy->levels)
    most = std::max(most, level.integrator->unsolved());
  return most;
}

// --- Snapshots, and states from outside ----------------------------------------------------------

template <class B>
void Simulation<B>::on_repeated_step(std::function<void()> call) {
  impl_->after_repeated = std::move(call);
}

template <class B>
long Simulation<B>::earliest_kept() const {
  return impl_->fallback ? std::min(impl_->fallback->steps, impl_->kept.steps) : impl_->kept.steps;
}

template <class B>
void Simulation<B>::return_to_last_good() {
  const LedCall led(*impl_, Call::return_to_last_good);
  impl_->restore_snapshot(impl_->kept);
}

template <class B>
void Simulation<B>::Impl::keep_at_times() {
  if (!control.halves() && steps - kept.steps < keep_every) return;
  if (fallback && kept.steps - fallback->steps >= long_ago) std::swap(kept, *fallback);
  keep(kept);
  motions.forget_before(fallback ? fallback->time : kept.time);
}

template <class B>
void Simulation<B>::keep_step_starts(bool on) {
  const LedCall led(*impl_, Call::keep_step_starts, on ? 1 : 0);
  impl_->step_start.reset();
  if (on) impl_->keep(impl_->step_start.emplace());
}

template <class B>
void Simulation<B>::return_to_step_start() {
  const LedCall led(*impl_, Call::return_to_step_start);
  impl_->restore_snapshot(impl_->step_start ? *impl_->step_start : impl_->kept);
}

/// Takes a snapshot of the present state and time.
template <class B>
void Simulation<B>::Impl::keep(Snapshot& to) {
  const Exec& exec = hierarchy().exec();
  const auto& levels = hierarchy().levels;
  if (to.levels.empty())
    for (const auto& level : levels) to.levels.emplace_back("kept", level.model.vertices);
  for (std::size_t i = 0; i < levels.size(); ++i) to.levels[i].copy(exec, levels[i].state);
  Archive<B> archive(Archive<B>::Task::keep, to.history, exec);
  name_history(archive);
  to.time = time, to.steps = steps, to.put_in = put_in, to.drift = drift;
}

/// Names what states alone do not tell: what integrators remember, relaxed stresses, memory of
/// obstacles, contact.
template <class B>
void Simulation<B>::Impl::name_history(Archive<B>& archive) {
  const auto each_level = [&](const auto& name) {
    for (std::size_t i = 0; i < hierarchy().levels.size(); ++i)
      archive.set_level(i), name(hierarchy().levels[i]);
  };
  each_level([&](Level<B>& level) { level.integrator->name_memory(archive); });
  each_level([&](Level<B>& level) {
    if (level.viscosity) level.viscosity->name_fields(archive, level, {});
  });
  archive.field("the memory of obstacles", memory);
  each_level([&](Level<B>& level) {
    if (level.contact()) level.response().name_kept(archive, hierarchy().exec(), level);
  });
}

/// Replaces all snapshots by the present state: nothing can go back to a state before it.
template <class B>
void Simulation<B>::Impl::reset_snapshots() {
  keep(kept);
  if (fallback) keep(*fallback);
  motions.reset_history();
}

/// Adds the state to the history of viscous stresses, before and after it is changed from outside.
template <class B>
void Simulation<B>::Impl::accept_state() {
  for (const auto& level : hierarchy().levels) level.accept_state(time);
}

/// Restores a snapshot of all levels. Coarser levels then start again from level 0's state.
template <class B>
void Simulation<B>::Impl::restore_snapshot(Snapshot& to) {
  const Exec& exec = hierarchy().exec();
  for (std::size_t i = 0; i < to.levels.size(); ++i)
    hierarchy().levels[i].state.copy(exec, to.levels[i]);
  time = to.time, steps = to.steps, put_in = to.put_in, drift = to.drift;
  hierarchy().clear_flags();
  hierarchy().reset_history();
  Archive<B> archive(Archive<B>::Task::put_back, to.history, exec);
  name_history(archive);
  if (const Contact<B>* contact = hierarchy()[0].contact()) {
    contact->take_lost(exec);
    motions.restore_snapshot(*contact, time);
  }
  built.stepper->begin(hierarchy());
}

/// Makes everything follow level 0's state, which was replaced: vertices that follow others, other
/// levels, snapshots, budget.
template <class B>
void Simulation<B>::Impl::restart() {
  follow_masters(hierarchy().exec(), level(0).model, level(0).state);
  hierarchy().clear_flags();
  hierarchy().reset_history();
  built.stepper->begin(hierarchy());
  accept_state();
  reset_snapshots();
  budget_opens = true;
}

template <class B>
void Simulation<B>::Impl::open_budget() {
  const Energies e = meter.all(time);
  start = put_in = e.total();
  drift = meter.motion(Point::Zero()).drift;
  kept.put_in = put_in, kept.drift = drift;
  if (fallback) fallback->put_in = put_in, fallback->drift = drift;
  budget_opens = false;
}

template <class B>
void Simulation<B>::set_state(const std::vector<Point>& displacement,
                              const std::vector<Point>& velocity) {
  Impl& s = *impl_;
  s.expect_one_process("set_state");
  const State<B>& state = s.hierarchy()[0].state;
  const auto expect = [&](const std::vector<Point>& all, const char* what) {
    if (all.size() != state.u.extent(0))
      throw InputError(text("set_state: ", all.size(), " ", what, " for ", state.u.extent(0),
                            " vertices of level 0"));
    const auto bad = std::ranges::find_if(all, [](const Point& p) { return !p.allFinite(); });
    if (bad != all.end())
      throw InputError(text("set_state: ", what, " ", bad - all.begin(),
                            " is not finite; expected finite numbers"));
  };
  expect(displacement, "displacements"), expect(velocity, "velocities");
  const auto copy = [&](const std::vector<Point>& from, const Vectors<B>& to, const char* what) {
    plica::copy(s.hierarchy().exec(), to,
                to_device<Vectors<B>>(what, rows<typename B::Real>(from)));
  };
  s.accept_state();
  s.fronts.assign(s.fronts.size(), {});
  s.hierarchy().exec().fence("plica::set_state");
  copy(displacement, state.u, "displacements"), copy(velocity, state.v, "velocities");
  s.restart();
}

template <class B>
void Simulation<B>::set_time(double time) {
  if (!std::isfinite(time))
    throw InputError("set_time: the time is " + number(time) + "; expected a finite one");
  Impl& s = *impl_;
  s.accept_state();
  for (const auto& level : s.hierarchy().levels)
    if (level.viscosity) level.viscosity->set_time(time);
  s.fronts.assign(s.fronts.size(), {});
  s.time = s.cut_until = time, s.origin = time - static_cast<double>(s.steps) * s.built.macro_step;
  s.hierarchy().reset_history();
  s.reset_snapshots();
}

template <class B>
void Simulation<B>::set_gravity(const Point& gravity) {
  if (!gravity.allFinite()) throw InputError("gravity: expected finite numbers [m/s^2]");
  Impl& s = *impl_;
  s.problem.gravity = gravity;
  for (auto& level : s.hierarchy().levels) level.set_gravity(gravity);
  s.meter.set_gravity(gravity);
  s.hierarchy().reset_history();
  s.reset_snapshots();
  s.open_budget();
}

#define PLICA_INSTANTIATE(Real, Exec) template class Simulation<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
