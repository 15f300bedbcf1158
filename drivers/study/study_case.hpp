// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <optional>
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// Settings that replace a problem's own for cycles named with this variant; an empty one keeps the
/// problem's. See IntegrationOptions.
struct StudyVariant {
  std::optional<double> shift_to_coarsest;
  std::optional<std::vector<std::string>> integrator;
  std::optional<std::vector<int>> substeps;
  std::optional<double> safety;
  std::optional<bool> allow_unstable;
  std::optional<double> switch_threshold;
  std::optional<std::string> outside;
};

/// Returns the options with the settings of a variant.
IntegrationOptions with(IntegrationOptions options, const StudyVariant& variant);

/// Returns whether two options give the same run, by cycle, steps and the settings of variants. A
/// switch threshold is compared only where mappings switch.
bool steps_alike(const IntegrationOptions& a, const IntegrationOptions& b);

/// Returns "METHOD/DISTRIBUTION+VARIANT" without its empty parts: "cycle/rsv/critical+hybrid".
std::string study_label(const std::string& method, const std::string& distribution,
                        const std::string& variant);

/// Settings of make_truth().
struct TruthOptions {
  /// number of refinements of level 0's mesh, >= 1; none: 2, or 1 where two do not fit half the
  /// budget
  std::optional<int> refinements;
  /// jitter of the second family's mesh, see jittered(); none: that family has linear elements
  std::optional<double> jitter;
};

/// Methods that a study compares, and its settings.
struct StudyOptions {
  double duration = 1;  ///< simulated time [s] > 0
  /// number of times, evenly over the duration, at which states are compared
  int samples = 50;
  /// names of study_methods(), or of families: single, coarse, cycle. /DISTRIBUTION, then +VARIANT,
  /// may follow a cycle's name. Empty: the default set
  std::vector<std::string> methods;
  std::map<std::string, StudyVariant> variants;  ///< by name; family `cycle` has each of them
  /// [s]; none: auto; empty: multiples of the finest critical step
  std::vector<std::optional<double>> macro_steps;
  std::vector<std::string> precision = {"double"};
  std::vector<int> threads;  ///< empty: all threads
  int timed_runs = 3;        ///< per row, after the warm-up; see timed_runs_of()
  bool growth = false;       ///< true: growth by each cycle too, see GrowthOfCycles
  /// points of the finest level at rest, by name, whose errors are reported [m]
  std::map<std::string, Point> probes;
  /// wall time of the whole study [s]; rows that do not fit are left out, and listed
  std::optional<double> budget;
  std::string reference_integrator = "rk4";  ///< integrator of the reference
  /// own error (displacement) of the reference above which both its steps are halved, once
  double reference_error = 1e-5;
  /// longer step of the reference over the finest level's critical step; the other is half of it
  double reference_step = 1;
  std::optional<TruthOptions> truth;  ///< none: errors are against level 0's mesh
  /// names of element_families(); empty: the problem's own, with truth all
  std::vector<std::string> elements;
  /// finer mesh of the body for a second reference, which gives the finest level's error in space
  std::optional<TetMesh> finer;
};

/// Properties of a level alone that a study needs.
struct StudyLevel {
  int tets = 0;
  double critical_step = 0;  ///< critical step of symplectic Euler [s]
};

/// One run of a study: method and levels, precision and number of threads.
struct StudyCase {
  /// single/INTEGRATOR, coarse/LEVEL, coarse/LEVEL/INTEGRATOR or cycle/NAME
  std::string method;
  std::string distribution;  ///< a cycle's; for cycle/auto its error class
  std::string variant;       ///< a cycle's; empty: the problem's own settings
  std::string element;       ///< empty: the problem's own
  std::string precision;
  int threads = 0;
  int level = 0;  ///< finest level of the run
  IntegrationOptions integration;
  int rank = 0;          ///< order of the runs: low ranks are run first
  bool control = false;  ///< true where others are compared with it: see study_cases()
  /// predicted evaluations of tetrahedra over the duration; 0 where the set-up will refuse
  double predicted_evaluations = 0;
  std::string label() const;  ///< returns for example "cycle/rsv/critical+hybrid"
  std::string key() const;    ///< returns a text that is unique among the study's cases
};

/// Returns every method for this problem. These are single/ each integrator, coarse/ each coarser
/// level by symplectic Euler or by each other integrator, and cycle/ each cycle of several levels.
std::vector<std::string> study_methods(const Problem& problem);

/// Sets up a level alone and returns its properties. Throws InputError where that fails or nothing
/// limits the step.
StudyLevel study_level(const Problem& problem, int level);

/// Sets up each level alone and returns the properties, finest first.
std::vector<StudyLevel> study_levels(const Problem& problem);

/// Returns all runs of a study, in the order of the methods' names. The default runs are:
/// * the finest level alone, explicit at 0.9 and 0.5 of its limit and implicit at 4, 16 and 64
/// times
///   the critical step;
/// * each coarser level alone at 0.9 of its own limit;
/// * every cycle with every distribution at 1, 2, 4, 8 and 16 times the finest level's limit, at
///   `auto`, and at the problem's own macro step;
/// * him at 2 to 32 times the finest level's limit;
/// * auto, within one per cent.
///
/// Cycles keep the problem's integrators, sub-steps and other settings, except those that their
/// variant changes. A variant that changes nothing that the cycle uses is not run again. From the
/// options' macro steps, an explicit level alone takes those below its limit.
///
/// Controls have the first precision and the first number of threads. They are the finest level
/// alone, explicit at 0.9 of its limit and implicit at the first of its steps, and each coarser
/// level alone. Throws InputError for an unknown method; the message has the nearest name.
std::vector<StudyCase> study_cases(const Problem& problem, const StudyOptions& options,
                                   const std::vector<StudyLevel>& levels);

/// Returns the problem to run for a case. A level alone starts at the place that it has under the
/// finest level.
Problem problem_of(const Problem& problem, const StudyCase& one);

/// Throws InputError where a name of options.methods is not in study_methods(), or a variant makes
/// the problem invalid. Needs no critical steps of meshes.
void check_study(const Problem& problem, const StudyOptions& options);

/// Method that the options name, with its distribution and variant.
struct ChosenMethod {
  std::string method;
  std::string distribution;  ///< a cycle's; else empty
  std::string variant;       ///< a cycle's; else empty
};

/// Returns a method by its whole name, for example "cycle/rsv/equal+hybrid".
ChosenMethod chosen_method(const std::string& name);

/// Returns the methods of the options, with families, distributions and variants written out, none
/// twice. Throws InputError for an unknown name.
std::vector<ChosenMethod> chosen_methods(const Problem& problem, const StudyOptions& options);

/// Returns the case of a method, without its macro step, precision and threads.
StudyCase study_case(const Problem& problem, const StudyOptions& options,
                     const ChosenMethod& chosen);

}  // namespace plica
