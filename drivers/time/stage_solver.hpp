// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <plica/drivers/linear/linear_solver.hpp>
#include <plica/drivers/time/incremental_potential.hpp>
#include <plica/drivers/time/integrator_parts.hpp>
#include <plica/drivers/time/stage_sums.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>
#include <plica/kernels/time/stage_kernels.hpp>
#include <plica/kernels/time/updates.hpp>
#include <utility>

namespace plica {

/// Solver of the stages of implicit integrators: M (v - v~) = b F(u~ + (a/b)(v - v~), v), for a
/// level's state. It uses one linear solve about the start of the step (linearly implicit: Baraff &
/// Witkin 1998), or Newton's method on the incremental potential (Gast et al. 2015). Where nodal
/// elements smooth their pressures, mixed dilatations are kept from solve to solve:
/// kernels/elastic/mixed_dilatations.hpp.
template <class B>
class StageSolver {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;

  StageSolver(const LevelData<B>& level, const IntegratorParts<B>& parts)
      : options_(parts.implicit),
        edge_(parts.edge),
        may_invert_(parts.may_invert),
        given_(on_any_rank<B>(level, level.prescribed.count > 0)),
        rest_(parts.rest),
        judged_(rest_ > 0 ? rest_
                          : parts.implicit.newton_tolerance.value_or(
                                parts.conserves && !parts.contact ? conserving : balanced)),
        aim_(rest_ > 0                         ? below_rest * rest_
             : parts.implicit.newton_tolerance ? judged_
                                               : judged_ * finer()),
        solver_(parts.make_linear_solver()),
        base_("stage.base", level.model.vertices),
        right_side_("plica::stage.right_side", level.model.vertices),
        change_("plica::stage.change", level.model.vertices) {
    const auto slots = static_cast<std::size_t>(level.model.rows.slots());
    if (level.model.rows.bulk_excess.extent(0) > 0) {
      carrying_ = zeros<Scalars<B>>("plica::stage.pressure", 3 * slots);
      carried_ = Scalars<B>(carrying_.data() + 2 * slots, slots);
      last_carried_ = zeros<Scalars<B>>("plica::stage.last_pressure", slots);
    }
    if (!parts.contact && !iterates()) return;
    dead_ = Vectors<B>("plica::stage.dead", level.model.vertices);
    sums_ = StageSums<B>(level);
  }

  /// Returns the base (u~, v~), which must be set before solve().
  const State<B>& base() const { return base_; }

  /// Solves the stage at time + ahead [s], from the level's state at the step's start, `time`.
  /// Returns false where Newton's method did not solve it.
  /// @param contact  times and factors of contact; a default one: no contact in this stage
  bool solve(Level<B>& level, double time, double ahead, const ImplicitWeights& weights,
             const ContactStage& contact = {}) {
    contact_ = contact;
    prescribe(level.exec(), level, base_, time + ahead);
    if (!carries()) return solve_stage(level, time, ahead, weights);
    const Scalars<B> pressure = std::exchange(level.nodal.pressure, carrying_);
    if (fresh_) {
      fill(level.exec(), change_, Real(0));
      level.elasticity().carry_dilatations(level.exec(), level, level.state.u, change_);
      fresh_ = 0;
    }
    const bool solved = solve_stage(level, time, ahead, weights);
    level.nodal.pressure = pressure;
    return solved;
  }

  /// Returns whether the last stage of a body that seeks rest began at rest: its forces were
  /// balanced without inertia. unsolved() is then, and else, the part of them that was not.
  bool began_at_rest() const { return at_rest_; }
  /// Computes the mixed dilatations of the next stage from the state that it starts from.
  void forget_dilatations() { fresh_ = 1; }
  /// Returns the sums over a level, of any vertices' values.
  const StageSums<B>& sums() const { return sums_; }

