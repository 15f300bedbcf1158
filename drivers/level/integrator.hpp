// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <plica/core/archive.hpp>
#include <string>

namespace plica {

template <class B>
class Level;

/// Integrator in time of one level: its ODE solver.
template <class B>
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// Takes the level's state through `steps` steps of h from `time` [s]. Contact is found again in
  /// every step.
  virtual void advance(Level<B>& level, double time, double h, int steps) = 0;
  virtual std::map<std::string, long> counters() const { return {}; }
  /// Returns the largest part of its forces that a stage of the last advance() left unbalanced. For
  /// a stage of one linear solve it is the relative residual of that; 0 where there are none.
  virtual double residual() const { return 0; }
  /// Returns whether unsolved() tells which steps were not solved.
  virtual bool judges() const { return false; }
  /// Returns the largest part of the forces that an unsolved step of the last advance() left
  /// unbalanced; 0: all steps were solved.
  virtual double unsolved() const { return 0; }
  /// Returns why the result of the last advance() is not valid, as a sentence for the user; empty
  /// where it is valid.
  virtual std::string failure() const { return {}; }
  /// Returns the vertex at which the last advance() failed most; -1: none is known.
  virtual int failed_vertex() const { return -1; }
  /// Forgets what is carried from earlier steps, which does not belong to a state that was
  /// replaced.
  virtual void reset_history() {}
  /// Names the integrator's arrays and what it carries from one macro step to the next.
  virtual void name_fields(Archive<B>&) {}
  /// Names the part of that which reset_history() keeps. It goes back with a state that the
  /// integrator has been in: steps that are taken again begin as they did the first time.
  virtual void name_memory(Archive<B>&) {}
};

}  // namespace plica
