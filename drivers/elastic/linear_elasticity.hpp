// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/elastic/elasticity.hpp>
#include <plica/kernels/elastic/elastic_blocks.hpp>
#include <plica/kernels/elastic/elastic_energy.hpp>
#include <plica/kernels/elastic/elastic_force.hpp>
#include <plica/kernels/elastic/elastic_stress.hpp>
#include <plica/kernels/elastic/elastic_tangent.hpp>
#include <plica/kernels/elastic/kept_elements.hpp>
#include <plica/kernels/elastic/record_stress.hpp>
#include <plica/kernels/materials/positive_tangent.hpp>

namespace plica {

/// Kernels of linear tetrahedra of one material.
/// Each pair of material and element is compiled in a source of its own, which the build writes
/// from elasticity_of.cpp.in. So a change of one material compiles only that material.
template <class B, class Material>
class LinearElasticity final : public Elasticity<B> {
  using Exec = typename B::Exec;

 public:
  void force(const Exec& exec, const LevelData<B>& level, const State<B>& state,
             int evaluation) const override {
    elastic_force<B, Material>(exec, level.model.patches, state, level.flags, evaluation,
                               level.partial);
  }
  void tangent(const Exec& exec, const LevelData<B>& level, const Vectors<B>& u,
               const Vectors<B>& p, double damping_scale, bool projected) const override {
    if (projected && has_kept(level))
      return kept_element_tangent<B, Material>(exec, level, u, p, damping_scale);
    elastic_tangent<B, Material>(exec, level.model.patches, u, p, damping_scale, level.partial);
  }
  void diagonal(const Exec& exec, const LevelData<B>& level, const Vectors<B>& u, int direction,
                double damping_scale, bool projected) const override {
    if (projected && has_kept(level))
      return kept_element_diagonal<B, Material>(exec, level, u, direction, damping_scale);
    elastic_diagonal<B, Material>(exec, level.model.patches, u, direction, damping_scale,
                                  level.partial);
  }
  void keep_tangents(const Exec& exec, const LevelData<B>& level,
                     const Vectors<B>& u) const override {
    keep_element_tangents<B, Material>(exec, level, u);
  }
  void blocks(const Exec& exec, const Model<B>& model, const PatchPairs<B>& pairs,
              const Vectors<B>& u, const ImplicitWeights& weights, bool projected,
              const Blocks9<B>& shares, const BlockMatrix<B>& A) const override {
    if (projected)
      elastic_blocks<B, Material, PositiveTangent<Material>::template Of>(exec, model, pairs, u,
                                                                          weights, shares, A);
    else
      elastic_blocks<B, Material, Material::template Tangent>(exec, model, pairs, u, weights,
                                                              shares, A);
  }
  void energy(const Exec& exec, const LevelData<B>& level, const Vectors<B>& u) const override {
    elastic_energy<B, Material>(exec, level.model.patches, u, level.partial);
  }
  void stress(const Exec& exec, const LevelData<B>& level, const Vectors<B>& u,
              const StressFields<B>& fields) const override {
    elastic_stress<B, Material>(exec, level.model.patches, u, fields, level.stress.relaxed);
  }
  void accept_state(const Exec& exec, const LevelData<B>& level, const Vectors<B>& u,
                    const Scalars<B>& constants) const override {
    if constexpr (requires { Material::splits_shape; })
      remember_elements<B, Material>(exec, level, u, constants);
  }

 private:
  static bool has_kept(const LevelData<B>& level) { return level.nodal.tangent.extent(0) > 0; }
};

template <class B, class Material>
std::unique_ptr<Elasticity<B>> make_linear_elasticity() {
  return std::make_unique<LinearElasticity<B, Material>>();
}

}  // namespace plica
