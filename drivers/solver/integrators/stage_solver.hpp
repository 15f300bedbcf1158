// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <plica/drivers/solver/linear/linear_solver.hpp>
#include <plica/kernels/boundary_conditions.hpp>
#include <plica/kernels/elastic/carried_pressures.hpp>
#include <plica/kernels/energies.hpp>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/implicit/stage_kernels.hpp>
#include <utility>

namespace plica {

/// Solves the stages of implicit integrators: M (v - v~) = b F(u~ + (a/b)(v - v~), v), for a level's state, by one linear solve
/// about the start of the step (linearly implicit: Baraff & Witkin 1998) or by Newton's method with a line search on the
/// incremental potential (Nocedal & Wright, Numerical Optimization, alg. 3.1; Gast et al. 2015). Where nodal elements smooth their
/// pressures, it carries these from solve to solve: kernels/elastic/carried_pressures.hpp.
template <class B>
class StageSolver {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;

  StageSolver(const Level<B>& level, const ImplicitOptions& options, std::unique_ptr<LinearSolver<B>> solver)
      : options_(options),
        solver_(std::move(solver)),
        base_("stage.base", level.model.vertices),
        right_side_("plica::stage.right_side", level.model.vertices),
        change_("plica::stage.change", level.model.vertices) {
    const auto slots = static_cast<std::size_t>(level.model.rows.slots());
    if (level.model.rows.excess.extent(0) > 0) {
      carrying_ = zeros<Scalars<B>>("plica::stage.pressure", 3 * slots);
      carried_ = Scalars<B>(carrying_.data() + 2 * slots, slots);
      last_carried_ = zeros<Scalars<B>>("plica::stage.last_pressure", slots);
    }
    dead_ = Vectors<B>("plica::stage.dead", level.model.vertices);
    blocks_ = BlockSums<B>(static_cast<int>(std::max(level.partial.extent(0), level.f.extent(0))));
    result_ = Doubles<B>("plica::stage.result", 6);
  }

  /// The base (u~, v~), to be set before solve().
  const State<B>& base() const { return base_; }

  /// Takes the level's state from the step's start at `time` [s] to the stage, `ahead` of it. False where Newton's method did not
  /// get there. `contact`: how it takes contact; a default one: not at all.
  bool solve(SolverLevel<B>& level, double time, double ahead, const ImplicitWeights& weights,
             const ContactStage& contact = {}) {
    contact_ = contact;
    prescribe(level.exec(), level, base_, time + ahead);
    if (!carries()) return solve_stage(level, time, ahead, weights);
    const Scalars<B> pressure = std::exchange(level.nodal.pressure, carrying_);
    if (fresh_) {
      fill(level.exec(), change_, Real(0));
      carry_pressures<B>(level.exec(), level, level.state.u, change_);
      fresh_ = 0;
    }
    const bool solved = solve_stage(level, time, ahead, weights);
    level.nodal.pressure = pressure;
    return solved;
  }

  /// Of the last stage that Newton's method did not solve: its residual over its first one.
  double unsolved() const { return unsolved_; }
  /// Stages that were not solved; those of a step that is taken again are taken back.
  long misses() const { return unfinished_; }
  void set_misses(long misses) { unfinished_ = misses; }

  /// The largest relative residual of a linear solve since begin().
  double residual() const { return residual_; }
  void begin() { residual_ = 0; }

  std::map<std::string, long> counters() const {
    std::map<std::string, long> all = solver_->counters();
    all.insert({{"linear_solves", solves_},
                {"cg_iterations", iterations_},
                {"cg_misses", misses_},
                {"cg_indefinite", indefinite_}});
    if (iterates() || newtons_ > 0)
      all.insert({{"newton_iterations", newtons_}, {"newton_misses", unfinished_}, {"line_searches", searches_}});
    if (carries()) all.insert({"pressure_updates", updates_});
    return all;
  }
  std::size_t bytes() const {
    return solver_->bytes() + 5 * 3 * sizeof(Real) * change_.extent(0) +
           sizeof(Real) * (carrying_.extent(0) + last_carried_.extent(0));
  }
  void persist(StateArchive<B>& archive) {
    for (long* count : {&solves_, &iterations_, &misses_, &indefinite_, &newtons_, &unfinished_, &searches_})
      archive.number(*count);
    archive.number(residual_);
    if (carries()) archive.number(updates_), archive.number(fresh_), archive.field("the carried pressures", carried_);
    solver_->persist(archive);
  }

 private:
  static constexpr int most_halvings = 12;    // of a direction
  static constexpr double sufficient = 1e-4;  // part of the decrease that the slope promises
  static constexpr double balanced = 3e-3;    // part of the forces in a stage with contact that may be left unbalanced
  static constexpr int contact_iterations = 16;
  static constexpr double unseen = 1e-10;  // of a stage's energies: what the potential gains less is lost in rounding