  /// Returns whether Newton's method may be used: then unsolved() tells which stages were not
  /// solved.
  bool judges() const { return sums_.any(); }
  /// Returns the kinetic energy of the level's state [J]. Waits for the device.
  double kinetic(const Level<B>& level) const { return sums_.kinetic(level); }
  /// Returns the unbalanced part of the forces in the last stage that Newton's method did not
  /// solve.
  double unsolved() const { return unsolved_; }

  /// Returns the largest unbalanced part of the forces in a stage since begin(). For a stage of one
  /// linear solve it is the relative residual of that.
  double residual() const { return residual_; }
  /// Resets residual() to 0.
  void begin() { residual_ = 0; }

  std::map<std::string, long> counters() const {
    std::map<std::string, long> all = solver_->counters();
    all.insert({{"linear_solves", solves_}, {"cg_iterations", iterations_}});
    all.insert({{"cg_misses", misses_}, {"cg_indefinite", indefinite_}});
    if (iterates() || newtons_ > 0)
      all.insert({{"newton_iterations", newtons_}, {"line_searches", searches_}});
    if (carries()) all.insert({"pressure_updates", updates_});
    return all;
  }
  void name_fields(Archive<B>& archive) {
    for (long* count : {&solves_, &iterations_, &misses_, &indefinite_, &newtons_, &searches_})
      archive.number(*count);
    archive.number(residual_), archive.number(projecting_);
    if (carries())
      archive.number(updates_), archive.number(fresh_),
          archive.field("the carried dilatations", carried_, RowItems::slots);
    archive.owns(base_, right_side_, change_, dead_, carrying_, last_carried_);
    sums_.name_fields(archive);
    solver_->name_fields(archive);
  }
  /// Names what steps that are taken again must begin with; see Integrator::name_memory().
  void name_memory(Archive<B>& archive) {
    archive.number(projecting_);
    if (carries())
      archive.number(fresh_), archive.field("the carried dilatations", carried_, RowItems::slots);
  }

 private:
  // maximum halvings of a change; maximum where another direction can still be tried
  static constexpr int most_halvings = 12, halvings_unprojected = 2;
  // part of the decrease expected from the slope that is sufficient
  static constexpr double sufficient = 1e-4;
  // maximum unbalanced part of the forces; for a method that conserves energy, without contact
  static constexpr double balanced = 3e-3, conserving = 1e-6;
  // motion that is too small to be seen, over the mean edge
  static constexpr double still = 1e-11;
  // part of the least volume ratio that a change of a state must keep
  static constexpr double least_volume_part = 0.2;
  static constexpr double first_tolerance = 0.01;  // relative tolerance of the first system
  // for rest: part of its tolerance that a stage is solved to; part of the residual that one must
  // leave at most
  static constexpr double below_rest = 0.1, progress = 0.5;
  // maximum iterations where contact alone needs them; systems in a row with projected tangents
  static constexpr int contact_iterations = 20, projections = 3;
  // part of a stage's energies: smaller changes of the potential are lost in rounding
  static constexpr double unseen = 1e-10;

  ImplicitOptions options_;
  double edge_;      ///< mean edge length [m]
  bool may_invert_;  ///< whether elements may invert
  bool given_;       ///< whether the motion of a vertex of the whole level is given
  double rest_;      ///< part of the forces that may be unbalanced at rest; 0: the body moves
  /// unbalanced parts of the forces: a stage with judged_ or less is solved; Newton's method ends
  /// at aim_ or less
  double judged_, aim_;
  std::unique_ptr<LinearSolver<B>> solver_;
  State<B> base_;
  Vectors<B> right_side_, change_, dead_;
  /// buffer whose end is carried_; mixed dilatations; mixed dilatations before the last solve
  Scalars<B> carrying_, carried_, last_carried_;
  StageSums<B> sums_;
  long solves_ = 0, iterations_ = 0, misses_ = 0, indefinite_ = 0, newtons_ = 0, searches_ = 0;
  ContactStage contact_;
  /// number of updates of the mixed dilatations; 1 where they must still be computed from a state
  long updates_ = 0, fresh_ = 1;
  double residual_ = 0, unsolved_ = 0;
  double loads_ = 0;      ///< norm of gravity and loads, where the body seeks rest [N]
  bool at_rest_ = false;  ///< see began_at_rest()
  bool cut_ = false;      ///< whether the last change was shortened
  /// number of further systems whose tangents are projected without a new reason
  long projecting_ = 0;

