// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <plica/core/problem.hpp>
#include <plica/core/state_archive.hpp>
#include <plica/drivers/elastic/elasticity.hpp>
#include <plica/kernels/elastic/stress_memory.hpp>

namespace plica {

/// Per region the Prony series and kernel constants of which those of a viscous material's steps
/// are made. They are linear in the energy of shape, so that two of them say all.
struct ShapeConstants {
  std::vector<std::vector<PronyTerm>> prony;
  std::vector<std::vector<double>> half;       ///< half of the energy of shape
  std::vector<std::vector<double>> isochoric;  ///< all of it, and none of the volume
};

/// The relaxation of one level's stresses: kernels/elastic/stress_memory.hpp says how. It knows
/// them at one time, and takes forces at later ones from there. Only remember() moves it on, by the
/// time that has passed: once more at the same time and state it changes nothing. So whatever
/// evaluates forces may do so as often as it likes; whoever accepts a state remembers it.
template <class B>
class Viscosity {
 public:
  using Exec = typename B::Exec;

  /// Of a level that is built: makes level.stress. `rule` is one of relaxation_rules().
  Viscosity(const ShapeConstants& constants, const std::string& rule, const TetMesh& mesh,
            Level<B>& level);

  /// The displacements u are the body's at `time` [s].
  void remember(const Exec&, const Level<B>&, const Elasticity<B>&, const Vectors<B>& u,
                double time);
  /// Constants and level.stress.lost for forces at `time` [s].
  void look_at(const Exec&, const Level<B>&, double time);
  /// The constants of the material at once.
  void look_at_once(const Exec& exec) { take_share(exec, 0); }
  /// The clock is set to another time [s].
  void set_time(double time) { time_ = time, looked_ = none; }

  /// What it carries from step to step.
  struct Kept {
    Scalars<B> memory;
    double time = 0;
  };
  void keep(const Exec&, const Level<B>&, Kept& to) const;
  void put_back(const Exec&, const Level<B>&, const Kept& from);
  void persist(StateArchive<B>& archive, const Level<B>& level, const std::string& name);
  std::size_t bytes(const Level<B>& level) const;

 private:
  using Real = typename B::Real;
  static constexpr double none = -1;

  RelaxationSteps<B> steps_;
  Scalars<B> constants_;     ///< the model's own
  Indices<B> set_region_;    ///< of each set of these
  Scalars<B> whole_, half_;  ///< with all of the energy of shape and half of it
  Scalars<B> isochoric_;
  double time_ = 0;        ///< of the memory [s]
  double shared_ = 0;      ///< time from the memory's that the model's constants are for [s]
  double stepped_ = none;  ///< likewise steps_
  double looked_ = none;   ///< likewise level.stress.lost

  void step_over(const Exec& exec, double t);
  void take_share(const Exec& exec, double t);
};

}  // namespace plica
