// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/drivers/elastic/elasticity.hpp>
#include <plica/drivers/level/level.hpp>
#include <string_view>

namespace plica {

/// Products with the system A of an implicit stage of nodal elements, in float.
/// They are for the polynomial on the finest level of a V-cycle. Smoothed pressures, and pressures
/// that follow the body, are left out, as in the vertex blocks.
template <class B>
class CycleProduct {
 public:
  using Exec = typename B::Exec;
  using F = Backend<float, Exec>;

  /// @param level             level whose model has the rows in float
  /// @param inverse_diagonal  inverses of A's vertex blocks; later changes of the array are seen
  CycleProduct(const LevelData<B>& level, std::string_view material,
               const Blocks<B>& inverse_diagonal);

  /// Sets A to the system of a level at `state`, see StageSystem::prepare().
  /// Contact is not copied: each product reads it from the level.
  void prepare(const Level<B>& level, const State<B>& state, const ImplicitWeights& weights,
               bool projected);
  /// Sets q = A p. `To` is Vectors or SlotVectors, whose slots are the vertices.
  template <class To>
  void apply(const Exec& exec, const Vectors<F>& p, const To& q) const;
  const Blocks<B>& inverse_diagonal() const { return inverse_diagonal_; }
  void name_fields(Archive<B>& archive) const {
    archive.owns(level_.model.mass, level_.model.damping, level_.nodal, level_.partial, u_, p_,
                 beside_);
  }

 private:
  LevelData<F> level_;
  std::unique_ptr<Elasticity<F>> elasticity_;
  Blocks<B> inverse_diagonal_;
  Vectors<F> u_;
  Vectors<B> p_, beside_;  ///< vectors of the product with the part of A that is not from elements
  const Level<B>* forces_ = nullptr;
  ImplicitWeights weights_;
  bool positive_ = false;
};

}  // namespace plica