  bool iterates() const { return options_.newton_iterations > 1; }
  // not by its size: one of several ranks may have no slot
  bool carries() const { return last_carried_.use_count() > 0; }
  StageAt<B> at(const LevelData<B>& level, const ImplicitWeights& w) const {
    return {level.model, base_, level.state, static_cast<Real>(w.a), static_cast<Real>(w.b)};
  }

  bool solve_stage(Level<B>& level, double time, double ahead, const ImplicitWeights& weights) {
    if (touches(level) || iterates()) return minimise(level, time, ahead, weights);
    level.linearise(level.state, time, weights, ahead, level.f);
    const double tolerance = options_.relative_residual;
    SolveOutcome out = correct(level, weights, true, options_.tangent == "positive", tolerance);
    if (out.indefinite && options_.tangent == "auto" &&
        level.has_terms(TermStiffness::unassembled) && !given_) {
      undo(level, weights, 1);  // pressures that follow the body made the system indefinite
      if (!out.converged) --misses_;
      out = correct(level, weights, false, true, tolerance);
    }
    residual_ = std::max(residual_, out.relative_residual);
    return true;
  }

  /// Solves one linear system at the linearised state, and updates the state with its solution.
  SolveOutcome correct(Level<B>& level, const ImplicitWeights& w, bool from_start, bool projected,
                       double tolerance) {
    const int n = level.model.vertices;
    const StageAt<B> stage = at(level, w);
    Vectors<B> force = level.f, gap;
    bool by_product = false;
    if (from_start) {
      gap = change_;
      update_vertices<B>(level.exec(), "plica::stage_gap", n, StageGap<B>{stage, gap});
      follow_masters(level.exec(), level.model, gap);
    }
    SolveOutcome out;
    level.timed("solve", [&] {
      if (projected && solver_->reads_kept()) level.keep_tangents(level.state);
      solver_->prepare(level, level.state, w, projected);
      if (from_start && !projected && level.is_stiffness_alone())
        by_product = solver_->multiply(level.exec(), gap, right_side_);
    });
    if (from_start && !by_product) {
      if (level.has_stiff_terms()) {
        copy(level.exec(), right_side_, force);
        level.add_term_product(level.state, gap, -1, projected, right_side_);
        force = right_side_;
      }
      level.tangent(level.state, gap, 0, projected);
    }
    update_vertices<B>(
        level.exec(), "plica::stage_right_side", n,
        StageRightSide<B>{stage, force, level.partial, right_side_, gap, by_product});
    hold_sliding(level.exec(), level, right_side_);
    level.timed("solve",
                [&] { out = solver_->solve(level.exec(), right_side_, change_, tolerance); });
    hold_sliding(level.exec(), level, change_);
    ++solves_, iterations_ += out.iterations;
    misses_ += out.converged ? 0 : 1, indefinite_ += out.indefinite ? 1 : 0;
    update(level, w);
    if (carries()) {
      copy(level.exec(), last_carried_, carried_);
      level.elasticity().carry_dilatations(level.exec(), level, level.state.u, change_);
      ++updates_;
    }
    return out;
  }

  // --- Newton's method ---------------------------------------------------------------------------

  /// Returns whether contact acts in this stage.
  bool touches(const Level<B>& level) const { return level.contact() && contact_.span > 0; }