  ImplicitOptions options_;
  std::unique_ptr<LinearSolver<B>> solver_;
  State<B> base_;
  Vectors<B> right_side_, change_, dead_;
  Scalars<B> carrying_, carried_,
      last_carried_;  ///< with room for the pressures, these, and those before the last solve
  BlockSums<B> blocks_;
  Doubles<B> result_;
  long solves_ = 0, iterations_ = 0, misses_ = 0, indefinite_ = 0, newtons_ = 0, unfinished_ = 0, searches_ = 0;
  ContactStage contact_;
  long updates_ = 0, fresh_ = 1;  ///< of the carried pressures; whether they are still to be taken from a state
  double residual_ = 0, unsolved_ = 0;

  /// A state on the way.
  struct Potential {
    double value = 0;     ///< [J]
    double residual = 0;  ///< |R| [N]
    double slope = 0;     ///< R.change [J]
    double scale = 0;     ///< of what `value` adds up [J]
    double forces = 0;    ///< those that accelerate the body and those that do not depend on its state [N]
    bool solved = false;
    bool finite() const { return std::isfinite(value) && std::isfinite(residual); }
  };

  bool iterates() const { return options_.newton_iterations > 1; }
  bool carries() const { return carried_.extent(0) > 0; }
  StageAt<B> at(const Level<B>& level, const ImplicitWeights& w) const {
    return {level.model, base_, level.state, static_cast<Real>(w.a), static_cast<Real>(w.b)};
  }

  /// Whether nothing but inertia and the elements' stiffness is in a system.
  static bool is_stiffness_alone(const SolverLevel<B>& level) {
    return !level.contact() && level.followers.empty() && !level.viscosity &&
           level.model.patches.damping.extent(0) == 0;
  }

  bool solve_stage(SolverLevel<B>& level, double time, double ahead, const ImplicitWeights& weights) {
    if (touches(level)) return balance(level, time, ahead, weights);
    level.linearise(level.state, time, weights, ahead, level.f);
    if (iterates()) return newton(level, time + ahead, weights);
    const double before = residual_;
    const SolveOutcome out = correct(level, weights, true, options_.tangent == "positive");
    if (!out.indefinite || options_.tangent != "auto" || level.followers.empty() || level.prescribed.count > 0)
      return true;
    undo(level, weights, 1);  // the pressure takes more stiffness away than there is
    if (!out.converged) --misses_;
    residual_ = before;
    correct(level, weights, false, true);
    return true;
  }

  /// One linear solve at the linearised state, and the state that follows from it.
  SolveOutcome correct(SolverLevel<B>& level, const ImplicitWeights& w, bool from_start, bool positive) {
    const int n = level.model.vertices;
    const StageAt<B> stage = at(level, w);
    Vectors<B> force = level.f, gap;
    bool by_product = false;
    if (from_start) {
      gap = change_;
      update_vertices<B>(level.exec(), "plica::stage_gap", n, StageGap<B>{stage, gap});
    }
    SolveOutcome out;
    level.book("solve", [&] {
      solver_->prepare(level, level.state, w, positive);
      if (from_start && !positive && is_stiffness_alone(level))
        by_product = solver_->multiply(level.exec(), gap, right_side_);
    });
    if (from_start && !by_product) {
      if (!level.followers.empty()) {
        copy(level.exec(), right_side_, force);
        level.add_follower_product(level.state, gap, -1, positive, right_side_);
        force = right_side_;
      }
      level.tangent(level.state, gap);
    }
    update_vertices<B>(level.exec(), "plica::stage_right_side", n,
                       StageRightSide<B>{stage, force, level.partial, right_side_, gap, by_product});
    level.book("solve", [&] { out = solver_->solve(level.exec(), right_side_, change_); });
    ++solves_, iterations_ += out.iterations;
    misses_ += out.converged ? 0 : 1, indefinite_ += out.indefinite ? 1 : 0;
    residual_ = std::max(residual_, out.relative_residual);
    update_vertices<B>(level.exec(), "plica::stage_update", n, StageUpdate<B>{stage, change_});
    if (carries()) {
      copy(level.exec(), last_carried_, carried_);
      carry_pressures<B>(level.exec(), level, level.state.u, change_);
      ++updates_;
    }
    return out;
  }

  // --- With contact: Newton's method on the incremental potential, elements and contact at once ---------------------------------

  /// Whether contact acts in this stage.
  bool touches(const SolverLevel<B>& level) const { return level.contact() && contact_.span > 0; }

