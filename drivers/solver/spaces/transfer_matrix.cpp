// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <plica/drivers/solver/spaces/row_ranges.hpp>
#include <plica/drivers/solver/spaces/transfer_matrix.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <tuple>
#include <utility>
#include <vector>

namespace plica {

namespace {

constexpr double reach = 1.2;      // of the longest edge
constexpr double most_weight = 3;  // sum of |weights|
constexpr std::size_t fewest = 5;  // entries

double spline(double s) { return s < 1 ? (1 - s) * (1 - s) * (1 + 2 * s) : 0; }

// The weights of `ring`, whose first entry is the vertex itself; empty where they are not to be had.
std::vector<double> ring_weights(const TetMesh& mesh, const std::vector<int>& ring) {
  const auto at = [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
  if (ring.size() < fewest) return {};
  double longest = 0;
  for (int b : ring) longest = std::max(longest, (at(b) - at(ring[0])).norm());
  std::vector<double> weight;
  std::vector<Eigen::Vector4d> basis;
  Eigen::Matrix4d moments = Eigen::Matrix4d::Zero();
  for (int b : ring) {
    const Point d = (at(b) - at(ring[0])) / (reach * longest);
    basis.emplace_back(1, d[0], d[1], d[2]);
    weight.push_back(spline(d.norm()));
    moments += weight.back() * basis.back() * basis.back().transpose();
  }
  const Eigen::Vector4d c = moments.completeOrthogonalDecomposition().solve(Eigen::Vector4d::Unit(0));
  double sum = 0, size = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    weight[i] *= c.dot(basis[i]);
    sum += weight[i], size += std::abs(weight[i]);
  }
  return std::abs(sum - 1) < 1e-8 && size <= most_weight ? weight : std::vector<double>{};
}

}  // namespace

RowMatrix ring_smoothing(const TetMesh& mesh) {
  const auto n = static_cast<Eigen::Index>(mesh.vertices.size());
  std::vector<std::vector<int>> rings(mesh.vertices.size());
  for (int a = 0; a < static_cast<int>(n); ++a) rings[static_cast<std::size_t>(a)].push_back(a);
  for (const auto& [a, b] : mesh_edges(mesh)) {
    rings[static_cast<std::size_t>(a)].push_back(b);
    rings[static_cast<std::size_t>(b)].push_back(a);
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& ring : rings) {
    const std::vector<double> weight = ring_weights(mesh, ring);
    if (weight.empty()) entries.emplace_back(ring[0], ring[0], 1.0);
    for (std::size_t i = 0; i < weight.size(); ++i)
      if (std::abs(weight[i]) > 1e-12) entries.emplace_back(ring[0], ring[i], weight[i]);
  }
  RowMatrix S(n, n);
  S.setFromTriplets(entries.begin(), entries.end());
  return S;
}

namespace {

RowMatrix barycentric_transfer(const Embedding& up, std::size_t coarse_vertices) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t a = 0; a < up.vertices.size(); ++a)
    for (std::size_t c = 0; c < 4; ++c)
      if (up.weights[a][c] != 0) entries.emplace_back(static_cast<int>(a), up.vertices[a][c], up.weights[a][c]);
  RowMatrix P(static_cast<Eigen::Index>(up.vertices.size()), static_cast<Eigen::Index>(coarse_vertices));
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

}  // namespace

RowMatrix transfer_matrix(const TetMesh& fine, const std::vector<char>& fine_constrained, const TetMesh& coarse,
                          const std::vector<char>& coarse_constrained, const Embedding& up, bool smooth) {
  RowMatrix P = barycentric_transfer(up, coarse.vertices.size());
  if (smooth) P = RowMatrix(ring_smoothing(fine) * P);
  P.prune([&](Eigen::Index a, Eigen::Index b, double value) {
    return !fine_constrained[static_cast<std::size_t>(a)] && !coarse_constrained[static_cast<std::size_t>(b)] &&
           std::abs(value) > 1e-6;
  });
  return P;
}

namespace {

/// Some of the product's rows, one after the other.
struct ProductRows {
  std::vector<int> first{0}, column;
  std::vector<double> value;
};

/// A row in the making.
class ProductRow {
 public:
  explicit ProductRow(Eigen::Index columns)
      : sum_(static_cast<std::size_t>(columns), 0.0), known_(static_cast<std::size_t>(columns), 0) {}

