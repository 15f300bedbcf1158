// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/drivers/time/integrator_parts.hpp>
#include <plica/drivers/time/stage_solver.hpp>
#include <plica/kernels/contact/wrenches.hpp>

namespace plica {

/// Base class of implicit integrators. A step consists of stages, and is accepted whether it is
/// solved or not. unsolved() returns the part of the forces that unsolved steps left unbalanced.
template <class B>
class ImplicitStep : public Integrator<B> {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;

  ImplicitStep(const LevelData<B>& level, const IntegratorParts<B>& parts)
      : stages_(level, parts), stops_(parts.stops) {}

  void advance(Level<B>& level, double time, double h, int steps) override {
    stages_.begin();
    unsolved_ = 0;
    for (int s = 0; s < steps; ++s) {
      const double start = time + s * h;
      level.accept_state(start);
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
  void name_fields(Archive<B>& archive) override {
    archive.number(surprised_), stages_.name_fields(archive);
  }
  void name_memory(Archive<B>& archive) override {
    archive.number(surprised_), stages_.name_memory(archive);
  }

 protected:
  /// Computes a step from `time` over h [s]; returns false where a stage is not solved. The level's
  /// state at the start is consistent with given motions.
  virtual bool step(Level<B>& level, double time, double h) = 0;
  StageSolver<B>& stages() { return stages_; }
  /// Returns how contact's last forces contribute to the impulse of the last step, of h [s].
  virtual CarriedImpulse impulse(double h) const { return {h}; }
  /// Computes the end of the step from the last stage, which is the level's state. By default the
  /// last stage is the end of the step.
  virtual void finish(Level<B>&, double /*h*/) {}

 private:
  static constexpr double notable_motion = 0.1;  ///< notable fraction of the kinetic energy

  StageSolver<B> stages_;
  bool surprised_ = false;  ///< whether the last step ended with contact that was not foreseen
  bool stops_;              ///< whether the run ends where a step is not solved
  double unsolved_ = 0;     ///< largest unbalanced part of the forces in the last advance()

  void accept(Level<B>& level, double time, double h) {
    if (level.contact())
      level.timed("contact", [&] { level.response().end_stage(level.exec(), level, level.state); });
    finish(level, h);
    prescribe(level.exec(), level, level.state, time + h);
    if (!level.contact()) return;
    level.count_contact(time + h, impulse(h));
    if (!judges()) return;
    const double part = unforeseen(level, time + h);
    if (surprised_) unsolved_ = std::max(unsolved_, part);
    surprised_ = part > 0;
  }
  /// Returns the size of unforeseen contact at the end of a step: (found - solved) / (solved + 0.1
  /// kinetic), of energies. `solved` is the energy of the contact that the step solved, and `found`
  /// that of the contact at its end. The result is 0 where it would be 1 or less, or where found is
  /// at most 2 solved; it is at most 1e9. Unforeseen contact throws the body. One such step happens
  /// when bodies come into touch; a second one in a row counts as not solved.
  double unforeseen(Level<B>& level, double time) {
    double solved = 0, found = 0;
    level.timed("contact", [&] {
      solved = level.response().energy_by_depth(level.exec(), level, time);
      found = level.response().energy_found(level.exec(), level, level.state, time);
    });
    if (!(found > 2 * solved)) return 0;
    const double part = (found - solved) / (solved + notable_motion * stages_.kinetic(level));
    return part > 1 ? std::min(part, 1e9) : 0;
  }
};

}  // namespace plica
