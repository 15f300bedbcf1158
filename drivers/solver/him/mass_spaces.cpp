// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <plica/core/dense.hpp>
#include <plica/drivers/solver/him/mass_spaces.hpp>
#include <plica/drivers/solver/spaces/transfer_matrix.hpp>

namespace plica {

namespace {

double answer_of_mode(double square, double t, double kappa) {
  const double x = t * std::sqrt(std::max(0.0, square));
  const double cap = x > 0 ? std::min(1.0, kappa / (x * x)) : 1.0;
  if (x < 1e-4) return 1;
  return x < std::numbers::pi ? std::min(std::pow(std::sin(x / 2) / (x / 2), 2), cap) : cap;
}

}  // namespace

CoarseModes::CoarseModes(Eigen::MatrixXd K, Eigen::MatrixXd M) : K_(std::move(K)), M_(std::move(M)) {
  const double typical = M_.diagonal().maxCoeff();
  for (Eigen::Index k = 0; k < M_.rows(); ++k) {
    if (!(M_(k, k) > 0)) M_(k, k) = typical, K_(k, k) = 0;  // nothing reaches it
    M_(k, k) *= 1 + 1e-9;                                   // vertices that barely differ do not make it singular
  }
  if (M_.rows() > most_modes) return;
  squares_.resize(M_.rows()), modes_.resize(M_.rows(), M_.cols());
  dense::eigenvectors(static_cast<int>(M_.rows()), K_.data(), M_.data(), squares_.data(), modes_.data());
  K_.resize(0, 0), M_.resize(0, 0);
}

Eigen::MatrixXd CoarseModes::answer(double t, double kappa) const {
  if (squares_.size() == 0) {
    Eigen::MatrixXd inverse = M_ + (t * t / kappa) * K_;
    dense::invert(static_cast<int>(inverse.rows()), inverse.data());
    return inverse;
  }
  const Eigen::VectorXd s = squares_.unaryExpr([&](double square) { return answer_of_mode(square, t, kappa); });
  Eigen::MatrixXd S(modes_.rows(), modes_.rows());
  dense::recompose(static_cast<int>(s.size()), s.data(), modes_.data(), S.data());
  return S;
}

double CoarseModes::largest(double t, double kappa) const {
  if (squares_.size() == 0) return kappa;
  double most = 0;
  for (const double square : squares_) most = std::max(most, t * t * square * answer_of_mode(square, t, kappa));
  return most;
}

namespace {

std::vector<double> inverse_row_sums(const RowMatrix& M) {
  std::vector<double> inverse(static_cast<std::size_t>(M.rows()), 0.0);
  for (Eigen::Index a = 0; a < M.rows(); ++a) {
    double sum = 0;
    for (RowMatrix::InnerIterator entry(M, a); entry; ++entry) sum += std::abs(entry.value());
    if (sum > 0) inverse[static_cast<std::size_t>(a)] = 1 / sum;
  }
  return inverse;
}

}  // namespace

std::vector<MassSpace> mass_spaces(const std::vector<MassMesh>& levels, const std::vector<double>& mass, bool smooth) {
  RowMatrix M(static_cast<Eigen::Index>(mass.size()), static_cast<Eigen::Index>(mass.size()));
  M.setIdentity();
  M.diagonal() = Eigen::Map<const Eigen::VectorXd>(mass.data(), M.rows());
  std::vector<MassSpace> spaces;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const MassMesh &fine = levels[i - 1], &coarse = levels[i];
    RowMatrix P = transfer_matrix(fine.mesh, fine.constrained, coarse.mesh, coarse.constrained, coarse.up, smooth);
    M = RowMatrix(P.transpose()) * M * P;
    spaces.push_back({std::move(P), M, inverse_row_sums(M)});
  }
  return spaces;
}

RowMatrix to_finest(const std::vector<MassSpace>& spaces) {
  RowMatrix all = spaces.front().up;
  for (std::size_t i = 1; i < spaces.size(); ++i) all = RowMatrix(all * spaces[i].up);
  return all;
}

namespace {

/// The coarse functions that live in one element of the finest mesh, and their gradients there.
struct CoarseGradients {
  std::vector<Eigen::Index> column;
  std::vector<Point> gradient;  // [1/m]

  void gather(const std::array<int, 4>& tet, const Eigen::Matrix<double, 4, 3>& shape, const RowMatrix& all) {
    column.clear(), gradient.clear();
    for (int c = 0; c < 4; ++c)
      for (RowMatrix::InnerIterator entry(all, tet[static_cast<std::size_t>(c)]); entry; ++entry) {
        const auto at = std::find(column.begin(), column.end(), entry.col()) - column.begin();
        if (at == static_cast<std::ptrdiff_t>(column.size()))
          column.push_back(entry.col()), gradient.emplace_back(Point::Zero());
        gradient[static_cast<std::size_t>(at)] += entry.value() * shape.row(c).transpose();
      }
  }
};

}  // namespace

Eigen::MatrixXd coarse_stiffness(const TetMesh& finest, const std::vector<std::array<double, 2>>& lame,
                                 const RowMatrix& all) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * all.cols(), 3 * all.cols());
  CoarseGradients here;
  for (std::size_t e = 0; e < finest.tets.size(); ++e) {
    Eigen::Matrix3d edges;
    const auto corner = [&](std::size_t c) { return finest.vertices[static_cast<std::size_t>(finest.tets[e][c])]; };
    for (int c = 0; c < 3; ++c) edges.row(c) = (corner(static_cast<std::size_t>(c + 1)) - corner(0)).transpose();
    const double volume = edges.determinant() / 6;
    Eigen::Matrix<double, 4, 3> shape;
    shape.bottomRows<3>() = edges.inverse().transpose();
    shape.row(0) = -shape.bottomRows<3>().colwise().sum();
    here.gather(finest.tets[e], shape, all);
    const auto [lambda, mu] = lame[finest.region.empty() ? 0 : static_cast<std::size_t>(finest.region[e])];
    for (std::size_t i = 0; i < here.column.size(); ++i)
      for (std::size_t j = 0; j < here.column.size(); ++j) {
        if (here.column[j] > here.column[i]) continue;  // the lower triangle
        const Point &gi = here.gradient[i], &gj = here.gradient[j];
        Eigen::Matrix3d block = lambda * gi * gj.transpose() + mu * gj * gi.transpose();
        block.diagonal().array() += mu * gi.dot(gj);
        K.block<3, 3>(3 * here.column[i], 3 * here.column[j]) += volume * block;
      }
  }
  return K.selfadjointView<Eigen::Lower>();
}

}  // namespace plica
