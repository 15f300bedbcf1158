// SPDX-License-Identifier: BSD-3-Clause
// A run: a simulation is set up, steps, is checked, and recovers where it can. Queries of it are in
// simulation_views.cpp, its set-up is in build_hierarchy.cpp.
//
// Ownership. A Simulation owns a Hierarchy: the body at several resolutions, finest first. Each
// Level owns its data (rest shape, masses, state, work arrays), the forces on it and its
// integrator. A Stepper decides how the levels take a macro step together; it owns what belongs to
// no single level. Nothing points upwards: a level knows of no stepper, a stepper of no simulation.
//
// A macro step of the paper's cycle, downwards through the files:
//
//   Simulation::step                        this file
//     VCycle::step                          cycles/v_cycle.hpp
//       restrict, finest to coarsest        kernels/transfer/transfer.hpp
//       coarsest to finest:
//         interpolate from the coarser one  kernels/transfer/transfer.hpp
//         integrate its share               cycles/shared_step.hpp
//           Integrator::advance             time/explicit.cpp
//             Level::evaluate         level/level.cpp
//               elastic forces              elastic/elasticity.cpp, and the kernels of the material
//               loads, contact, the caller's
//             update velocity and place     kernels/time/updates.hpp
//
// With an implicit level, advance is in time/implicit.cpp: it sets the base of a stage, and
// StageSolver (time/stage_solver.hpp) linearises the level and solves, by a LinearSolver of
// linear/. The hierarchical inverse mass (cycles/him/him_stepper.hpp) evaluates the forces of the
// finest level once, and all levels contribute to the response.
//
// A step enqueues work and returns. check() waits, reads flags and sums, and examines nothing but
// the present state. recover() repairs a bad state. It goes back to the last snapshot and lets the
// stepper repair itself, or takes the macro steps since then again in halves
// (simulation_recovery.cpp). Programs that want all of this call step_checked().
#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/core/time_functions.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/methods/rest.hpp>
#include <plica/drivers/run/compose_levels.hpp>
#include <plica/drivers/run/move_obstacles.hpp>
#include <plica/drivers/run/simulation_impl.hpp>
#include <plica/drivers/run/validate.hpp>

