// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/study/errors.hpp>
#include <plica/drivers/study/study_case.hpp>
#include <plica/drivers/study/study_run.hpp>

namespace plica {

/// What errors are measured against: the finest level alone, in double, at a small step that hits every sampling time. Its own
/// error is how far it is from a run at twice that step: more than it really is.
struct StudyReference {
  std::string method;
  double macro_step = 0;                         ///< [s]
  double critical_step = 0;                      ///< of the finest level under symplectic Euler [s]
  double own_error = 0, own_error_velocity = 0;  ///< fractions
  double wall_time = 0;                          ///< of its runs [s]
  double seconds_per_evaluation = 0;             ///< of a tetrahedron
  std::optional<double> space_error;             ///< to the finer mesh's reference, displacement
  Trajectory trajectory;                         ///< empty: there is none yet
  std::optional<Trajectory> finer;               ///< of the finer mesh's reference, at the finest level's vertices
};

/// Runs it, and the one on options.finer where there is one. Empty trajectory where go_on ended it. InputError where it diverges, also at
/// an eighth of the step.
StudyReference make_reference(const Problem& problem, const StudyOptions& options, double critical_step,
                              const std::function<bool(double)>& go_on);

}  // namespace plica