  /// Minimises the potential of elements and contact together, from the step's start. Systems are
  /// solved only as accurately as it pays (Eisenstat & Walker, SIAM J. Sci. Comput. 17, 1996). Each
  /// further state has a lower potential at fixed caps of friction, and keeps a part of the least
  /// volume. Then the caps are updated.
  bool minimise(Level<B>& level, double time, double ahead, const ImplicitWeights& w) {
    const double end = time + ahead;
    // no element flags are set at trial states of Newton's method
    const ElementFlags<B> flags = std::exchange(level.flags, {});
    if (touches(level))
      level.timed("contact", [&] {
        level.response().begin_stage(level.exec(), level, level.state, time, contact_);
      });
    level.dead_loads(end, dead_), hold_sliding(level.exec(), level, dead_);
    if (rest_ > 0) {
      copy(level.exec(), right_side_, dead_);
      loads_ = sums_.load_norm(level, end, right_side_);
    }
    fill(level.exec(), change_, Real(0));
    level.linearise(level.state, time, w, ahead, level.f);
    IncrementalPotential now = here(level, end, w);
    if (!may_invert_) now.volume = sums_.least_volume(level);
    if (touches(level)) {
      const ContactBalance by =
          level.response().linearise(level.exec(), level, level.state, w, ahead, level.f);
      if (rest_ > 0) now.forces += by.forces;
    }
    // A body at rest without given motions is solved at once
    now.solved = rest_ > 0
                     ? begins_at_rest(level, ahead, w, now)
                     : !given_ && std::sqrt(vertex_terms(level, w, 0)[1]) <= unseen_force(now, w);
    const double first = now.residual;
    const int most = iterates() ? options_.newton_iterations : contact_iterations;
    const bool once = !solver_->converges() && touches(level);
    // The change is 0: this only makes displacements consistent with the stage's velocities
    if (now.solved) update(level, w);
    double tolerance = carries() ? options_.relative_residual : first_tolerance * finer();
    for (int k = 0; k < most && !now.solved; ++k) {
      ++newtons_;
      const std::optional<IncrementalPotential> next =
          descend(level, time, ahead, w, now, k, tolerance);
      if (once || !next) break;
      const bool lost = std::abs(next->slope) <= rounding(*next) && next->residual <= now.residual;
      const double from = std::exchange(now, *next).residual;
      if (touches(level)) follow_caps(level, end, w, now);
      now.solved = is_balanced(now, w, aim_) || (lost && !touches(level));
      if (!carries())
        tolerance = finer() * std::clamp(0.1 * now.residual / from, 1e-4, first_tolerance);
    }
    level.flags = flags;
    const double unbalanced = now.residual / std::max(now.forces, 1e-300);
    if (rest_ == 0 && !is_balanced(now, w, 0)) residual_ = std::max(residual_, unbalanced);
    if (once || now.solved || is_balanced(now, w, judged_)) return true;
    if (rest_ > 0 && now.residual <= progress * first) return true;
    unsolved_ = std::isnan(unbalanced) ? 1 : unbalanced;
    return false;
  }

  /// Returns whether a stage begins at rest, and sets its residual: the forces without inertia,
  /// which vanishes there. Given motions, obstacles too, must have come to the end of the step.
  bool begins_at_rest(const Level<B>& level, double ahead, const ImplicitWeights& w,
                      IncrementalPotential& now) {
    now.residual = std::sqrt(vertex_terms(level, w, 0)[1]);
    const bool moves = ahead > 0 && (given_ || touches(level));
    unsolved_ = is_balanced(now, w, 0) ? 0 : now.residual / std::max(now.forces, 1e-300);
    at_rest_ = !moves && is_balanced(now, w, judged_);
    if (at_rest_) residual_ = std::max(residual_, unsolved_);
    return at_rest_;
  }

  /// Returns whether the unbalanced force is small enough. Limits are newton_residual, `part` of
  /// the sum of all forces, and unseen_force(). The sum does not depend on the velocity of a body.
  bool is_balanced(const IncrementalPotential& now, const ImplicitWeights& w, double part) const {
    return now.residual <=
           std::max({options_.newton_residual, part * now.forces, unseen_force(now, w)});
  }

