// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <plica/drivers/level/level.hpp>
#include <plica/kernels/halo.hpp>
#include <plica/kernels/time/energies.hpp>
#include <plica/kernels/time/stage_kernels.hpp>
#include <vector>

namespace plica {

/// Sums over a level that Newton's method judges a stage by, over all ranks that share it. Each
/// waits for the device.
template <class B>
class StageSums {
 public:
  StageSums() = default;
  explicit StageSums(const LevelData<B>& level) {
    nodal_ = level.model.rows.slices > 0;
    const int elements = nodal_ ? level.model.vertices : level.model.tets;
    von_mises_ = Scalars<B>("plica::stage.von_mises", elements),
    volume_ = Scalars<B>("plica::stage.volume", elements);
    blocks_ = BlockSums<B>(std::max(level.model.vertices, elements), ranks_of<B>(level));
    result_ = Doubles<B>("plica::stage.result", 7);
  }
  /// Returns whether there are arrays for the sums.
  bool any() const { return result_.extent(0) > 0; }
  void name_fields(Archive<B>& archive) const {
    archive.owns(von_mises_, volume_, blocks_.view(), result_);
  }

  /// Returns the sums of StagePotential.
  std::array<double, 7> of(const Level<B>& level, const StagePotential<B>& term) const {
    reduce<B, 7>(level.exec(), "plica::stage_potential", vertices_of<B>(level), term, blocks_,
                 result_);
    const std::vector<double> sums = host_values(level.exec(), result_);
    return {sums[0], sums[1], sums[2], sums[3], sums[4], sums[5], sums[6]};
  }
  /// Returns the kinetic energy of the level's state [J].
  double kinetic(const Level<B>& level) const {
    reduce<B, 1>(level.exec(), "plica::kinetic_energy", vertices_of<B>(level),
                 KineticEnergy<B>{level.model.mass, level.state.v}, blocks_, result_);
    return first(level);
  }
  /// Returns the energy of elements at the level's state [J].
  double stored(const Level<B>& level) const {
    level.incremental_energy(level.state);
    reduce<B, 1>(level.exec(), "plica::elastic_energy", vertices_of<B>(level),
                 EnergyOfShares<B>{level.model.shares, level.partial}, blocks_, result_);
    return first(level);
  }
  /// Returns the least volume ratio of an element, 1 at most.
  double least_volume(const Level<B>& level) const {
    level.elasticity().stress(level.exec(), level, level.state.u,
                              {.von_mises = von_mises_, .J = volume_, .own_volumes = true});
    const Items elements =
        nodal_ ? vertices_of<B>(level) : Items(static_cast<int>(volume_.extent(0)));
    reduce<B, 1, LackOfVolume<B>, Sums<1, 1>>(level.exec(), "plica::least_volume", elements,
                                              {volume_}, blocks_, result_);
    return 1 - first(level);
  }
  /// Returns the largest way of a vertex from displacements `from` to the level's state [m].
  double farthest(const Level<B>& level, const Vectors<B>& from) const {
    reduce<B, 1, SquaredWay<B>, Sums<1, 1>>(level.exec(), "plica::stage_way", vertices_of<B>(level),
                                            {from, level.state.u}, blocks_, result_);
    return std::sqrt(first(level));
  }
  /// Returns the sum of the vertices' products x . y.
  double product(const Level<B>& level, const Vectors<B>& x, const Vectors<B>& y) const {
    reduce<B, 1>(level.exec(), "plica::stage_product", vertices_of<B>(level), Dot<B>{x, y}, blocks_,
                 result_);
    return first(level);
  }
  /// Returns the norm of gravity and all loads at the level's state [N]. `loads`: those of them
  /// that do not depend on the state; the others are added to it.
  double load_norm(const Level<B>& level, double time, const Vectors<B>& loads) const {
    for (const auto& term : level.terms)
      if (term->stiffness() != TermStiffness::none)
        term->add_force(level.exec(), level.state, time, loads);
    reduce<B, 1>(level.exec(), "plica::load_norm", vertices_of<B>(level), Dot<B>{loads, loads},
                 blocks_, result_);
    return std::sqrt(first(level));
  }
  /// Returns the norm of the forces in level.f on vertices whose motion is given [N].
  double reaction_norm(const Level<B>& level) const {
    reduce<B, 1>(level.exec(), "plica::reactions", vertices_of<B>(level),
                 SquaredReaction<B>{level.model, level.f}, blocks_, result_);
    return std::sqrt(first(level));
  }

 private:
  bool nodal_ = false;
  Scalars<B> von_mises_, volume_;  ///< stress and volume ratio of elements
  BlockSums<B> blocks_;
  Doubles<B> result_;

  double first(const Level<B>& level) const { return host_values(level.exec(), result_)[0]; }
};

}  // namespace plica
