// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <optional>
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// Settings put over a problem's own for cycles that are named with it; what is empty stays. See
/// IntegrationOptions.
struct StudyVariant {
  std::optional<double> shift_to_coarsest;
  std::optional<std::vector<std::string>> integrator;
  std::optional<std::vector<int>> substeps;
  std::optional<double> safety;
  std::optional<bool> allow_unstable;
  std::optional<double> switch_threshold;
  std::optional<std::string> outside;
};

IntegrationOptions with(IntegrationOptions options, const StudyVariant& variant);

/// The same run, as far as variants, cycles and steps can tell: a threshold differs only where
/// mappings switch.
bool steps_alike(const IntegrationOptions& a, const IntegrationOptions& b);

/// "cycle/rsv/critical+hybrid", without what is empty.
std::string study_label(const std::string& method, const std::string& distribution,
                        const std::string& variant);

/// How the truth is found: see make_truth().
struct TruthOptions {
  std::optional<int> refinements;  ///< of level 0's mesh, 1 or more; none: 2, or 1 where half the
                                   ///< budget is too little for it
  /// of the second family's mesh, see jittered(); none: it has linear elements
  std::optional<double> jitter;
};

/// What a study compares.
struct StudyOptions {
  double duration = 1;  ///< simulated time [s] > 0
  /// times, evenly over the duration, at which states are compared
  int samples = 50;
  /// of study_methods(), or a family: single, coarse, cycle; a cycle's name may be followed by
  /// /DISTRIBUTION, then by +VARIANT; empty: the default set
  std::vector<std::string> methods;
  std::map<std::string, StudyVariant> variants;  ///< by name; the family `cycle` has each of them
  /// [s]; none: auto; empty: multiples of the finest critical step
  std::vector<std::optional<double>> macro_steps;
  std::vector<std::string> precision = {"double"};
  std::vector<int> threads;  ///< empty: all there are
  int timed_runs = 3;        ///< per row, after the warm-up; see timed_runs_of()
  bool growth = false;       ///< of small motions by each cycle too: see GrowthOfCycles
  /// points of the finest level at rest [m] with errors of their own
  std::map<std::string, Point> probes;
  /// wall time of all of it [s]; rows that do not fit are left out, and listed
  std::optional<double> budget;
  std::string reference_integrator = "rk4";  ///< of the finest level alone
  /// its own error, displacement, above which both steps are halved, once
  double reference_error = 1e-5;
  /// its coarser step over the finest level's critical step; the other is half
  double reference_step = 1;
  std::optional<TruthOptions> truth;  ///< errors against it instead of against level 0's mesh
  /// of element_families(); empty: the problem's own, with truth all of them
  std::vector<std::string> elements;
  std::optional<TetMesh> finer;  ///< a finer mesh of the body, for a second reference: the finest
                                 ///< level's error in space
};

/// A level alone, as the study needs to know it.
struct StudyLevel {
  int tets = 0;
  double critical_step = 0;  ///< of symplectic Euler [s]
};

/// One run of a study: how which levels are integrated, in which precision, by how many threads.
struct StudyCase {
  /// single/INTEGRATOR, coarse/LEVEL, coarse/LEVEL/INTEGRATOR or cycle/NAME
  std::string method;
  std::string distribution;  ///< of a cycle; of cycle/auto its error class
  std::string variant;       ///< of a cycle; empty: as the problem says
  std::string element;       ///< empty: the problem's own
  std::string precision;
  int threads = 0;
  int level = 0;  ///< that is the run's finest
  IntegrationOptions integration;
  int rank = 0;          ///< the lower, the more there is to learn from it
  bool control = false;  ///< what all else is compared with: see study_cases()
  /// of tetrahedra, over the duration; 0 where its set-up will refuse
  double predicted_evaluations = 0;
  std::string label() const;  ///< "cycle/rsv/critical", "cycle/rsv/critical+hybrid"
  std::string key() const;    ///< what tells it from the study's other cases
};

/// Every method there is for this problem: single/ each integrator, coarse/ each coarser level by
/// symplectic Euler or by each other integrator, cycle/ each cycle of several levels.
std::vector<std::string> study_methods(const Problem& problem);

/// Sets a level up alone. InputError where that fails or nothing limits the step.
StudyLevel study_level(const Problem& problem, int level);

/// Likewise each of them.
std::vector<StudyLevel> study_levels(const Problem& problem);

/// All runs, in the order of their names. The default: the finest level alone, explicit at 0.9 and
/// 0.5 of its limit and implicit at 4, 16 and 64 times it; each coarser level alone at 0.9 of its
/// own; every cycle with every distribution at 1, 2, 4, 8 and 16 times the finest level's limit, at
/// `auto`, and at the problem's own macro step; him at 2 to 32 times; auto, within one per cent.
/// Cycles keep the problem's integrators, sub-steps and all else but for what their variant
/// changes; one that changes nothing that the cycle uses is not run again. Of the options' macro
/// steps an explicit level alone takes those below its limit. Controls, of the first precision and
/// number of threads, are the finest level alone, explicit at 0.9 of its limit and implicit at the
/// first of its steps, and each coarser level alone. InputError for an unknown method, with the
/// nearest.
std::vector<StudyCase> study_cases(const Problem& problem, const StudyOptions& options,
                                   const std::vector<StudyLevel>& levels);

/// The problem that is to be run for it. A level alone starts where it would be under the finest
/// one.
Problem problem_of(const Problem& problem, const StudyCase& one);

/// InputError where a name of options.methods is not in study_methods(), or a variant is no set-up:
/// needs no meshes' critical steps.
void check_study(const Problem& problem, const StudyOptions& options);

struct ChosenMethod {
  std::string method;
  std::string distribution;  ///< of a cycle
  std::string variant;       ///< of a cycle
};

/// The methods of the options, families, distributions and variants spelt out, none twice.
/// InputError for an unknown name.
std::vector<ChosenMethod> chosen_methods(const Problem& problem, const StudyOptions& options);

/// How that method is run: all of a case but its macro step, precision and threads.
StudyCase study_case(const Problem& problem, const StudyOptions& options,
                     const ChosenMethod& chosen);

}  // namespace plica
