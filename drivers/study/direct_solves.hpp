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

/// Where direct solves run.
using HostBackend = Backend<double, Kokkos::DefaultHostExecutionSpace>;

/// Throws std::runtime_error with the diagnosis where a run does not pass its check.
void require_sound(Simulation<HostBackend>& simulation);

/// Whether the vertex at this rest position must not move along this axis: planes of symmetry,
/// plane strain.
using Held = std::function<bool(const Point& rest, int axis)>;

/// Solvers on a level's own tangent kernel, to compare the integrators with: direct ones, with
/// nodal elements conjugate gradients to round-off, preconditioned by a direct solve of linear
/// elements with lambda = 2 mu at most. Its degrees of freedom are those of the free vertices that
/// nothing holds.
class SparseStiffness {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  /// K at rest; the probe must outlive this.
  explicit SparseStiffness(LevelProbe<HostBackend>& probe, const Held& held = {});

  /// K at these displacements [m] from now on.
  void linearise(const std::vector<Point>& u);

  /// K, with nodal elements that of the linear ones.
  const Matrix& matrix() const { return matrix_; }
  /// The displacement [m] in balance with these forces [N] by this K.
  std::vector<Point> equilibrium(const std::vector<Point>& force) const;
  /// Frequency [Hz] and shape of the lowest mode, by inverse iteration from a start that has a part
  /// in it.
  double lowest_frequency(std::vector<Point>& shape) const;
  /// The lowest ones [Hz], ascending; `shift` [1/s^2] > 0 is needed where rigid motion is free.
  std::vector<double> frequencies(int count, double shift = 0) const;

  /// The part of a field on the degrees of freedom, and back: zero elsewhere.
  Eigen::VectorXd part(const std::vector<Point>& field) const;
  std::vector<Point> field(const Eigen::VectorXd& x) const;

 private:
  using Factor = Eigen::SimplicialLDLT<Matrix>;

  LevelProbe<HostBackend>& probe_;
  std::unique_ptr<LevelProbe<HostBackend>> linear_;  // with nodal elements
  std::vector<Point> at_;                            // the displacements of K
  std::vector<int> free_;                            // 3 a + k
  std::vector<double> mass_;
  std::vector<std::vector<int>> neighbours_, colours_;
  Matrix matrix_;
  Factor solver_;

  /// (K + shift M) x = b by the factor of that matrix.
  Eigen::VectorXd solve(const Factor& factor, const Eigen::VectorXd& b, double shift = 0) const;
  Eigen::VectorXd masses() const;
  std::size_t vertex(Eigen::Index r) const {
    return static_cast<std::size_t>(free_[static_cast<std::size_t>(r)] / 3);
  }
  int axis(Eigen::Index r) const { return free_[static_cast<std::size_t>(r)] % 3; }
};

/// How Newton's method goes to a body at rest under its loads.
struct StaticOptions {
  Held held;  ///< besides the fixed vertices
  /// the loads' courses are followed from time 0 to 1 s in so many
  int load_steps = 1;
  std::vector<Point> start;          ///< displacement [m]; empty: none
  std::vector<Point> force;          ///< more forces [N]; empty: none
  double relative_residual = 1e-10;  ///< to the largest residual met, at which a step ends
};

/// The displacement [m] at which all forces on the finest level balance, by Newton's method with
/// direct solves; steps are halved until the residual falls. Throws std::runtime_error where that
/// does not lead there.
std::vector<Point> static_equilibrium(LevelProbe<HostBackend>& probe, const StaticOptions& options);

/// The frequency [Hz] at which a body let go in this shape (largest amplitude [m]) moves: from the
/// falling zero crossings of its most displaced vertex along its displacement, over so many periods
/// of about 1/guess. Runs in double on the host; throws std::runtime_error where the run fails.
double frequency_of_motion(const Problem& problem, const std::vector<Point>& shape,
                           double amplitude, int periods, double guess);

}  // namespace plica