  void follow_caps(Level<B>& level, double end, const ImplicitWeights& w,
                   IncrementalPotential& now) {
    ContactResponse<B>& contact = level.response();
    contact.update_caps(level.exec(), level, level.state);
    const ContactBalance by =
        contact.linearise(level.exec(), level, level.state, w, 0, level.f, cut_);
    const double volume = std::exchange(now, potential(level, end, w).beside(by.energy)).volume;
    now.volume = volume, now.forces += by.forces;
  }

  /// Returns the factor on the tolerances of systems and forces: relative_residual over its
  /// default, 1 at most.
  double finer() const {
    return std::min(1.0, options_.relative_residual / ImplicitOptions().relative_residual);
  }

  /// Returns the largest force that moves the body too little to be seen in the step [N]. In float
  /// that is the rounding of displacements: their inertia is no smaller in a shorter step.
  double unseen_force(const IncrementalPotential& p, const ImplicitWeights& w) const {
    return std::max(still, 16.0 * Kokkos::Experimental::epsilon_v<Real>) * edge_ * p.masses / w.a;
  }

  /// Goes from a linearised state to the next along Newton's direction, as far as it leads down.
  /// The next state is then linearised, without contact in level.f. Where Newton's direction does
  /// not lead down, that of the projected tangents is tried. If it does not lead down either, the
  /// state stays and nothing is returned.
  std::optional<IncrementalPotential> descend(Level<B>& level, double time, double ahead,
                                              const ImplicitWeights& w,
                                              const IncrementalPotential& now, int k,
                                              double tolerance) {
    const double end = time + ahead;
    // In the first system given motions move: potentials before and after cannot be compared
    const bool first = k == 0, moving = first && ahead > 0 && given_;
    const bool may_project = options_.tangent == "auto";
    bool projected = options_.tangent == "positive" || (may_project && projecting_ > 0);
    if (may_project && projecting_ > 0) --projecting_;
    for (bool from_start = first;; from_start = false) {
      const SolveOutcome out = correct(level, w, from_start, projected, tolerance);
      if (touches(level) && !solver_->converges()) return now;
      const double slope = vertex_terms(level, w, 1)[2];
      // In the first system contact is linearised ahead of the state, where the velocities lead to
      const bool ahead_of_it = from_start && ahead > 0 && touches(level);
      const bool leads_up = out.indefinite || (!ahead_of_it && !(slope < 0)),
                 last = projected || !may_project;
      double part = 1;
      if (moving || last || !leads_up) {
        const IncrementalPotential from = before(level, end, w, now);
        const int most = last && !ahead_of_it ? most_halvings : halvings_unprojected;
        if (auto next = shorten(level, end, w, from, ahead_of_it ? 0 : slope, moving, most, part))
          return next;
      }
      undo(level, w, part);
      if (last && !ahead_of_it) return {};
      if (!out.converged) --misses_;  // not counted: the system is solved again
      if (may_project) projecting_ = carries() ? 0 : projections, projected = true;
      level.linearise(level.state, end, w, 0, level.f);
      if (touches(level))
        level.response().linearise(level.exec(), level, level.state, w, 0, level.f);
    }
  }

