// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <plica/core/dense.hpp>
#include <plica/core/error.hpp>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/cycles/him/mass_spaces.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <utility>

namespace plica {

namespace {

double answer_of_mode(double square, double t, double kappa) {
  const double x = t * std::sqrt(std::max(0.0, square));
  const double cap = x > 0 ? std::min(1.0, kappa / (x * x)) : 1.0;
  if (x < 1e-4) return 1;
  return x < std::numbers::pi ? std::min(std::pow(std::sin(x / 2) / (x / 2), 2), cap) : cap;
}

}  // namespace

CoarseModes::CoarseModes(Eigen::MatrixXd K, const RowMatrix& M) : unknowns_(K.rows()) {
  const Kokkos::Profiling::ScopedRegion region("plica: coarse modes");
  const Eigen::MatrixXd full = M;
  if (unknowns_ <= most_modes) {
    squares_.resize(unknowns_), modes_.resize(unknowns_, unknowns_);
    const int rank = dense::modes(static_cast<int>(full.rows()), K.data(), full.data(),
                                  squares_.data(), modes_.data());
    squares_.conservativeResize(rank), modes_.conservativeResize(Eigen::NoChange, rank);
    return;
  }
  K_ = std::move(K), M_ = Eigen::MatrixXd::Zero(unknowns_, unknowns_);
  const double typical = full.diagonal().maxCoeff();
  for (Eigen::Index a = 0; a < full.rows(); ++a)
    for (int k = 0; k < 3; ++k) {
      for (Eigen::Index b = 0; b < full.cols(); ++b) M_(3 * a + k, 3 * b + k) = full(a, b);
      double& own = M_(3 * a + k, 3 * a + k);
      if (!(own > 0)) own = typical, K_(3 * a + k, 3 * a + k) = 0;  // no finer vertex depends on it
      own *= 1 + 1e-9;  // keeps M_ regular where vertices have nearly equal motions
    }
}

Eigen::MatrixXd CoarseModes::answer(double t, double kappa) const {
  if (squares_.size() == 0) {
    Eigen::MatrixXd inverse = M_ + (t * t / kappa) * K_;
    if (!dense::invert(static_cast<int>(inverse.rows()), inverse.data()))
      throw InputError(
          "integration.cycle is him, but the stiffness of a coarse space at rest is not positive "
          "definite; expected a body whose elements and material are stable at rest, or cycle: "
          "single");
    return inverse;
  }
  const Eigen::VectorXd s =
      squares_.unaryExpr([&](double square) { return answer_of_mode(square, t, kappa); });
  Eigen::MatrixXd S(modes_.rows(), modes_.rows());
  dense::recompose(static_cast<int>(S.rows()), static_cast<int>(s.size()), s.data(), modes_.data(),
                   S.data());
  return S;
}

double CoarseModes::largest(double t, double kappa) const {
  if (squares_.size() == 0) return kappa;
  double most = 0;
  for (const double square : squares_)
    most = std::max(most, t * t * square * answer_of_mode(square, t, kappa));
  return most;
}

namespace {

/// Calls work(row) for each row of a matrix, by all threads of the host.
template <class Work>
void for_rows(const RowMatrix& A, const Work& work) {
  for_row_ranges(static_cast<std::size_t>(A.rows()), [&](std::size_t first, std::size_t last) {
    for (std::size_t a = first; a < last; ++a) work(static_cast<Eigen::Index>(a));
  });
}

bool is_not_zero(Eigen::Index, int, double value) { return value != 0; }

std::vector<double> inverse_row_sums(const RowMatrix& M) {
  std::vector<double> inverse(static_cast<std::size_t>(M.rows()), 0.0);
  for (Eigen::Index a = 0; a < M.rows(); ++a) {
    double sum = 0;
    for (RowMatrix::InnerIterator entry(M, a); entry; ++entry) sum += std::abs(entry.value());
    if (sum > 0) inverse[static_cast<std::size_t>(a)] = 1 / sum;
  }
  return inverse;
}

/// Returns M without its small entries, below a thousandth of sqrt(D_aa D_bb).
/// They are added to the diagonal, so that row sums stay. In spaces that are made of a mesh more
/// than half of the entries are that small, and their sum is 1 to 2 % of all.
RowMatrix main_entries(RowMatrix M, const std::vector<double>& inverse_diagonal) {
  constexpr double least = 1e-3;
  const Eigen::Map<const Eigen::ArrayXd> inverse(inverse_diagonal.data(), M.rows());
  const Eigen::ArrayXd scale = inverse.sqrt();
  for_rows(M, [&](Eigen::Index a) {
    double small = 0, *own = nullptr;
    for (RowMatrix::InnerIterator entry(M, a); entry; ++entry)
      if (entry.col() == a)
        own = &entry.valueRef();
      else if (std::abs(entry.value()) * scale[a] * scale[entry.col()] < least)
        small += std::exchange(entry.valueRef(), 0.0);
    if (own) *own += small;
  });
  return some_entries(M, is_not_zero);
}

/// Returns Q x, see MassSpace.
Eigen::VectorXd answer_unscaled(const MassSpace& space, const Eigen::VectorXd& x) {
  const Eigen::Map<const Eigen::ArrayXd> inverse(space.inverse_diagonal.data(), x.size());
  const Eigen::VectorXd lumped = (inverse * x.array()).matrix();
  Eigen::VectorXd answer(x.size());
  for_row_ranges(static_cast<std::size_t>(x.size()), [&](std::size_t first, std::size_t last) {
    const auto a = static_cast<Eigen::Index>(first), n = static_cast<Eigen::Index>(last - first);
    answer.segment(a, n) = 2 * x.segment(a, n) - space.mass.middleRows(a, n) * lumped;
  });
  return (inverse * answer.array()).matrix();
}

std::vector<double> scale_of(const MassSpace& space) {
  constexpr int sweeps = 30;
  constexpr double least = 0.7, most = 1.6;
  const Eigen::Index n = space.mass.rows();
  const Eigen::VectorXd momentum = space.mass * Eigen::VectorXd::Ones(n);
  Eigen::ArrayXd E = Eigen::ArrayXd::Ones(n);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const Eigen::ArrayXd answer =
        E * answer_unscaled(space, (E * momentum.array()).matrix()).array();
    for (Eigen::Index a = 0; a < n; ++a)
      if (answer[a] > 0) E[a] = std::clamp(E[a] / std::sqrt(answer[a]), least, most);
  }
  return {E.begin(), E.end()};
}

}  // namespace

