// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/drivers/elastic/elasticity.hpp>
#include <plica/drivers/level/solver_level.hpp>
#include <string_view>

namespace plica {

/// Products with the system A of an implicit stage of nodal elements, in float, for the finest
/// polynomial of a V-cycle. Without what has no part in the vertex blocks either: smoothed
/// pressures, and pressures that follow the body.
template <class B>
class CycleProduct {
 public:
  using Exec = typename B::Exec;
  using F = Backend<float, Exec>;

  /// @param level            its model has the rows in float
  /// @param inverse_diagonal of A's vertex blocks, as they are at each moment
  CycleProduct(const Level<B>& level, std::string_view material, const Blocks<B>& inverse_diagonal);

  /// Takes over A, as StageSystem::prepare(). It reads contact where that is at each product.
  void prepare(const SolverLevel<B>& level, const State<B>& state, const ImplicitWeights& weights,
               bool positive);
  /// q = A p, to Vectors or SlotVectors, whose slots are the vertices.
  template <class To>
  void apply(const Exec& exec, const Vectors<F>& p, const To& q) const;
  const Blocks<B>& inverse_diagonal() const { return inverse_diagonal_; }
  std::size_t bytes() const;

 private:
  Level<F> level_;
  std::unique_ptr<Elasticity<F>> elasticity_;
  Blocks<B> inverse_diagonal_;
  Vectors<F> u_;
  Vectors<B> p_, beside_;  ///< of what is not from elements
  const SolverLevel<B>* forces_ = nullptr;
  ImplicitWeights weights_;
  bool positive_ = false;
};

}  // namespace plica
