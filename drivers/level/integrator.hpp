// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <plica/core/state_archive.hpp>
#include <string>

namespace plica {

template <class B>
class SolverLevel;

/// One level's ODE solver.
template <class B>
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Takes the level's state through `steps` steps of h from `time` [s]. Contact is found anew in
  /// every step.
  virtual void advance(SolverLevel<B>& level, double time, double h, int steps) = 0;
  virtual std::map<std::string, long> counters() const { return {}; }
  /// Device memory of its own.
  virtual std::size_t bytes() const { return 0; }
  /// The largest part of its forces that a stage of the last advance() left unbalanced, or the
  /// relative residual of its one linear solve; 0 where there are none.
  virtual double residual() const { return 0; }
  /// Whether it tells what it has not solved.
  virtual bool judges() const { return false; }
  /// The largest part of the forces that a step of the last advance() left unbalanced where it was
  /// not solved; 0: all were.
  virtual double unsolved() const { return 0; }
  /// Why the result of the last advance() is not valid, as a sentence for the user; empty where it
  /// is.
  virtual std::string failure() const { return {}; }
  /// The state was replaced: what it carries from the steps before does not belong to it.
  virtual void forget() {}
  /// Names what it carries from one macro step to the next, for saving and restoring.
  virtual void persist(StateArchive<B>&) {}
};

}  // namespace plica
