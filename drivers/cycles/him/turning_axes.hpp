// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inverse_mass.hpp>
#include <plica/core/model.hpp>
#include <plica/drivers/cycles/him/mass_spaces.hpp>
#include <plica/kernels/him/coarse_axes.hpp>
#include <plica/kernels/reduce.hpp>

namespace plica {

/// What the axes of the coarsest level are found from, see CoarseAxes.
struct AxesShape {
  /// Per vertex the entries (column, derivative) of its gradient D.
  using Gradients = std::vector<std::vector<std::pair<int, Point>>>;

  /// E: means by mass over what hangs on a coarse vertex; rows sum to 1
  RowMatrix restriction;
  Gradients gradient;           ///< D of u_C
  std::vector<double> at_rest;  ///< D there is this times 1
  RowMatrix smoothing;          ///< W: means over neighbourhoods; W D = 1 at rest
};

/// By the elements of a coarser mesh, placed like the finest: D is the sum of volume times
/// deformation gradient.
/// @param mass  of the finest level's vertices [kg]
AxesShape axes_of_mesh(const TetMesh& finest, const TetMesh& coarsest,
                       const std::vector<double>& mass);

/// Of a coarse space without elements, by the motion that it gives the finest mesh: D is the linear
/// map of rest positions that is nearest to it, by mass, around a point.
/// @param to_finest  Pi
AxesShape axes_of_space(const TetMesh& finest, const RowMatrix& to_finest,
                        const std::vector<double>& mass);

/// The axes of the coarsest level, which turn with the body, and the force by which they act back
/// on it.
template <class B>
class TurningAxes {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;
  TurningAxes() = default;
  /// @param moved  Pi^T E^T: coarse momentum per momentum on u_C
  TurningAxes(const AxesShape& shape, const RowMatrix& moved);

  /// R at a state.
  void turn(const Exec& exec, const Vectors<B>& u) const;

  /// What comes before find_torques(), vertex by vertex.
  StartMomentum<B> start(const Vectors<B>& given, const CoarseFilter<B>& filter) const {
    return {filter, {given, share_}};
  }
  /// Finds the torques by which the axes act on momenta for a time t, at the momenta that this
  /// gives: repeated until it changes by less than a thousandth of itself or a millionth of the
  /// momenta, six times at most, warm from the last step. After start().
  /// @param given   coarse momenta without it
  /// @param filter  of the coarsest level; takes the momenta with it, turned
  /// @param weight  of the coarsest level in the inverse mass
  void find_torques(const Exec& exec, const Vectors<B>& given, const CoarseFilter<B>& filter,
                    double weight, double t) const;
  /// g of those torques, group by group.
  ForceOfTorques<B> force_of_torques() const { return {axes_}; }
  /// p += t times that force, and q, where it is not empty
  PushByAxes<B> push(double t, const Scalars<B>& inverse_mass, const Vectors<B>& p,
                     const Vectors<B>& q = {}) const {
    return {axes_.spread, inverse_mass, axes_.force, p, q, static_cast<Real>(t)};
  }
  /// g
  const Vectors<B>& force() const { return axes_.force; }

  const Vectors<B>& rotation() const { return rotation_; }
  int vertices() const { return vertices_; }
  /// The squares of the angles of the last turn; their sum is that of all vertices [rad^2].
  const Doubles<B>& angles() const { return axes_.angles; }
  /// What the force added to the coarse momenta in the last step.
  const Vectors<B>& share() const { return share_; }
  /// By how much of itself that force still changed; without axes empty.
  RoundOfAxes<B> last_round() const { return round(most_rounds - 1); }
  std::size_t bytes() const;

 private:
  static constexpr int most_rounds = 6;
  using Sums = decltype(RoundOfAxes<B>::sums);

  int vertices_ = 0;
  CoarseAxes<B> axes_;
  Vectors<B> rotation_, share_;
  Sums sums_;  ///< [rounds][groups]

  RoundOfAxes<B> round(int i) const {
    const int groups = groups_of<B>(vertices_);
    return {Sums(sums_.data() + 3 * i * groups, static_cast<std::size_t>(groups))};
  }
};

}  // namespace plica
