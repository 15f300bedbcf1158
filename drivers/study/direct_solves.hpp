// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <functional>
#include <plica/core/problem.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/eigenvalues.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <vector>

namespace plica {

/// Backend of direct solves: double precision on the host.
using HostBackend = Backend<double, Kokkos::DefaultHostExecutionSpace>;

/// Throws std::runtime_error with the diagnosis where a run does not pass its check.
void require_sound(Simulation<HostBackend>& simulation);

/// True for a vertex, by its rest position, that must not move along this axis. For planes of
/// symmetry and plane strain.
using Held = std::function<bool(const Point& rest, int axis)>;

/// Solvers on a level's own tangent kernel, to compare the integrators with. Linear elements are
/// solved directly. Nodal elements are solved by conjugate gradients to round-off, preconditioned
/// by a direct solve of linear elements with lambda = 2 mu at most. The degrees of freedom are
/// those of the free vertices, without the ones that `held` fixes.
class SparseStiffness {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  /// Computes K at rest; the probe must outlive this object.
  explicit SparseStiffness(LevelProbe<HostBackend>& probe, const Held& held = {});

  /// Computes K at these displacements [m], for all later solves.
  void linearise(const std::vector<Point>& u);

  /// Returns K; with nodal elements the K of the linear elements of the preconditioner.
  const Matrix& matrix() const { return matrix_; }
  /// Returns the displacement [m] at which K balances these forces [N].
  std::vector<Point> equilibrium(const std::vector<Point>& force) const;
  /// Returns the frequency [Hz] of the lowest mode, by inverse iteration.
  /// @param shape  start, which must contain a part of the mode; on return the mode's shape
  double lowest_frequency(std::vector<Point>& shape) const;
  /// Returns the lowest `count` frequencies [Hz], ascending. A `shift` [1/s^2] > 0 is needed where
  /// rigid motion is free.
  std::vector<double> frequencies(int count, double shift = 0) const;

  /// Returns the values of a field on the degrees of freedom.
  Eigen::VectorXd part(const std::vector<Point>& field) const;
  /// Returns the field with these values on the degrees of freedom, zero elsewhere.
  std::vector<Point> field(const Eigen::VectorXd& x) const;

 private:
  using Factor = Eigen::SimplicialLDLT<Matrix>;

  LevelProbe<HostBackend>& probe_;
  std::unique_ptr<LevelProbe<HostBackend>> linear_;  // none: the elements are linear
  std::vector<Point> at_;                            // displacements at which K is taken [m]
  std::vector<int> free_;                            // degrees of freedom, 3 a + k
  std::vector<double> mass_;
  std::vector<std::vector<int>> neighbours_, colours_;
  Matrix matrix_;
  Factor solver_;

  /// Solves (K + shift M) x = b by the factor of that matrix.
  Eigen::VectorXd solve(const Factor& factor, const Eigen::VectorXd& b, double shift = 0) const;
  Eigen::VectorXd masses() const;
  std::size_t vertex(Eigen::Index r) const {
    return static_cast<std::size_t>(free_[static_cast<std::size_t>(r)] / 3);
  }
  int axis(Eigen::Index r) const { return free_[static_cast<std::size_t>(r)] % 3; }
};

/// Settings of static_equilibrium().
struct StaticOptions {
  Held held;  ///< degrees of freedom to fix, besides the fixed vertices
  /// number of load steps, in which the loads' time functions are followed from 0 to 1 s
  int load_steps = 1;
  std::vector<Point> start;          ///< displacement at the start [m]; empty: none
  std::vector<Point> force;          ///< additional forces [N]; empty: none
  double relative_residual = 1e-10;  ///< over the largest residual met; a step ends below it
};

/// Returns the displacement [m] at which all forces on the finest level balance. Newton's method
/// with direct solves, whose steps are halved until the residual falls. Throws std::runtime_error
/// where that does not converge.
std::vector<Point> static_equilibrium(LevelProbe<HostBackend>& probe, const StaticOptions& options);

/// Returns the frequency [Hz] of a body that is released at rest in a deformed shape. It is taken
/// from the falling zero crossings of the most displaced vertex, along its displacement. Runs in
/// double on the host; throws std::runtime_error where the run fails.
/// @param amplitude  largest displacement at the start [m]
/// @param periods    number of periods over which the frequency is averaged
/// @param guess      estimate of the frequency [Hz]
double frequency_of_motion(const Problem& problem, const std::vector<Point>& shape,
                           double amplitude, int periods, double guess);

}  // namespace plica
