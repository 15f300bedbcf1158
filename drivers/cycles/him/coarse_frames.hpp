// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/archive.hpp>
#include <plica/core/inverse_mass.hpp>
#include <plica/core/model.hpp>
#include <plica/drivers/cycles/him/mass_spaces.hpp>
#include <plica/drivers/level/shared_product.hpp>
#include <plica/kernels/him/coarse_frames.hpp>
#include <plica/kernels/reduce.hpp>

// Symbols of cmake/docs/explanation/him.md: R is rotation(), the frames. F
// is E^T g, on the finest vertices: g is force(), E is FrameShape::restriction. Pi is the product
// of all P.
namespace plica {

/// Matrices that the frames of the coarsest level are found with, see FrameFields.
struct FrameShape {
  /// Entries (column, derivative) of the gradient D, per vertex.
  using Gradients = std::vector<std::vector<std::pair<int, Point>>>;

  /// E: mean by mass over the finest vertices that depend on a coarse vertex; rows sum to 1
  RowMatrix restriction;
  Gradients gradient;           ///< D: gradient of u_C = E u
  std::vector<double> at_rest;  ///< per vertex a factor: D at rest is the factor times the identity
  RowMatrix smoothing;          ///< W: means over neighbourhoods; W D = 1 at rest
};

/// Returns the matrices from the elements of the coarsest mesh, placed like the finest one.
/// D of a vertex is the sum over its elements of volume times deformation gradient.
/// @param mass  mass of each vertex of the finest level [kg]
FrameShape frames_of_mesh(const TetMesh& finest, const TetMesh& coarsest,
                          const std::vector<double>& mass);

/// Returns the matrices of a coarse space without elements.
/// D of a point is the linear map of rest positions that is nearest, by mass, to the motion of the
/// finest mesh around the point.
/// @param to_finest  Pi
/// @param mass       mass of each vertex of the finest level [kg]
FrameShape frames_of_space(const TetMesh& finest, const RowMatrix& to_finest,
                           const std::vector<double>& mass);

/// Frames of the coarsest level, which turn with the body, and the force of frames on the body.
template <class B>
class CoarseFrames {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;
  CoarseFrames() = default;
  /// @param moved  Pi^T E^T: from momenta on u_C to coarse momenta
  /// @param part   this rank's part of the finest level; null: one process has all of it
  CoarseFrames(const FrameShape& shape, const RowMatrix& moved, const RankLevel<B>* part);

  /// Sets R by the displacements u of the finest mesh.
  void turn(const Exec& exec, const Vectors<B>& u) const;

  /// Returns the kernel that must run before find_torques(), for each coarse vertex.
  StartMomentum<B> start(const Vectors<B>& given, const CoarseInverseMass<B>& filter) const {
    return {filter, {given, share_}};
  }
  /// Finds the torques on the frames over a time t [s], for the momenta that result from them.
  /// Repeats until the force's share of the momenta changes by less than a thousandth of itself or
  /// a millionth of the momenta, at most six times. Starts from the share of the last step. Must be
  /// called after the kernel start().
  /// @param given   coarse momenta without the force of frames
  /// @param filter  of the coarsest level; `turned` becomes R^T times the momenta with the force
  /// @param weight  weight b of the coarsest level
  void find_torques(const Exec& exec, const Vectors<B>& given, const CoarseInverseMass<B>& filter,
                    double weight, double t) const;
  /// Returns the kernel that computes g from the torques of find_torques(), group by group.
  ForceOfTorques<B> force_of_torques() const { return {frames_}; }
  /// Returns the kernel that adds the force of frames: p += t F, and q += t F where q is not empty.
  PushByFrames<B> push(double t, const Scalars<B>& inverse_mass, const Vectors<B>& p,
                       const Vectors<B>& q = {}) const {
    return {frames_.spread, inverse_mass, frames_.force, p, q, static_cast<Real>(t)};
  }
  /// Returns g, the force of frames on u_C [N].
  const Vectors<B>& force() const { return frames_.force; }

  const Vectors<B>& rotation() const { return rotation_; }
  int vertices() const { return vertices_; }
  /// Returns per group of vertices the sum of the squared angles of the last turn [rad^2].
  const Doubles<B>& angles() const { return frames_.angles; }
  /// Returns the part of the coarse momenta that the force of frames added in the last step.
  const Vectors<B>& share() const { return share_; }
  /// Returns the sums of the last round: how much the force's share still changed, over itself.
  /// Empty without frames.
  FrameRound<B> last_round() const { return round(most_rounds - 1); }
  void name_fields(Archive<B>& archive) const {
    archive.field("the axes' share of the momenta", share_);
    archive.field("the coarsest axes", rotation_);
    if (restriction_) restriction_->name_fields(archive);
    archive.owns(frames_, sums_);
  }

 private:
  static constexpr int most_rounds = 6;
  using Sums = decltype(FrameRound<B>::sums);

  int vertices_ = 0;
  FrameFields<B> frames_;
  /// E, where ranks share the finest level
  std::unique_ptr<SharedProduct<B, Real>> restriction_;
  Vectors<B> rotation_, share_;
  Sums sums_;  ///< [rounds][groups]

  FrameRound<B> round(int i) const {
    const int groups = groups_of<B>(vertices_);
    return {Sums(sums_.data() + 3 * i * groups, static_cast<std::size_t>(groups))};
  }
};

}  // namespace plica