namespace plica {

namespace {

constexpr double time_rounding = 1e-9;  // relative
// part of an edge per macro step: the energy of slower motion is always allowed
constexpr double least_edge = 1e-3;

/// Returns the problem that is stepped, which is checked.
Problem steppable(const Problem& p, Validation validation, bool on_ranks) {
  if (!p.body.covers.empty()) {
    Problem composed = p;
    compose_levels(composed.body, composed.contact);
    return steppable(composed, validation, on_ranks);
  }
  if (on_ranks)
    if (const std::string why = refused_by_ranks(p); !why.empty()) throw InputError(why);
  if (validation == Validation::needed) validate(p);
  if (p.integration.cycle == "auto")
    throw InputError(
        "integration.cycle is auto, which a simulation does not decide; expected a cycle by its "
        "name: "
        "choose_cycle() of plica/drivers/study/choose_cycle.hpp finds one by short trials");
  return problem_at_rest(p);
}

}  // namespace

// --- Set-up --------------------------------------------------------------------------------------

template <class B>
Simulation<B>::Simulation(const Problem& problem, const Exec& exec, Validation validation)
    : impl_(std::make_unique<Impl>(problem, exec, validation)) {}
template <class B>
Simulation<B>::Simulation(const Problem& problem, const Exec& exec, Ranks& ranks,
                          Validation validation)
    : impl_(std::make_unique<Impl>(problem, exec, validation, &ranks)) {}
template <class B>
Simulation<B>::~Simulation() {
  if (impl_ && impl_->leads) impl_->tell(Call::end);
}

template <class B>
Simulation<B>::Impl::Impl(const Problem& p, const Exec& exec, Validation validation, Ranks* of)
    : problem(steppable(p, validation, of && of->count() > 1)),
      built(build_hierarchy<B>(problem, exec, of)),
      queue(exec),
      meter(*built.hierarchy, built.meshes.front(), built.reports.front().mass, p.gravity),
      held(built.held),
      motions(p.contact),
      control(most_halvings(problem)),
      fronts(p.cuts.size()) {
  check_couplings(p.contact, built.macro_step);
  problem.body.levels.clear();
  rest.resize(built.hierarchy->levels.size());
  if (built.stepper->can_repair()) fallback.emplace();
  budget_known = p.body.prescribed.empty() && p.body.loads.empty() &&
                 std::none_of(p.contact.obstacles.begin(), p.contact.obstacles.end(),
                              [](const ObstacleOptions& o) { return moves(o); });
  if (const std::size_t count = wrench_names(p).size(); count > 0)
    wrench = zeros<Doubles<B>>("plica::contact.wrenches", 6 * count);
  if (const Contact<B>* contact = hierarchy()[0].contact()) memory = contact->memory();
  judges = std::ranges::any_of(hierarchy().levels,
                               [](const auto& level) { return level.integrator->judges(); });
  if (control.halves()) part_start.emplace();
  if (control.halves() && wrench.extent(0) > 0)
    wrench_sum = zeros<Doubles<B>>("plica::contact.wrench_sum", wrench.extent(0));
  linear = !find_material(p.body.material.model)->rotation_invariant;
  if (const auto& part = problem.body.following)
    ends = ends_of_vertices(part->coarser, part->refined);
  if (of && of->count() > 1) ranks = of, join_numbers();
  reset_snapshots();
  open_budget();
}

// --- Step ----------------------------------------------------------------------------------------

template <class B>
void Simulation<B>::step() {
  const LedCall led(*impl_, Call::step);
  if (impl_->step_start) impl_->keep(*impl_->step_start);
  if (!impl_->problem.cuts.empty()) cut_ahead();
  if (impl_->problem.body.following) follow_ahead();
  Impl& s = *impl_;
  s.residual = 0;
  const Kokkos::Timer timer;
  s.stepped([&] {
    if (s.control.halves() && (s.judges || s.control.divides())) return s.cover(false);
    s.advance(s.time, s.next_span()), s.unsolved += s.left_unsolved() > 0 ? 1 : 0;
    return std::optional<Diagnosis>();
  });
  s.arrive();
  if (!s.cores) return;
  if (const auto exec = s.cores->after_step(timer.seconds())) s.hierarchy().clock.set_exec(*exec);
}

template <class B>
void Simulation<B>::end_at(double time) {
  if (std::isnan(time))
    throw InputError("end_at: the time is no number; expected one, or infinity for no end");
  const LedCall led(*impl_, Call::end_at, time);
  impl_->end = time;
}

/// Returns whether the next macro step would go beyond the end that a caller has set.
template <class B>
bool Simulation<B>::Impl::reaches_end() const {
  return time < end &&
         origin + static_cast<double>(steps + 1) * built.macro_step > (1 + time_rounding) * end;
}

template <class B>
double Simulation<B>::Impl::next_span() const {
  if (reaches_end()) return end - time;
  const double whole = origin + static_cast<double>(steps) * built.macro_step;
  return built.macro_step - (time - whole);  // time - whole is 0, except after a shorter step
}

/// Sets the time after a macro step, and counts it unless it was made shorter.
template <class B>
void Simulation<B>::Impl::arrive() {
  time = reaches_end() ? end : origin + static_cast<double>(++steps) * built.macro_step;
}

/// Takes a macro step or a part of it. The caller sets the time.
template <class B>
void Simulation<B>::Impl::advance(double from, double span) {
  // launch each kernel alone: a profiler is to see every one, or the clock waits for each stage
  const bool apart = !graphs || hierarchy().clock.on || Kokkos::Tools::profileLibraryLoaded();
  const typename LaunchQueue<Exec>::Scope gather(apart ? nullptr : &queue);
  if (const Contact<B>* contact = hierarchy()[0].contact()) motions.go_on(*contact, from);
  hierarchy().begin_macro_step(span / built.macro_step);
  apply_grasp_schedule(hierarchy(), from, span);
  built.stepper->step(hierarchy(), from, span);
  move_obstacles(hierarchy(), wrench, from + span, span);
  launch_gathered<Exec>();
  for (const auto& level : hierarchy().levels)
    residual = std::max(residual, level.integrator->residual());
  worst_residual = std::max(worst_residual, residual);
}

template <class B>
std::optional<Diagnosis> Simulation<B>::step_checked() {
  const LedCall led(*impl_, Call::step_checked);
  if (!impl_->problem.cuts.empty())
    if (const auto refused = cut_checked()) return refused;
  step();
  auto bad = check();
  if (bad) bad = recover(*bad);
  return bad;
}

// --- Check ---------------------------------------------------------------------------------------

template <class B>
std::optional<Diagnosis> Simulation<B>::check() {
  Impl& s = *impl_;
  const LedCall led(s, Call::check);
  const auto bad = s.examine();
  if (bad) return bad;
  s.keep_at_times();
  s.built.stepper->regrow(s.hierarchy(), s.built.macro_step, s.steps);
  return {};
}

template <class B>
std::optional<Diagnosis> Simulation<B>::Impl::examine(double part) {
  if (budget_opens) open_budget();
  const MotionReport now = meter.motion(drift);
  const LevelReport& finest = built.reports.front();
  const bool lost = built.stepper->lost_stability(hierarchy(), now.about_mean),
             late = built.stepper->detects_late();
  if (lost && !late) return failure("stability");
  const double substep =
      finest.share * built.macro_step / (std::max(1, finest.substeps) * built.stepper->parts());
  if (auto bad = find_failure(now, now.edges_per_second * substep * part)) return bad;
  if (lost) return failure("stability");
  drift = now.drift;
  return {};
}

/// Returns the first check that fails. `motion`: largest displacement of a vertex in a sub-step,
/// relative to the body, over its edge.
template <class B>
std::optional<Diagnosis> Simulation<B>::Impl::find_failure(const MotionReport& now, double motion) {
  if (control.halves()) look_at_end();
  if (auto inverted = find_inverted<B>(built)) return inverted->motion_over_edge = motion, inverted;
  const Energies& e = now.energies;
  if (!std::isfinite(e.kinetic) || !std::isfinite(e.potential)) return failure("non_finite");
  for (std::size_t i = 0; i < hierarchy().levels.size(); ++i)
    if (const std::string why = hierarchy().levels[i].integrator->failure(); !why.empty()) {
      Diagnosis bad = failure("solver", motion, static_cast<int>(i), why);
      const int vertex = hierarchy().levels[i].integrator->failed_vertex();
      if (vertex >= 0) bad.vertex = vertex, bad.element = -1;
      if (seeks_rest(problem.integration)) bad.remedy = "less load, or more support of the body";
      return bad;
    }
  if (const Contact<B>* contact = hierarchy()[0].contact())
    if (const int point = lost_point(*contact); point >= 0)
      return failure("contact", motion, 0, "surface point " + std::to_string(point));
  put_in = std::max(put_in, start - e.potential);
  // Elastic and contact energy are not negative, so that kinetic energy beyond what was put in is
  // an error. Twice as much is allowed, since discrete energies oscillate; and never less than the
  // energy of a motion by a thousandth of an edge per step.
  const LevelReport& finest = built.reports.front();
  const double edge_speed = least_edge * finest.mean_edge / built.macro_step;
  const double allowed = 2 * put_in + 0.5 * finest.mass * edge_speed * edge_speed;
  // The elastic energy counts too, except where it is not complete, or where a step lowers its
  // incremental potential and so limits it.
  const bool stores = control.halves() && !judges && !is_viscous(problem.body);
  if (budget_known && e.kinetic + (stores ? meter.all(time).elastic : 0) > allowed)
    return failure("energy", motion);
  // An explicit sub-step is about the time that sound takes across half an element. A vertex that
  // leaves the body as a whole by more than an edge in it is faster than sound: it passes through
  // elements within a step, whatever the forces are. Excepted is a law that is linear in any state,
  // and so stable at any amplitude.
  if (finest.explicit_integrator && !linear && motion > 1) return failure("speed", motion);
  return {};
}

/// Flags the elements of level 0 that are inverted in the present state. Else the next step's first
/// force would flag them: early enough to stop, but too late to take this step again. In the same
/// way, an element may have taken up energy that nothing has put in.
template <class B>
void Simulation<B>::Impl::look_at_end() {
  const Level<B>& level = hierarchy()[0];
  if (level.flags.raised.data())
    level.elasticity().force(level.exec(), level, level.state, std::numeric_limits<int>::max());
}

template <class B>
Diagnosis Simulation<B>::Impl::failure(const std::string& kind, double motion, int level,
                                       const std::string& reason) {
  Diagnosis d = locate_failure<B>(kind, built, kept.levels, level, reason);
  d.motion_over_edge = motion;
  return d;
}

#define PLICA_INSTANTIATE(Real, Exec) template class Simulation<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
