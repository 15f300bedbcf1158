// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <plica/drivers/run/build_hierarchy.hpp>
#include <plica/drivers/study/study_case.hpp>
#include <utility>
#include <vector>

namespace plica {

/// One macro step of a problem's cycle as a linear map of level 0's free vertices: x = (u, t v)
/// [m], linearised about rest without contact, loads and gravity, with the problem's shares,
/// sub-steps and macro step t, also above a limit.
///
/// Every material is `linear` there, mappings never switch, and implicit levels solve to 1e-12.
/// What cycles carry besides level 0's state follows from it: a variation restricted in every cycle
/// sums up to the state restricted, so that `rv`, `rsv` and `rsv_sv` are one map.
template <class B>
class CycleMap {
 public:
  using Exec = typename B::Exec;
  explicit CycleMap(const Problem& problem, const Exec& exec = {});

  double macro_step() const { return built_.macro_step; }  ///< t [s]
  Eigen::Index size() const { return static_cast<Eigen::Index>(6 * free_.size()); }

  /// x after so many macro steps.
  Eigen::VectorXd apply(const Eigen::VectorXd& x, int macro_steps = 1) const;

  /// All of it, a column per unit vector: for small bodies.
  Eigen::MatrixXd matrix() const;

 private:
  BuiltHierarchy<B> built_;
  std::vector<std::size_t> free_;
};

/// How the amplitude of small motions grows by a cycle.
struct CycleGrowth {
  double macro_step = 0;  ///< [s]
  /// spectral radius of the map: the factor per macro step in the long run
  double radius = 0;
  double per_second = 0;   ///< log(radius) per simulated time [1/s]; > 0: grows
  double uncertainty = 0;  ///< of the radius
  /// to an eigenvalue; else it is the mean factor of many steps, as where none dominates
  bool converged = false;
  long macro_steps = 0;  ///< taken to find it
};

struct CycleGrowthOptions {
  long macro_steps = 20000;  ///< at most about so many
  double tolerance = 1e-8;   ///< of the eigenpair: |A x - lambda x| / |lambda x|
  int dimension = 40;        ///< of the Krylov space
};

/// Lets a random state run, so that what grows most remains, then looks for the largest eigenvalue,
/// which may be a complex pair, in a Krylov space from there (Arnoldi 1951; Golub & Van
/// Loan, 10.5). Longer runs until it is found.
template <class B>
CycleGrowth cycle_growth(const CycleMap<B>& map, const CycleGrowthOptions& options = {});

/// How small motions about rest grow by a study's cycles, in double. A map that several runs share,
/// whatever their precision, threads or mappings of the same linear part, is examined once, for
/// some hundred macro steps.
class GrowthOfCycles {
 public:
  explicit GrowthOfCycles(const Problem& problem) : problem_(problem) {}

  /// Of that case at this macro step [s]; none where its set-up is refused.
  /// @param told_from  a radius that it is to be told from: close to 1, of a small body, by all
  /// eigenvalues; else, where its uncertainty is
  ///                   too large for that, by longer runs, up to 16 times
  std::optional<CycleGrowth> of(const StudyCase& one, double macro_step,
                                std::optional<double> told_from = {});

  /// Evaluations of tetrahedra that of() is to take, at most, in a study so long [s]; 0 where the
  /// map is known.
  double predicted_evaluations(const StudyCase& one, double macro_step, double duration) const;

 private:
  using Found = std::pair<IntegrationOptions, std::optional<CycleGrowth>>;
  const Found* known(const IntegrationOptions& map) const;

  const Problem& problem_;
  std::vector<Found> found_;
};

}  // namespace plica