  /// Shortens the last change of the state, to `part` of it, until the potential is lower. The
  /// least volume must also not be much lower than before. Returns nothing where that fails.
  std::optional<IncrementalPotential> shorten(Level<B>& level, double end, const ImplicitWeights& w,
                                              const IncrementalPotential& now, double slope,
                                              bool moving, int most, double& part) {
    cut_ = false;
    for (int i = 0;; ++i) {
      const double volume = may_invert_ ? 1 : sums_.least_volume(level);
      if (may_invert_ || !(now.volume > 0) || volume >= least_volume_part * now.volume) {
        level.linearise(level.state, end, w, 0, level.f);
        IncrementalPotential next = here(level, end, w);
        next.slope *= part, next.volume = volume;
        const bool falls = next.value - now.value <=
                           sufficient * part * slope + std::max(rounding(now), rounding(next));
        // Some forces have no potential: a smaller residual is accepted as well
        const bool nearer = !touches(level) && next.residual < now.residual;
        if (next.finite() && (moving || !now.finite() || falls || nearer)) return next;
      }
      if (i == most) return {};
      ++searches_;
      part /= 2, cut_ = true;
      retreat(level, w, part);
    }
  }

  /// Returns the rounding error of a potential [J].
  double rounding(const IncrementalPotential& p) const {
    return std::max(contact_.span > 0 ? unseen : 0.0,
                    16.0 * Kokkos::Experimental::epsilon_v<Real>) *
           p.scale;
  }

  /// Returns the potential of the state whose forces are in level.f, with contact's energy.
  IncrementalPotential here(Level<B>& level, double end, const ImplicitWeights& w) {
    const IncrementalPotential p = potential(level, end, w);
    return touches(level)
               ? p.beside(level.response().balance(level.exec(), level, level.state).energy)
               : p;
  }

  /// Returns `now` for the state before the last change, with its value at the present mixed
  /// dilatations.
  IncrementalPotential before(Level<B>& level, double end, const ImplicitWeights& w,
                              IncrementalPotential now) const {
    if (!carries()) return now;
    now.value = vertex_terms(level, w, 1)[0];
    retreat(level, w, 1);
    now.value += stored(level, end);
    retreat(level, w, -1);
    return now;
  }

  /// Changes the state by a solution, which becomes the change of displacement.
  void update(const Level<B>& level, const ImplicitWeights& w) const {
    update_vertices<B>(level.exec(), "plica::stage_update", level.model.vertices,
                       StageUpdate<B>{at(level, w), change_});
    follow_masters(level.exec(), level.model, level.state);
    follow_masters(level.exec(), level.model, change_);
  }
  void retreat(const Level<B>& level, const ImplicitWeights& w, double part) const {
    update_vertices<B>(level.exec(), "plica::stage_retreat", level.model.vertices,
                       StageRetreat<B>{at(level, w), change_, static_cast<Real>(part)});
    follow_masters(level.exec(), level.model, level.state);
  }

  /// Takes back `part` of the last change, which is all that is left of it.
  void undo(const Level<B>& level, const ImplicitWeights& w, double part) const {
    retreat(level, w, part);
    if (carries()) copy(level.exec(), carried_, last_carried_);
  }

  /// Returns the sums of StagePotential. `back`: 1 for the state before the last change, while
  /// level.f are the forces there; 0 for the present state.
  std::array<double, 7> vertex_terms(const Level<B>& level, const ImplicitWeights& w,
                                     double back) const {
    hold_sliding(level.exec(), level, level.f);
    return sums_.of(level, {at(level, w), level.f, dead_, change_, static_cast<Real>(back)});
  }
  /// Returns the potential of the state whose forces are in level.f, without contact.
  IncrementalPotential potential(const Level<B>& level, double end,
                                 const ImplicitWeights& w) const {
    const auto terms = vertex_terms(level, w, 0);
    const double energy = stored(level, end);
    return {
        terms[0] + energy,
        std::sqrt(terms[1]),
        terms[2],
        terms[3] + std::abs(energy),
        rest_ > 0 ? loads_ + sums_.reaction_norm(level) : std::sqrt(terms[4]) + std::sqrt(terms[5]),
        std::sqrt(terms[6])};
  }
  /// Returns the energy of elements and of pressures that follow the body at the level's state [J].
  double stored(const Level<B>& level, double end) const {
    return sums_.stored(level) + level.term_energy(end);
  }
};

}  // namespace plica