  /// From the step's start, with contact where its velocities lead to; every further state has a lower potential, with friction's caps as
  /// they are; then caps follow the normal forces. Ends as soon as what is unbalanced is a small part of the forces there are.
  bool balance(SolverLevel<B>& level, double time, double ahead, const ImplicitWeights& w) {
    const double end = time + ahead;
    ContactResponse<B>& contact = level.response();
    const ElementFlags<B> flags = std::exchange(level.flags, {});  // nobody watches where Newton's method looks
    level.book("contact", [&] { contact.begin_stage(level.exec(), level, level.state, time, contact_); });
    level.dead(end, dead_);
    fill(level.exec(), change_, Real(0));
    level.linearise(level.state, time, w, ahead, level.f);
    Potential now = potential_with(level, end, w, contact.balance(level.exec(), level, level.state));
    contact.linearise(level.exec(), level, level.state, w, ahead, level.f);
    const bool once = !solver_->converges();
    for (int k = 0; k < contact_iterations && !now.solved; ++k) {
      ++newtons_;
      const bool moving = k == 0 && level.prescribed.count > 0;  // given motions have changed what is compared
      bool projected = options_.tangent == "positive";
      SolveOutcome out = correct(level, w, k == 0, projected);
      if (once) break;
      double slope = vertex_terms(level, w, 1)[2];
      if (options_.tangent == "auto" && (out.indefinite || (k > 0 && !(slope < 0)))) {
        undo(level, w, 1);
        projected = true;
        out = correct(level, w, k == 0, true);
        slope = vertex_terms(level, w, 1)[2];
      }
      const std::optional<Potential> next = lower(level, end, w, before(level, end, w, now), k > 0 ? slope : 0, moving);
      if (!next) break;
      contact.update_caps(level.exec(), level, level.state);
      const ContactBalance by = contact.linearise(level.exec(), level, level.state, w, 0, level.f);
      now = potential_with(level, end, w, by);
      now.solved = now.residual <= balanced * (now.forces + by.forces);
    }
    level.flags = flags;
    if (once || now.solved) return true;
    ++unfinished_;
    unsolved_ = now.residual / std::max(now.forces, 1e-300);
    return false;
  }

  /// Shortens the change that the state has made until the potential is lower; level.f then are its forces without contact. None, and the
  /// change is undone, where it never is.
  std::optional<Potential> lower(SolverLevel<B>& level, double end, const ImplicitWeights& w, const Potential& now,
                                 double slope, bool moving) {
    double part = 1;
    for (int i = 0;; ++i) {
      level.linearise(level.state, end, w, 0, level.f);
      const Potential next = potential_with(level, end, w, level.response().balance(level.exec(), level, level.state));
      const double rounding =
          std::max(unseen, 16.0 * Kokkos::Experimental::epsilon_v<Real>) * std::max(now.scale, next.scale);
      if (next.finite() && (moving || next.value - now.value <= sufficient * part * slope + rounding)) return next;
      if (i == most_halvings) break;
      ++searches_;
      part /= 2;
      retreat(level, w, part);
    }
    undo(level, w, part);
    return {};
  }

  /// Of the state whose forces are in level.f, with contact's energy.
  Potential potential_with(const SolverLevel<B>& level, double end, const ImplicitWeights& w,
                           const ContactBalance& contact) const {
    Potential p = potential(level, end, w);
    p.value += contact.energy, p.scale += contact.energy;
    return p;
  }

  // --- Without contact ----------------------------------------------------------------------------------------------------------

  bool newton(SolverLevel<B>& level, double end, const ImplicitWeights& w) {
    level.dead(end, dead_);
    fill(level.exec(), change_, Real(0));
    const Potential now = potential(level, end, w);
    const double enough = std::max(options_.newton_residual, options_.newton_tolerance * now.residual);
    const ElementFlags<B> flags = std::exchange(level.flags, {});  // nobody watches where Newton's method looks
    const Potential last = iterate(level, end, w, now, enough);
    level.flags = flags;
    if (last.solved) return true;
    ++unfinished_;
    unsolved_ = last.residual / now.residual;
    return false;
  }

  /// The last state that it gets to: solved, or as near as it came.
  Potential iterate(SolverLevel<B>& level, double end, const ImplicitWeights& w, Potential now, double enough) {
    for (int i = 0; i < options_.newton_iterations && !now.solved; ++i) {
      ++newtons_;
      const std::optional<Potential> next = search(level, end, w, now, i == 0);
      if (!next) return now;
      // where what a step can still win is lost in rounding, this is as near as it gets
      const double lost = 16 * Kokkos::Experimental::epsilon_v<Real> * next->scale;
      const bool done = next->residual <= enough || (next->residual <= now.residual && std::abs(next->slope) <= lost);
      now = *next;
      now.solved = done;
    }
    return now;
  }

