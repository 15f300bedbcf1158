// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <plica/core/archive.hpp>
#include <plica/core/problem.hpp>
#include <plica/drivers/elastic/elasticity.hpp>
#include <plica/kernels/elastic/viscous_history.hpp>

namespace plica {

/// Prony series and kernel constants per region, for the steps of a viscous material.
/// Constants are linear in the energy of shape, so that two sets of them define all others.
struct ShapeConstants {
  std::vector<std::vector<PronyTerm>> prony;
  std::vector<std::vector<double>> half;  ///< constants with half of the energy of shape
  /// constants with all of the energy of shape and none of the volume
  std::vector<std::vector<double>> isochoric;
};

/// Relaxation of one level's stresses, by the rules of kernels/elastic/viscous_history.hpp.
/// The memory has the stresses at one time. Forces at later times are computed from it. Only
/// remember() advances the memory, by the time that has passed; a second call at the same time and
/// state changes nothing. So forces may be evaluated at any number of trial states. Code that
/// accepts a state calls remember().
template <class B>
class Viscosity {
 public:
  using Exec = typename B::Exec;

  /// Makes the relaxation of a level that is built, and level.stress.
  /// `rule` is one of relaxation_rules().
  Viscosity(const ShapeConstants& constants, const std::string& rule, const TetMesh& mesh,
            LevelData<B>& level);

  /// Advances the memory to the displacements u of the body at `time` [s].
  void accept_state(const Exec&, const LevelData<B>&, const Elasticity<B>&, const Vectors<B>& u,
                    double time);
  /// Sets the model's constants and the relaxed stress level.stress.lost for forces at `time` [s].
  void prepare_at(const Exec&, const LevelData<B>&, double time);
  /// Sets the model's constants of the instantaneous response, without relaxation.
  void look_at_once(const Exec& exec) { take_share(exec, 0); }
  /// Sets the time of the memory [s].
  void set_time(double time) { time_ = time, looked_ = none; }

  void name_fields(Archive<B>& archive, const LevelData<B>& level, const std::string& name);

 private:
  using Real = typename B::Real;
  static constexpr double none = -1;

  RelaxationSteps<B> steps_;
  /// Constants of a model, in sets, that are scaled.
  struct Sets {
    Scalars<B> constants;    ///< the model's own
    Indices<B> region;       ///< [sets] region of each set
    Scalars<B> whole, half;  ///< constants with all and with half of the energy of shape
  };
  /// constants of forces; constants of a rank's matrix, which has elements of other ranks, too
  Sets forces_, matrix_;
  Scalars<B> isochoric_;
  double time_ = 0;        ///< time of the memory [s]
  double shared_ = 0;      ///< time since time_ that the model's constants are for [s]
  double stepped_ = none;  ///< time since time_ that steps_ are for [s]
  double looked_ = none;   ///< time since time_ that level.stress.lost is for [s]

  static Sets sets_of(const Scalars<B>& constants, const std::vector<int>& regions,
                      const ShapeConstants& shape);
  void scale(const Exec& exec, const Sets& sets) const;
  void step_over(const Exec& exec, double t);
  void take_share(const Exec& exec, double t);
};

}  // namespace plica
