// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inverse_mass.hpp>
#include <plica/drivers/cycles/him/coarse_frames.hpp>
#include <vector>

// Symbols of cmake/docs/explanation/him.md: A is apply(), b are weights_. P_i is coarser_[i].up. S
// is filter_.matrix, R is filter_.rotation. F is found by solve_frame_force(); g = frames_.force()
// is F on the coarsest vertices.
namespace plica {

/// Hierarchical inverse mass A of one body: accelerations a = A f by forces on the finest level.
/// A is symmetric and positive definite. It is applied down and up through the levels, by kernels
/// on the device, in the order of an execution space's instance.
template <class B>
class InverseMass {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;
  using Count = Doubles<B>;
  using Answer = decltype(CoarseInverseMass<B>::matrix);

  /// @param inverse_mass  inverse masses of the body's vertices on the finest level [1/kg]
  /// @param frames        frames of the coarsest space, where there are any spaces
  /// @param part          this rank's part of the finest level, of which the vertices are; spaces
  ///                      and frames are of all of it. Null: one process has all of it
  InverseMass(const Scalars<B>& inverse_mass, const std::vector<MassSpace>& spaces,
              const FrameShape& frames, const RankLevel<B>* part = nullptr);

  int levels() const { return static_cast<int>(coarser_.size()) + 1; }
  /// Sets the levels' weights b, finest first; they sum to 1.
  void set_weights(const std::vector<double>& weights) { weights_ = weights; }
  /// Copies the coarse inverse mass S to the device, in float; see CoarseModes.
  static Answer to_device(const Eigen::MatrixXd& S);
  /// Sets the coarse inverse mass S, which to_device() has made.
  void set_answer(const Answer& S) { filter_.matrix = S; }

  /// Turns the coarsest level's frames with the finest mesh's displacements, see CoarseFrames.
  void turn(const Exec& exec, const Vectors<B>& u) const;
  /// Finds the force F of frames over a time t [s], for momenta q + t F; q is without F.
  void solve_frame_force(const Exec& exec, const Vectors<B>& q, double t) const;
  /// Adds the force of frames, p += t F, and sets a = (A p - v) / t.
  /// p must be the momenta q of solve_frame_force(): their restrictions to the levels are used
  /// again.
  void push_and_accelerate(const Exec& exec, double t, const Vectors<B>& p, const Vectors<B>& v,
                           const Vectors<B>& a) const;
  /// Adds the force of frames to two momenta, p += t F and q += t F, and sets a = A p.
  /// p must be the momenta q of solve_frame_force(): their restrictions to the levels are used
  /// again.
  void push_and_answer(const Exec& exec, double t, const Vectors<B>& p, const Vectors<B>& q,
                       const Vectors<B>& a) const;
  /// Sets a = A f; vertices whose motion is given get 0.
  /// With a `count` on the device, only where that is above 0.
  void apply(const Exec& exec, const Vectors<B>& f, const Vectors<B>& a,
             const Doubles<B>& count = {}) const;

  const CoarseInverseMass<B>& filter() const { return filter_; }
  const CoarseFrames<B>& frames() const { return frames_; }
  void name_fields(Archive<B>& archive) const {
    frames_.name_fields(archive);
    if (down_) down_->name_fields(archive);
    archive.owns(coarser_, filter_);
  }

 private:
  int vertices_;
  Scalars<B> inverse_mass_;
  std::vector<MassLevel<B>> coarser_;  ///< whole ones on each of several ranks
  /// coarser_.front().down, where ranks share the finest level
  std::unique_ptr<SharedProduct<B, float>> down_;
  CoarseInverseMass<B> filter_;
  CoarseFrames<B> frames_;
  std::vector<double> weights_;

  /// Returns the number of coarser levels down to the last one whose weight is not 0.
  std::size_t weighed() const;
  /// Restricts f from the finest level to the first coarser one.
  void go_down_first(const Exec& exec, const Vectors<B>& f, const Doubles<B>& count) const;
  /// Restricts f to so many coarser levels, and returns the result on the last of them.
  Vectors<B> go_down(const Exec& exec, const Vectors<B>& f, std::size_t levels,
                     const Doubles<B>& count) const;
  /// Restricts f to the coarsest level, and calls `turn` for each vertex there.
  template <class Turn>
  void restrict_to_frames(const Exec& exec, const Vectors<B>& f, const Doubles<B>& count,
                          const Turn& turn) const;
  /// Interpolates accelerations up to the level below the finest.
  /// Starts at the coarsest level, whose accelerations are there, or at the coarsest that has a
  /// weight.
  void go_up(const Exec& exec, const Doubles<B>& count) const;
  /// Adds the F of solve_frame_force() on the levels, goes up, and calls `last` for each finest
  /// vertex.
  template <class Last>
  void go_up_pushed(const Exec& exec, double t, const Last& last) const;
  AnswerOfCoarsest<B> answer_of_coarsest() const;
  AnswerOfFinest<B> answer_of_finest(const Vectors<B>& f, const Vectors<B>& a) const;
};

}  // namespace plica
