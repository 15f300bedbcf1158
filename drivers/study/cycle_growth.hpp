// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <plica/drivers/run/build_hierarchy.hpp>
#include <plica/drivers/study/study_case.hpp>
#include <utility>
#include <vector>

namespace plica {

/// One macro step of a problem's cycle as a linear map. It maps x = (u, t v) [m] of level 0's free
/// vertices. The map is linearised about rest without contact, loads and gravity. It has the
/// problem's shares, sub-steps and macro step t, also where t is above a stability limit.
///
/// In the map every material is `linear`, mappings never switch, and implicit levels solve to
/// 1e-12. State on the other levels follows from level 0's state. A variation that is restricted in
/// every cycle sums up to the restricted state, so that `rv`, `rsv` and `rsv_sv` are one map.
template <class B>
class CycleMap {
 public:
  using Exec = typename B::Exec;
  explicit CycleMap(const Problem& problem, const Exec& exec = {});

  double macro_step() const { return built_.macro_step; }  ///< t [s]
  Eigen::Index size() const { return static_cast<Eigen::Index>(6 * free_.size()); }

  /// Returns x after this number of macro steps.
  Eigen::VectorXd apply(const Eigen::VectorXd& x, int macro_steps = 1) const;

  /// Returns the map as a dense matrix, a column per unit vector: for small bodies.
  Eigen::MatrixXd matrix() const;

 private:
  BuiltHierarchy<B> built_;
  std::vector<std::size_t> free_;
};

/// Growth of the amplitude of small motions by a cycle.
struct CycleGrowth {
  double macro_step = 0;  ///< [s]
  /// spectral radius of the map: the factor per macro step in the long run
  double radius = 0;
  double per_second = 0;   ///< log(radius) over the macro step [1/s]; > 0: grows
  double uncertainty = 0;  ///< uncertainty of the radius
  /// true where the radius is an eigenvalue's modulus. Else it is the mean growth factor of many
  /// steps, for example where no eigenvalue dominates
  bool converged = false;
  long macro_steps = 0;  ///< macro steps taken to find the radius
};

/// Effort and accuracy of cycle_growth().
struct CycleGrowthOptions {
  long macro_steps = 20000;  ///< maximum number of macro steps, about
  double tolerance = 1e-8;   ///< largest residual |A x - lambda x| / |lambda x| of the eigenpair
  int dimension = 40;        ///< dimension of the Krylov space
};

/// Finds the spectral radius of a cycle's map. A random state is run, so that the fastest growing
/// part remains. The largest eigenvalue, which may be a complex pair, is then sought in a Krylov
/// space from that state (Arnoldi 1951; Golub & Van Loan, 10.5). Runs get longer until it is found.
template <class B>
CycleGrowth cycle_growth(const CycleMap<B>& map, const CycleGrowthOptions& options = {});

/// Growth of small motions about rest by a study's cycles, in double. Runs that differ only in
/// precision, threads or mappings with the same linear part share one map. It is examined once, for
/// some hundred macro steps.
class GrowthOfCycles {
 public:
  explicit GrowthOfCycles(const Problem& problem) : problem_(problem) {}

  /// Returns the growth of a case at this macro step [s]; none where its set-up is refused.
  /// @param told_from  a radius from which the result must be distinguished. Where it is close to 1
  ///                   and the body is small, all eigenvalues are computed. Else runs get up to 16
  ///                   times longer while the uncertainty is too large.
  std::optional<CycleGrowth> of(const StudyCase& one, double macro_step,
                                std::optional<double> told_from = {});

  /// Returns how many evaluations of tetrahedra of() will take at most; 0 where the map is known.
  /// @param duration  simulated time of the study's runs [s]
  double predicted_evaluations(const StudyCase& one, double macro_step, double duration) const;

 private:
  using Found = std::pair<IntegrationOptions, std::optional<CycleGrowth>>;
  const Found* known(const IntegrationOptions& map) const;

  const Problem& problem_;
  std::vector<Found> found_;
};

}  // namespace plica
