// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/block_matrix.hpp>
#include <plica/core/implicit_weights.hpp>
#include <plica/core/level.hpp>
#include <plica/core/problem.hpp>
#include <plica/kernels/contact/implicit_response.hpp>
#include <plica/kernels/contact/penalty.hpp>
#include <plica/kernels/implicit/system_kernels.hpp>
#include <plica/kernels/reduce.hpp>
#include <vector>

namespace plica {

/// Contact's work arrays for one level's surface points.
template <class B>
struct ContactPoints {
  Vectors<B> force;  ///< [points][3] N
  Blocks<B> block;   ///< [points][6] kg, on implicit levels only
};

/// One obstacle: launches the kernels of its shape.
template <class B>
class Obstacle {
 public:
  using Exec = typename B::Exec;
  virtual ~Obstacle() = default;
  /// Sets (first) or adds its forces on the surface points of the state at `time`.
  virtual void forces(const Exec&, const EmbeddedSurface<B>&, const State<B>&, double time, bool first,
                      const ContactPoints<B>&) const = 0;
  /// The same with the blocks of an implicit stage; contact is predicted `ahead` of the state [s].
  virtual void linearise(const Exec&, const EmbeddedSurface<B>&, const State<B>&, double time, const ImplicitWeights&,
                         double ahead, bool first, const ContactPoints<B>&) const = 0;
  /// Makes it the nearest obstacle of the points that it is the nearest of, so far.
  virtual void find(const Exec&, const EmbeddedSurface<B>&, const State<B>&, double time, bool first,
                    const TouchingPoints<B>&) const = 0;
  /// Energy stored in its penalties [J], into result(0).
  virtual void energy(const Exec&, const EmbeddedSurface<B>&, const State<B>&, double time, const BlockSums<B>&,
                      const Doubles<B>& result) const = 0;
  /// Device memory of its own.
  virtual std::size_t bytes() const = 0;
};

/// Launches the kernels of the shape that the options name.
template <class B>
std::unique_ptr<Obstacle<B>> make_obstacle(const ObstacleOptions& options, const PenaltyLaw<typename B::Real>& law,
                                           const DepthWatch<B>& watch);

/// Penalty contact between a level's embedded surface and all obstacles.
template <class B>
class Contact {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;

  /// `area` of the whole surface [m^2], `edge` the finest level's mean edge [m]: see ContactOptions for the law. `size` of the
  /// body [m]: a point deeper than that is lost.
  Contact(const ContactOptions& options, const MaterialOptions& material, int points, double area, double edge,
          double size);

  ContactPoints<B> make_points(bool implicit) const;
  /// f += the contact forces of a state
  void add_forces(const Exec&, const Level<B>&, const State<B>&, double time, const ContactPoints<B>&,
                  const Vectors<B>& f) const;
  void linearise(const Exec&, const Level<B>&, const State<B>&, double time, const ImplicitWeights&, double ahead,
                 const ContactPoints<B>&, const Vectors<B>& f) const;
  /// The nearest obstacle of every point of a state.
  void find(const Exec&, const Level<B>&, const State<B>&, double time, const TouchingPoints<B>&) const;
  /// q += W^T block W p, and diagonal += its vertex blocks
  void add_product(const Exec&, const Level<B>&, const Vectors<B>& p, const ContactPoints<B>&,
                   const Vectors<B>& q) const;
  void add_diagonal(const Exec&, const Level<B>&, const ContactPoints<B>&, const Blocks<B>& diagonal) const;
  /// A += W^T block W
  void add_matrix(const Exec&, const Level<B>&, const ContactPoints<B>&, const BlockMatrix<B>& A) const;
  double energy(const Exec&, const Level<B>&, double time, const BlockSums<B>&) const;

  /// A surface point that since the last call was found deeper in an obstacle than deepest(), or nowhere; -1: none. Waits.
  int take_lost(const Exec&) const;
  double deepest() const { return deepest_; }  ///< [m]

  double stiffness() const { return stiffness_; }  ///< of a point [N/m]
  double damping() const { return damping_; }      ///< the larger of its coefficients [N s/m]
  double normal_damping() const { return normal_damping_; }
  int points() const { return points_; }
  std::size_t grid_bytes() const;  ///< of sampled distances

 private:
  int points_;
  double stiffness_, normal_damping_, damping_, deepest_;
  Indices<B> lost_;  ///< [1] see DepthWatch
  std::vector<std::unique_ptr<Obstacle<B>>> obstacles_;
};

}  // namespace plica
