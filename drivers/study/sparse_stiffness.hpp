// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <functional>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/drivers/study/lowest_eigenvalues.hpp>

namespace plica {

/// Where direct solves run.
using HostBackend = Backend<double, Kokkos::DefaultHostExecutionSpace>;

/// Whether the vertex at this rest position must not move along this axis: planes of symmetry, plane strain.
using Held = std::function<bool(const Point& rest, int axis)>;

/// Direct solvers on a level's own tangent kernel, for what the integrators should come to. Its degrees of freedom are those of
/// the free vertices that nothing holds.
class SparseStiffness {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  /// K at rest; the probe must outlive this.
  explicit SparseStiffness(LevelProbe<HostBackend>& probe, const Held& held = {});

  /// K at these displacements [m] from now on.
  void linearise(const std::vector<Point>& u);

  const Matrix& matrix() const { return matrix_; }
  /// The displacement [m] in balance with these forces [N] by this K.
  std::vector<Point> equilibrium(const std::vector<Point>& force) const;
  /// Frequency [Hz] and shape of the lowest mode, by inverse iteration from a start that has a part in it.
  double lowest_frequency(std::vector<Point>& shape) const;
  /// The lowest ones [Hz], ascending; `shift` [1/s^2] > 0 is needed where rigid motion is free.
  std::vector<double> frequencies(int count, double shift = 0) const;

  /// The part of a field on the degrees of freedom, and back: zero elsewhere.
  Eigen::VectorXd part(const std::vector<Point>& field) const;
  std::vector<Point> field(const Eigen::VectorXd& x) const;

 private:
  LevelProbe<HostBackend>& probe_;
  std::vector<int> free_;  // 3 a + k
  std::vector<double> mass_;
  std::vector<std::vector<int>> neighbours_, colours_;
  Matrix matrix_;
  Eigen::SimplicialLDLT<Matrix> solver_;

  std::size_t vertex(Eigen::Index r) const { return static_cast<std::size_t>(free_[static_cast<std::size_t>(r)] / 3); }
  int axis(Eigen::Index r) const { return free_[static_cast<std::size_t>(r)] % 3; }
};

}  // namespace plica