  /// += factor times a row of B, from a column on
  void add(double factor, const RowMatrix& B, Eigen::Index row, int from = 0) {
    const int *const column = B.innerIndexPtr(), *const last = column + B.outerIndexPtr()[row + 1];
    for (const int* at = std::lower_bound(column + B.outerIndexPtr()[row], last, from); at < last; ++at) {
      const auto j = static_cast<std::size_t>(*at);
      if (!std::exchange(known_[j], 1)) sum_[j] = 0, columns_.push_back(*at);
      sum_[j] += factor * B.valuePtr()[at - column];
    }
  }

  /// Moves what was added to the end of `rows`, columns ascending.
  void append_to(ProductRows& rows) {
    std::sort(columns_.begin(), columns_.end());
    for (const int column : columns_) {
      known_[static_cast<std::size_t>(column)] = 0;
      rows.column.push_back(column), rows.value.push_back(sum_[static_cast<std::size_t>(column)]);
    }
    rows.first.push_back(static_cast<int>(rows.column.size()));
    columns_.clear();
  }

 private:
  std::vector<double> sum_;
  std::vector<char> known_;
  std::vector<int> columns_;
};

RowMatrix joined_rows(const std::vector<ProductRows>& parts, Eigen::Index rows, Eigen::Index columns) {
  RowMatrix result(rows, columns);
  int* const first = result.outerIndexPtr();
  Eigen::Index row = 0;
  first[0] = 0;
  std::vector<int> start;
  for (const ProductRows& part : parts) {
    start.push_back(first[row]);
    for (std::size_t i = 1; i < part.first.size(); ++i) first[++row] = start.back() + part.first[i];
  }
  result.resizeNonZeros(first[rows]);
  for_row_ranges(parts.size(), [&](std::size_t from, std::size_t to) {
    for (std::size_t p = from; p < to; ++p) {
      std::copy(parts[p].column.begin(), parts[p].column.end(), result.innerIndexPtr() + start[p]);
      std::copy(parts[p].value.begin(), parts[p].value.end(), result.valuePtr() + start[p]);
    }
  });
  return result;
}

}  // namespace

namespace {

/// A B, of row i from column from(i) on.
template <class From>
RowMatrix product_from(const RowMatrix& A, const RowMatrix& B, const From& from) {
  const auto rows = static_cast<std::size_t>(A.rows());
  std::vector<ProductRows> parts(row_parts(rows));
  for_row_parts(rows, [&](std::size_t p, std::size_t first, std::size_t last) {
    ProductRow sum(B.cols());
    for (std::size_t i = first; i < last; ++i) {
      for (RowMatrix::InnerIterator entry(A, static_cast<Eigen::Index>(i)); entry; ++entry)
        sum.add(entry.value(), B, entry.col(), from(i));
      sum.append_to(parts[p]);
    }
  });
  return joined_rows(parts, A.rows(), B.cols());
}

}  // namespace

RowMatrix product(const RowMatrix& A, const RowMatrix& B) {
  return product_from(A, B, [](std::size_t) { return 0; });
}

RowMatrix galerkin_product(const RowMatrix& A, const RowMatrix& P) {
  const RowMatrix upper =
      product_from(RowMatrix(P.transpose()), product(A, P), [](std::size_t i) { return static_cast<int>(i); });
  return upper.selfadjointView<Eigen::Upper>();
}

RowMatrix matrix_of_rows(const std::vector<std::vector<std::pair<int, double>>>& rows, Eigen::Index columns) {
  RowMatrix A(static_cast<Eigen::Index>(rows.size()), columns);
  int* first = A.outerIndexPtr();
  first[0] = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) first[i + 1] = first[i] + static_cast<int>(rows[i].size());
  A.resizeNonZeros(first[rows.size()]);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < rows[i].size(); ++k)
      std::tie(A.innerIndexPtr()[first[i] + static_cast<int>(k)], A.valuePtr()[first[i] + static_cast<int>(k)]) =
          rows[i][k];
  return A;
}

}  // namespace plica
