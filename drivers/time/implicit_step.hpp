// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/drivers/time/integrator_parts.hpp>
#include <plica/drivers/time/stage_solver.hpp>
#include <plica/kernels/contact/wrenches.hpp>

namespace plica {

/// What implicit integrators have in common: they take a step by stages, and accept it whether it
/// is solved or not. unsolved() says how far it is not.
template <class B>
class ImplicitStep : public Integrator<B> {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;

  ImplicitStep(const Level<B>& level, const IntegratorParts<B>& parts)
      : stages_(level, parts), stops_(parts.stops) {}

  void advance(SolverLevel<B>& level, double time, double h, int steps) override {
    stages_.begin();
    unsolved_ = 0;
    for (int s = 0; s < steps; ++s) {
      const double start = time + s * h;
      level.remember(start);
      prescribe(level.exec(), level, level.state, start, h);
      if (!step(level, start, h)) unsolved_ = std::max(unsolved_, stages_.unsolved());
      accept(level, start, h);
    }
  }
  bool judges() const override { return stages_.judges(); }
  double unsolved() const override { return unsolved_; }
  std::string failure() const override {
    return stops_ && unsolved_ > 0
               ? "a step was not solved, or ended in contact that it did not know of"
               : std::string();
  }
  double residual() const override { return stages_.residual(); }
  std::map<std::string, long> counters() const override { return stages_.counters(); }
  std::size_t bytes() const override { return stages_.bytes(); }
  void persist(StateArchive<B>& archive) override {
    archive.number(surprised_), stages_.persist(archive);
  }

 protected:
  /// From `time` over h [s], the level's state at the start being consistent with given motions.
  /// False where a stage is not solved.
  virtual bool step(SolverLevel<B>& level, double time, double h) = 0;
  StageSolver<B>& stages() { return stages_; }
  /// How contact's force over the last step is part of its impulse.
  virtual CarriedImpulse impulse(double h) const { return {h}; }
  /// From the stage in the level's state to the end of the step, where that is another.
  virtual void finish(SolverLevel<B>&, double /*h*/) {}

 private:
  static constexpr double notable_motion = 0.1;  ///< part of the kinetic energy

  StageSolver<B> stages_;
  bool surprised_ = false;  ///< the last step ended with contact that was not foreseen
  bool stops_;              ///< where a step is not solved, the run ends
  double unsolved_ = 0;     ///< of the last advance()

  void accept(SolverLevel<B>& level, double time, double h) {
    if (level.contact())
      level.book("contact", [&] { level.response().end_stage(level.exec(), level, level.state); });
    finish(level, h);
    prescribe(level.exec(), level, level.state, time + h);
    if (!level.contact()) return;
    level.count_contact(time + h, impulse(h));
    if (!judges()) return;
    const double part = unforeseen(level, time + h);
    if (surprised_) unsolved_ = std::max(unsolved_, part);
    surprised_ = part > 0;
  }
  /// Contact that is found where a step ends, and that the step did not know of: its energy over
  /// that of the contact that was solved and a tenth of the motion's; 0 where it is no more than
  /// those. It throws the body. One such step is what comes into touch; a second in a row is not
  /// solved.
  double unforeseen(SolverLevel<B>& level, double time) {
    double solved = 0, found = 0;
    level.book("contact", [&] {
      solved = level.response().energy(level.exec(), level, time);
      found = level.response().energy_found(level.exec(), level, level.state, time);
    });
    if (!(found > 2 * solved)) return 0;
    const double part = (found - solved) / (solved + notable_motion * stages_.kinetic(level));
    return part > 1 ? std::min(part, 1e9) : 0;
  }
};

}  // namespace plica
