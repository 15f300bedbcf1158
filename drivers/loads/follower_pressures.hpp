// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/loads/force_term.hpp>
#include <plica/kernels/loads/follower_pressure.hpp>
#include <vector>

namespace plica {

/// Pressures on triangles of the boundary that follow the body: given ones, and those of fluids in
/// cavities. Their stiffness couples the vertices of triangles, and of whole cavities.
template <class B>
class FollowerPressures final : public ForceTerm<B> {
 public:
  using Exec = typename B::Exec;
  explicit FollowerPressures(std::vector<FollowerLoad<B>> loads);

  void add_force(const Exec& exec, const State<B>& at, double time, const Vectors<B>& f) override;
  TermStiffness stiffness() const override { return TermStiffness::unassembled; }
  /// Adds scale K p. `projected`: the stiffness of the fluids alone.
  void add_product(const Exec& exec, const State<B>& at, const Vectors<B>& p, double scale,
                   bool projected, const Vectors<B>& q) const override;
  /// Returns the energy of the loads whose triangles enclose a volume [J].
  double energy(const Exec& exec, const State<B>& at, double time) const override;
  /// Returns what the fluids add. The stiffness of one is K a a^T / V with a = dV/dx; a is as large
  /// as areas: those at rest, grown to `ratio` alike in all directions where that is above 1.
  double squared_frequency(const LevelData<B>& level) const override;
  std::vector<CavityState> cavities(const Exec& exec, const State<B>& at,
                                    double time) const override;
  void name_fields(Archive<B>& archive) const override;

 private:
  std::vector<FollowerLoad<B>> loads_;
  BlockSums<B> volumes_;  ///< partial sums of volumes
  Doubles<B> rate_;       ///< [1] change of the volume of one cavity
  double time_ = 0;       ///< time of the last forces [s]

  GivenPressure<B> given_pressure(const FollowerLoad<B>& load, double time) const;
  /// Returns the pressure at the volume that was measured last.
  FluidPressure<B> last_pressure(const FollowerLoad<B>& load, double time) const;
  /// Measures the volume that the triangles of a load enclose, on the device.
  void measure(const Exec& exec, const FollowerLoad<B>& load, const Vectors<B>& u) const;
  /// Returns that volume, up to a constant [m^3]; waits.
  double enclosed_volume(const Exec& exec, const FollowerLoad<B>& load, const Vectors<B>& u) const;
  /// Returns the given volume of a cavity, without its caps [m^3].
  double volume_given(const FollowerLoad<B>& load, double time) const;
};

}  // namespace plica
