// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/elastic/elasticity.hpp>
#include <plica/kernels/elastic/kept_tangents.hpp>
#include <plica/kernels/elastic/mixed_dilatations.hpp>
#include <plica/kernels/elastic/record_stress.hpp>

namespace plica {

/// Kernels of nodal elements of one material.
/// A matrix of nodal elements would have four times the blocks of that of linear elements. So
/// blocks() assembles linear elements, for preconditioners.
template <class B, class Material>
class NodalElasticity final : public Elasticity<B> {
  using Exec = typename B::Exec;

 public:
  void force(const Exec& exec, const LevelData<B>& level, const State<B>& state,
             int evaluation) const override {
    nodal_force<B, Material>(exec, level, state, evaluation);
  }
  void tangent(const Exec& exec, const LevelData<B>& level, const Vectors<B>& u,
               const Vectors<B>& p, double damping_scale, bool projected) const override {
    if (projected && has_kept(level, u))
      kept_tangent<B>(exec, level, p);
    else if (projected)
      nodal_tangent<B, Material, PositiveTangent<Material>::template Of>(exec, level, u, p,
                                                                         damping_scale);
    else
      nodal_tangent<B, Material, Material::template Tangent>(exec, level, u, p, damping_scale);
  }
  void diagonal(const Exec& exec, const LevelData<B>& level, const Vectors<B>& u, int direction,
                double damping_scale, bool projected) const override {
    if (projected && has_kept(level, u))
      kept_diagonal<B>(exec, level, direction);
    else if (projected)
      nodal_diagonal<B, Material, PositiveTangent<Material>::template Of>(exec, level, u,
                                                                          damping_scale, direction);
    else
      nodal_diagonal<B, Material, Material::template Tangent>(exec, level, u, damping_scale,
                                                              direction);
  }
  void keep_tangents(const Exec& exec, const LevelData<B>& level,
                     const Vectors<B>&) const override {
    keep_nodal_tangents<B, Material>(exec, level);
  }
  void blocks(const Exec& exec, const Model<B>& model, const PatchPairs<B>& pairs,
              const Vectors<B>& u, const ImplicitWeights& weights, bool projected,
              const Blocks9<B>& shares, const BlockMatrix<B>& A) const override {
    linear_->blocks(exec, model, pairs, u, weights, projected, shares, A);
  }
  void energy(const Exec& exec, const LevelData<B>& level, const Vectors<B>& u) const override {
    nodal_energy<B, Material>(exec, level, u);
  }
  void stress(const Exec& exec, const LevelData<B>& level, const Vectors<B>& u,
              const StressFields<B>& fields) const override {
    nodal_stress<B, Material>(exec, level, u, fields);
  }
  void carry_dilatations([[maybe_unused]] const Exec& exec,
                         [[maybe_unused]] const LevelData<B>& level,
                         [[maybe_unused]] const Vectors<B>& u,
                         [[maybe_unused]] const Vectors<B>& du) const override {
    if constexpr (smooths_dilatation<Material>)
      plica::carry_dilatations<B, Material>(exec, level, u, du);
  }
  void accept_state(const Exec& exec, const LevelData<B>& level, const Vectors<B>& u,
                    const Scalars<B>& constants) const override {
    if constexpr (requires { Material::splits_shape; })
      remember_domains<B, Material>(exec, level, u, constants);
  }

 private:
  static bool has_kept(const LevelData<B>& level, const Vectors<B>& u) {
    return u.extent(0) == 0 && level.nodal.tangent.extent(0) > 0;
  }
  std::unique_ptr<Elasticity<B>> linear_ = linear_elasticity<B, Material>();
};

template <class B, class Material>
std::unique_ptr<Elasticity<B>> make_nodal_elasticity() {
  return std::make_unique<NodalElasticity<B, Material>>();
}

}  // namespace plica
