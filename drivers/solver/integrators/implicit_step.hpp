// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <plica/drivers/solver/integrators/integrator.hpp>
#include <plica/drivers/solver/integrators/stage_solver.hpp>
#include <plica/kernels/contact/wrenches.hpp>

namespace plica {

/// What implicit integrators have in common: they take a step by stages; a step that is not solved is accepted, halved and tried
/// again, or ends the run.
template <class B>
class ImplicitStep : public Integrator<B> {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;

  ImplicitStep(const Level<B>& level, const IntegratorParts<B>& parts)
      : stages_(level, parts),
        unfinished_(parts.implicit.unfinished),
        most_halvings_(unfinished_ == "halve" && (parts.contact || parts.implicit.newton_iterations > 1)
                           ? parts.implicit.halvings
                           : 0) {
    for (int i = 0; i < most_halvings_; ++i) before_.emplace_back("implicit.before", level.model.vertices);
  }

  void advance(SolverLevel<B>& level, double time, double h, int steps) override {
    stages_.begin();
    failed_ = false;
    for (int s = 0; s < steps && !failed_; ++s)
      failed_ = !attempt(level, time + s * h, h, 0, std::numeric_limits<double>::infinity());
  }
  std::string failure() const override { return failed_ ? "Newton's method has not solved a step" : std::string(); }
  double residual() const override { return stages_.residual(); }
  std::map<std::string, long> counters() const override {
    std::map<std::string, long> all = stages_.counters();
    if (most_halvings_ > 0) all["step_halvings"] = halvings_;
    return all;
  }
  std::size_t bytes() const override {
    std::size_t kept = 0;
    for (const State<B>& state : before_) kept += 2 * state.u.span() * sizeof(Real);
    return stages_.bytes() + kept;
  }
  void persist(StateArchive<B>& archive) override {
    archive.number(halvings_);
    stages_.persist(archive);
  }

 protected:
  /// From `time` over h [s], the level's state at the start being consistent with given motions. False where a stage is not
  /// solved.
  virtual bool step(SolverLevel<B>& level, double time, double h) = 0;
  StageSolver<B>& stages() { return stages_; }
  /// How contact's force over the last step is part of its impulse.
  virtual CarriedImpulse impulse(double h) const { return {h}; }
  /// From the stage in the level's state to the end of the step, where that is another.
  virtual void finish(SolverLevel<B>&, double /*h*/) {}

 private:
  StageSolver<B> stages_;
  std::string unfinished_;
  int most_halvings_;
  std::vector<State<B>> before_;  ///< of the steps that are being halved
  long halvings_ = 0;
  bool failed_ = false;

  void accept(SolverLevel<B>& level, double time, double h) {
    if (level.contact()) level.book("contact", [&] { level.response().end_stage(level.exec(), level, level.state); });
    finish(level, h);
    prescribe(level.exec(), level, level.state, time + h);
    if (!level.contact()) return;
    level.count_contact(time + h, impulse(h));
  }

  /// `before`: what was left unsolved of the step that this is a half of. A half that leaves no less is not halved again: it and
  /// one that is too short to halve are taken as they are, like any step with `accept`. False with `stop` alone.
  bool attempt(SolverLevel<B>& level, double time, double h, int depth, double before) {
    const Exec& exec = level.exec();
    const bool halves = depth < most_halvings_;
    if (halves) before_[static_cast<std::size_t>(depth)].copy(exec, level.state);
    const long misses = stages_.misses();
    level.remember(time);
    prescribe(exec, level, level.state, time, h);
    const bool solved = step(level, time, h);
    if (!solved && unfinished_ == "stop") return false;
    const double left = stages_.unsolved();
    if (solved || !halves || !(left < before)) return accept(level, time, h), true;
    ++halvings_;
    stages_.set_misses(misses);
    level.state.copy(exec, before_[static_cast<std::size_t>(depth)]);
    attempt(level, time, h / 2, depth + 1, left);
    attempt(level, time + h / 2, h / 2, depth + 1, left);
    return true;
  }
};

}  // namespace plica
