// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <plica/drivers/solver/him/axes_shape.hpp>

namespace plica {

namespace {

constexpr int smoothings = 6;
constexpr double least_mass = 1e-6, least_volume = 1e-4;  // of the largest, of the mesh's own
constexpr double least_mean = 1e-3;                       // left out of means

/// Where nothing of the finest mesh reaches a vertex: the mesh's motion there.
RowMatrix restriction_by_mass(const TetMesh& finest, const TetMesh& coarsest, const std::vector<double>& mass) {
  const Embedding in = embed(finest.vertices, coarsest, Outside::clamp);
  std::vector<double> carried(coarsest.vertices.size(), 0.0);
  const auto each = [&](const auto& use) {
    for (std::size_t i = 0; i < mass.size(); ++i)
      for (std::size_t c = 0; c < 4; ++c)
        use(i, static_cast<std::size_t>(in.vertices[i][c]), mass[i] * in.weights[i][c]);
  };
  each([&](std::size_t, std::size_t a, double m) { carried[a] += m; });
  const double least = least_mass * *std::max_element(carried.begin(), carried.end());
  std::vector<Eigen::Triplet<double>> entries;
  each([&](std::size_t i, std::size_t a, double m) {
    if (carried[a] > least && m > 0) entries.emplace_back(static_cast<int>(a), static_cast<int>(i), m / carried[a]);
  });
  const Embedding at = embed(coarsest.vertices, finest, Outside::extrapolate);
  for (std::size_t a = 0; a < carried.size(); ++a)
    for (std::size_t c = 0; c < 4 && !(carried[a] > least); ++c)
      entries.emplace_back(static_cast<int>(a), at.vertices[a][c], at.weights[a][c]);
  RowMatrix E(static_cast<Eigen::Index>(carried.size()), static_cast<Eigen::Index>(mass.size()));
  E.setFromTriplets(entries.begin(), entries.end());
  return E;
}

double edges_inverted(const std::vector<Point>& x, const std::array<int, 4>& tet, std::array<double, 10>& shape) {
  Eigen::Matrix3d edges;
  for (std::size_t s = 0; s < 3; ++s)
    edges.col(static_cast<Eigen::Index>(s)) =
        x[static_cast<std::size_t>(tet[s + 1])] - x[static_cast<std::size_t>(tet[0])];
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(shape.data()) = edges.inverse();
  return edges.determinant() / 6;
}

/// Each vertex's mean over its elements, by volume, of the means of their vertices; of flat ones by the volumes in the mesh.
RowMatrix neighbourhood_mean(const TetMesh& mesh, const std::vector<double>& volume, const std::vector<double>& sum) {
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> own(sum.size(), 0.0);
  for (const auto& t : mesh.tets)
    for (const int a : t) own[static_cast<std::size_t>(a)] += 1;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
    for (const int a : mesh.tets[e]) {
      const auto row = static_cast<std::size_t>(a);
      for (const int b : mesh.tets[e])
        entries.emplace_back(a, b, (sum[row] > 0 ? volume[e] / sum[row] : 1 / own[row]) / 4);
    }
  const auto n = static_cast<Eigen::Index>(sum.size());
  RowMatrix A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

}  // namespace

AxesShape axes_shape(const TetMesh& finest, const TetMesh& coarsest, const std::vector<double>& mass) {
  AxesShape result;
  result.restriction = restriction_by_mass(finest, coarsest, mass);
  std::vector<Point> x(coarsest.vertices.size(), Point::Zero());
  for (Eigen::Index a = 0; a < result.restriction.rows(); ++a)
    for (RowMatrix::InnerIterator entry(result.restriction, a); entry; ++entry)
      x[static_cast<std::size_t>(a)] += entry.value() * finest.vertices[static_cast<std::size_t>(entry.col())];
  std::vector<double> volume;
  double mean = 0;
  for (const auto& t : coarsest.tets) {
    std::array<double, 10> shape{};
    const double there = edges_inverted(coarsest.vertices, t, shape), here = edges_inverted(x, t, shape);
    const bool flat = !(here >= least_volume * there);
    if (flat) shape = {};
    volume.push_back(flat ? 0 : here), mean += there / static_cast<double>(coarsest.tets.size());
    result.tets.push_back(shape);
  }
  std::vector<double> sum(x.size(), 0.0);
  for (std::size_t e = 0; e < volume.size(); ++e) {
    result.tets[e][9] = volume[e] /= mean;
    for (const int a : coarsest.tets[e]) sum[static_cast<std::size_t>(a)] += volume[e];
  }
  const RowMatrix once = neighbourhood_mean(coarsest, volume, sum);
  RowMatrix all_of_it = once;
  for (int i = 1; i < smoothings; ++i) all_of_it = RowMatrix(all_of_it * once);
  all_of_it.prune([](Eigen::Index, Eigen::Index, double value) { return value > least_mean; });
  const Eigen::VectorXd sums = all_of_it * Eigen::Map<const Eigen::VectorXd>(sum.data(), once.rows());
  for (Eigen::Index a = 0; a < once.rows(); ++a)
    for (RowMatrix::InnerIterator entry(all_of_it, a); entry; ++entry)
      entry.valueRef() *= sums[a] > 0 ? 1 / sums[a] : 0.0;
  result.smoothing = all_of_it;
  return result;
}

}  // namespace plica