  /// From a state that is linearised to the next, which then is: along Newton's direction as far as the potential, or the
  /// residual where forces have none, goes down. Where it does not, along that of the projected tangents; where it does not
  /// there either, none, and the state is where it was.
  std::optional<Potential> search(SolverLevel<B>& level, double end, const ImplicitWeights& w, const Potential& now,
                                  bool first) {
    const bool moving = first && level.prescribed.count > 0;  // given motions have changed what is compared
    bool projected = options_.tangent == "positive";
    double slope = descend(level, w, first, moving, projected);
    for (;;) {
      if (auto next = shorten(level, end, w, before(level, end, w, now), slope, moving)) return next;
      if (projected || options_.tangent != "auto") return {};
      projected = true;
      level.linearise(level.state, end, w, 0, level.f);
      correct(level, w, false, true);
      slope = vertex_terms(level, w, 1)[2];
    }
  }

  /// What `now` was before the last change, with the pressures that are carried since.
  Potential before(SolverLevel<B>& level, double end, const ImplicitWeights& w, Potential now) const {
    if (!carries()) return now;
    now.value = vertex_terms(level, w, 1)[0];
    retreat(level, w, 1);
    now.value += stored(level, end);
    retreat(level, w, -1);
    return now;
  }

  /// Shortens the change that the state has made until it leads down; none, and the change is undone, where it never does.
  std::optional<Potential> shorten(SolverLevel<B>& level, double end, const ImplicitWeights& w, const Potential& now,
                                   double slope, bool moving) {
    double part = 1;
    for (int i = 0;; ++i) {
      level.linearise(level.state, end, w, 0, level.f);
      Potential next = potential(level, end, w);
      next.slope *= part;
      const double rounding = 16 * Kokkos::Experimental::epsilon_v<Real> * std::max(now.scale, next.scale);
      const bool lower = next.value - now.value <= sufficient * part * slope + rounding;
      if (next.finite() && (moving || !now.finite() || lower || next.residual < now.residual)) return next;
      if (i == most_halvings) break;
      ++searches_;
      part /= 2;
      retreat(level, w, part);
    }
    undo(level, w, part);
    return {};
  }

  /// Newton's step, and the potential's slope along it where it began. Where the tangent has no minimum in that direction,
  /// that of the elements' projected tangents.
  double descend(SolverLevel<B>& level, const ImplicitWeights& w, bool first, bool moving, bool& projected) {
    const SolveOutcome out = correct(level, w, first, projected);
    const double slope = vertex_terms(level, w, 1)[2];
    if (options_.tangent != "auto" || moving || (!out.indefinite && !(slope >= 0))) return slope;
    projected = true;
    undo(level, w, 1);
    correct(level, w, false, true);
    return vertex_terms(level, w, 1)[2];
  }

  void retreat(const SolverLevel<B>& level, const ImplicitWeights& w, double part) const {
    update_vertices<B>(level.exec(), "plica::stage_retreat", level.model.vertices,
                       StageRetreat<B>{at(level, w), change_, static_cast<Real>(part)});
  }

  /// Takes back what is left of a change.
  void undo(const SolverLevel<B>& level, const ImplicitWeights& w, double part) const {
    retreat(level, w, part);
    if (carries()) copy(level.exec(), carried_, last_carried_);
  }

  std::array<double, 6> read(const Exec& exec) const {
    const std::vector<double> sums = host_values(exec, result_);
    return {sums[0], sums[1], sums[2], sums[3], sums[4], sums[5]};
  }
  /// See StagePotential; `back`: of the state before the last change, while level.f are its forces.
  std::array<double, 6> vertex_terms(const SolverLevel<B>& level, const ImplicitWeights& w, double back) const {
    reduce<B, 6>(level.exec(), "plica::stage_potential", level.model.vertices,
                 StagePotential<B>{at(level, w), level.f, dead_, change_, static_cast<Real>(back)}, blocks_, result_);
    return read(level.exec());
  }
  /// Of the state whose forces are in level.f.
  Potential potential(const SolverLevel<B>& level, double end, const ImplicitWeights& w) const {
    const auto terms = vertex_terms(level, w, 0);
    const double energy = stored(level, end);
    return {terms[0] + energy, std::sqrt(terms[1]), terms[2], terms[3] + std::abs(energy),
            std::sqrt(terms[4]) + std::sqrt(terms[5])};
  }
  /// Of elements and pressures that follow the body at the level's state [J].
  double stored(const SolverLevel<B>& level, double end) const {
    level.incremental_energy(level.state);
    reduce<B, 1>(level.exec(), "plica::elastic_energy", level.model.shares.rows, FirstComponent<B>{level.partial},
                 blocks_, result_);
    return read(level.exec())[0] + level.follower_energy(end);
  }
};

}  // namespace plica
