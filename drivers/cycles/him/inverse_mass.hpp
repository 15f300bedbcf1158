// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>
#include <plica/core/inverse_mass.hpp>
#include <plica/drivers/cycles/him/turning_axes.hpp>
#include <vector>

namespace plica {

/// a = A f: what a step of the hierarchical inverse mass makes of forces on the finest level. A is
/// symmetric and positive definite; up and down through the levels, on the device, in the order of
/// an instance.
template <class B>
class InverseMass {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;
  using Count = Doubles<B>;
  using Answer = decltype(CoarseFilter<B>::matrix);

  /// @param inverse_mass  of the body's vertices on the finest level [1/kg]
  /// @param axes          of the coarsest space, where there are any
  InverseMass(const Scalars<B>& inverse_mass, const std::vector<MassSpace>& spaces,
              const AxesShape& axes);

  int levels() const { return static_cast<int>(coarser_.size()) + 1; }
  /// The levels' weights b, finest first; they sum to 1.
  void set_weights(const std::vector<double>& weights) { weights_ = weights; }
  /// The coarsest level's answer S, see CoarseModes; as the device has it, it can be set again.
  /// @{
  static Answer to_device(const Eigen::MatrixXd& S);
  void set_answer(const Answer& S) { filter_.matrix = S; }
  /// @}

  /// Turns the coarsest level's axes with the finest mesh's state, see TurningAxes.
  void turn(const Exec& exec, const Vectors<B>& u) const;
  /// Finds the force by which the axes act for a time t on the momenta q, with that force in them.
  void find_push(const Exec& exec, const Vectors<B>& q, double t) const;
  /// p += t times that force, and a = (A p - v) / t, where p are the momenta that it was found for:
  /// what came down to the levels is used again.
  void push_and_accelerate(const Exec& exec, double t, const Vectors<B>& p, const Vectors<B>& v,
                           const Vectors<B>& a) const;
  /// The same with a = A p; and the force is added to q as well.
  void push_and_answer(const Exec& exec, double t, const Vectors<B>& p, const Vectors<B>& q,
                       const Vectors<B>& a) const;
  /// a = A f; vertices whose motion is given get none. With a `count` on the device only where that
  /// is above 0.
  void apply(const Exec& exec, const Vectors<B>& f, const Vectors<B>& a,
             const Doubles<B>& count = {}) const;

  const CoarseFilter<B>& filter() const { return filter_; }
  const TurningAxes<B>& axes() const { return axes_; }
  std::size_t bytes() const;  ///< without the answer

 private:
  int vertices_;
  Scalars<B> inverse_mass_;
  std::vector<MassLevel<B>> coarser_;
  CoarseFilter<B> filter_;
  TurningAxes<B> axes_;
  std::vector<double> weights_;

  /// The levels down to the last one that has a weight.
  std::size_t weighed() const;
  /// What comes down to the last of so many levels.
  Vectors<B> go_down(const Exec& exec, const Vectors<B>& f, std::size_t levels,
                     const Doubles<B>& count) const;
  /// All the way down, and there `turn`.
  template <class Turn>
  void go_down_to_axes(const Exec& exec, const Vectors<B>& f, const Doubles<B>& count,
                       const Turn& turn) const;
  /// From the coarsest level's answer, or the lowest that has a weight, to the level below the
  /// finest.
  void go_up(const Exec& exec, const Doubles<B>& count) const;
  /// After find_push(): with the force, up to the finest level, and there `last`.
  template <class Last>
  void go_up_pushed(const Exec& exec, double t, const Last& last) const;
  AnswerOfCoarsest<B> answer_of_coarsest() const;
  AnswerOfFinest<B> answer_of_finest(const Vectors<B>& f, const Vectors<B>& a) const;
};

}  // namespace plica
