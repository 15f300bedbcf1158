// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <plica/core/level.hpp>
#include <plica/drivers/cycles/him/inverse_mass.hpp>
#include <plica/drivers/cycles/him/rows_of_body.hpp>
#include <plica/drivers/elastic/elasticity.hpp>
#include <vector>

namespace plica {

/// How a hierarchical inverse mass was fitted to a step.
struct InertiaFit {
  double step = 0;  ///< t [s]
  /// t^2 lambda_max(A K) at the state it was fitted to; below 4 is stable
  double product = 0;
  /// of it at rest: the sum over the levels of weight times the part's own, never less
  double bound = 0;
  double scale = 0;  ///< gamma: alpha_i = min(1, gamma (critical step of part i / t)^2)
  /// 1 / alpha_i, finest first: how many times too heavy a level's own detail is
  std::vector<double> inertia;
};

/// Fits the weights of one body's inverse mass to a step.
template <class B>
class InertiaFitter {
 public:
  /// @param level       with the vertices of all bodies, as every state u below
  /// @param rows        the body's
  /// @param eigenvalue  of the body's part of the level by itself at rest, see
  /// largest_eigenvalue(); none: found here [1/s^2]
  InertiaFitter(const typename B::Exec& exec, const Level<B>& level, const RowsOfBody& rows,
                std::shared_ptr<const Elasticity<B>> elasticity, std::optional<double> eigenvalue,
                InverseMass<B>& inverse_mass, std::optional<CoarseModes> modes);

  /// Sets weights and answer so that t^2 lambda_max(A K) = 4 sigma^2 at the state u, axes turned as
  /// they are, with gamma at most 1; nothing fits: none, and the weights are of no use.
  std::optional<InertiaFit> fit(double t, double sigma, const Vectors<B>& u);

  /// The fit that had this gamma, at whatever state; its product is not known then.
  InertiaFit use(double t, double sigma, double scale);

  /// Device memory of the coarsest level's answers to the steps so far.
  std::size_t bytes() const;

  /// t^2 lambda_max(A K) at the state u, as the weights are for steps of t [s].
  double product(double t, const Vectors<B>& u) const { return t * t * largest(u, fit_tolerance); }

  /// 2 / sqrt(lambda_max) of each part of the inverse mass alone at rest, finest first, without the
  /// coarsest [s].
  const std::vector<double>& critical_steps() const { return critical_; }

 private:
  typename B::Exec exec_;
  const Level<B>& level_;
  RowsOfBody rows_;
  std::shared_ptr<const Elasticity<B>> elasticity_;
  InverseMass<B>& inverse_mass_;
  std::optional<CoarseModes> modes_;
  std::vector<double> critical_;
  // of steps and sigmas so far
  std::map<std::array<double, 2>, typename InverseMass<B>::Answer> answers_;
  static constexpr double fit_tolerance = 1e-2;

  void set_answer(double t, double sigma);
  InertiaFit weigh(double t, double sigma, double scale);
  std::vector<double> alphas(double t, double scale) const;
  double largest(const Vectors<B>& u, double tolerance) const;
};

}  // namespace plica