std::vector<MassSpace> mass_spaces(std::vector<RowMatrix> transfers,
                                   const std::vector<double>& mass) {
  const Kokkos::Profiling::ScopedRegion region("plica: coarse masses");
  RowMatrix M(static_cast<Eigen::Index>(mass.size()), static_cast<Eigen::Index>(mass.size()));
  M.setIdentity();
  M.diagonal() = Eigen::Map<const Eigen::VectorXd>(mass.data(), M.rows());
  std::vector<MassSpace> spaces;
  for (RowMatrix& P : transfers) {
    M = galerkin_product(M, P);
    MassSpace& space = spaces.emplace_back(MassSpace{std::move(P), {}, inverse_row_sums(M), {}});
    if (&P == &transfers.back()) {  // the modes of the last level need all entries
      space.mass = std::move(M);
      break;
    }
    space.mass = main_entries(M, space.inverse_diagonal);
    space.scale = scale_of(space);
  }
  return spaces;
}

namespace {

/// Removes entries below `least`, and adds them to the largest entry of their row.
void drop_small(RowMatrix& A, double least) {
  for_rows(A, [&](Eigen::Index a) {
    double small = 0, *largest = nullptr;
    for (RowMatrix::InnerIterator entry(A, a); entry; ++entry) {
      double& value = entry.valueRef();
      if (!largest || std::abs(value) > std::abs(*largest)) largest = &value;
      if (std::abs(value) < least) small += std::exchange(value, 0.0);
    }
    if (largest && *largest != 0) *largest += small;
  });
  A = some_entries(A, is_not_zero);
}

}  // namespace

RowMatrix to_finest(const std::vector<MassSpace>& spaces) {
  const Kokkos::Profiling::ScopedRegion region("plica: coarse motions of the mesh");
  constexpr double least = 1e-4;     // the limit that transfers of points have
  RowMatrix all = spaces.back().up;  // starts at the coarsest level: fewest rows
  for (std::size_t i = spaces.size() - 1; i-- > 0;) {
    all = product(spaces[i].up, all);
    drop_small(all, least);
  }
  return all;
}

}  // namespace plica
