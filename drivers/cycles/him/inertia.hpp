// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <plica/core/level_data.hpp>
#include <plica/drivers/cycles/him/inverse_mass.hpp>
#include <plica/drivers/cycles/him/rows_of_body.hpp>
#include <plica/drivers/elastic/elasticity.hpp>
#include <vector>

// Symbols of cmake/docs/explanation/him.md: gamma is InertiaFit::scale, alpha_i is 1 /
// InertiaFit::inertia[i], t_i is InertiaFitter::critical_steps()[i], S is InverseMass::Answer. A is
// inverse_mass_, b its weights.
namespace plica {

/// Result of fitting a hierarchical inverse mass to a step.
struct InertiaFit {
  double step = 0;  ///< t [s]
  /// t^2 lambda_max(A K) at the state of the fit; below 4 is stable; 0: not known
  double product = 0;
  /// upper bound of the product at rest: sum over the levels of b_i t^2 lambda_max of part i alone
  double bound = 0;
  double scale = 0;  ///< gamma: alpha_i = min(1, gamma (critical step of part i / t)^2)
  /// 1 / alpha_i, finest first: factor by which a level's own detail is too heavy
  std::vector<double> inertia;
};

/// Fits the weights of one body's inverse mass to a step.
template <class B>
class InertiaFitter {
 public:
  /// @param level       finest level, with the vertices of all bodies, as every state u below
  /// @param rows        rows of the body's vertices
  /// @param eigenvalue  largest_eigenvalue() of the body's part of the level at rest [1/s^2]; none:
  ///                    computed here
  InertiaFitter(const typename B::Exec& exec, const LevelData<B>& level, const RowsOfBody& rows,
                std::shared_ptr<const Elasticity<B>> elasticity, std::optional<double> eigenvalue,
                InverseMass<B>& inverse_mass, std::optional<CoarseModes> modes);

  /// Sets b and S so that t^2 lambda_max(A K) is at most 4 sigma^2 at the state u.
  /// gamma is the largest that fits, at most 1. Frames stay as they were last turned. Returns none
  /// where nothing fits; the weights are then of no use.
  std::optional<InertiaFit> fit(double t, double sigma, const Vectors<B>& u);

  /// Sets b and S of an earlier fit with this gamma, at any state.
  /// The product of the returned fit is not known.
  InertiaFit use(double t, double sigma, double scale);

  void name_fields(Archive<B>& archive) const {
    for (const auto& [step, answer] : answers_) archive.owns(answer);
  }

  /// Returns t^2 lambda_max(A K) at the state u, with the present weights, for steps of t [s].
  double product(double t, const Vectors<B>& u) const { return t * t * largest(u, fit_tolerance); }

  /// Returns t_i = 2 / sqrt(lambda_max) of each part of A alone at rest [s].
  /// Finest first, without the coarsest part.
  const std::vector<double>& critical_steps() const { return critical_; }

 private:
  typename B::Exec exec_;
  const LevelData<B>& level_;
  RowsOfBody rows_;
  std::shared_ptr<const Elasticity<B>> elasticity_;
  InverseMass<B>& inverse_mass_;
  std::optional<CoarseModes> modes_;
  std::vector<double> critical_;
  // S of each {step, sigma} so far
  std::map<std::array<double, 2>, typename InverseMass<B>::Answer> answers_;
  static constexpr double fit_tolerance = 1e-2;

  void set_answer(double t, double sigma);
  InertiaFit weigh(double t, double sigma, double scale);
  std::vector<double> alphas(double t, double scale) const;
  double largest(const Vectors<B>& u, double tolerance) const;
};

}  // namespace plica
