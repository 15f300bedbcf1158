// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <cmath>
#include <plica/core/dense.hpp>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/spaces/coarse_stiffness.hpp>
#include <plica/meshes/tet_gradients.hpp>
#include <utility>

namespace plica {

namespace {

/// Consecutive elements of one region of a mesh. Only the part of the gradients that is linear over
/// the cell enters a stiffness. It is given by the products of the gradients with four functions:
/// 1, x, y, z, made orthonormal over the elements. With up to four elements no part is lost.
class Cell {
 public:
  static constexpr int functions = 4;
  using Moments = Eigen::Matrix<double, 3, functions>;

  Cell(const TetMesh& mesh, std::size_t first, std::size_t last) {
    std::vector<TetGradients> elements;
    for (std::size_t e = first; e < last; ++e) elements.emplace_back(mesh, e);
    const Eigen::MatrixXd f = orthonormal_functions(mesh, first, elements);
    for (std::size_t e = 0; e < elements.size(); ++e)
      for (int i = 0; i < 4; ++i)
        corners_.emplace_back(mesh.tets[first + e][index_of(i)],
                              elements[e].volume * elements[e].gradient.row(i).transpose() *
                                  f.row(static_cast<Eigen::Index>(e)));
    std::ranges::sort(corners_, {}, [](const auto& corner) { return corner.first; });
    auto kept = corners_.begin();
    for (auto corner = kept + 1; corner != corners_.end(); ++corner)
      if (corner->first == kept->first)
        kept->second += corner->second;
      else
        *++kept = *corner;
    corners_.erase(kept + 1, corners_.end());
  }

  /// Calls use(column, moments of the gradient) for all entries of P at the cell's vertices. A
  /// column may come several times.
  template <class Use>
  void for_moments(const RowMatrix& P, const Use& use) const {
    for (const auto& [a, moments] : corners_)
      for (RowMatrix::InnerIterator entry(P, a); entry; ++entry)
        use(static_cast<int>(entry.col()), Moments(entry.value() * moments));
  }

 private:
  std::vector<std::pair<int, Moments>> corners_;  // vertex, moments of its shape function

  /// Returns the orthonormal functions, [elements][functions]. A function that depends on the ones
  /// before is 0. With up to four elements each element has a function of its own.
  static Eigen::MatrixXd orthonormal_functions(const TetMesh& mesh, std::size_t first,
                                               const std::vector<TetGradients>& elements) {
    const auto n = static_cast<Eigen::Index>(elements.size());
    Eigen::MatrixXd f(n, functions);
    Eigen::VectorXd volume(n);
    for (Eigen::Index e = 0; e < n; ++e) volume[e] = elements[static_cast<std::size_t>(e)].volume;
    if (n <= functions) {
      f.setZero();
      f.diagonal() = volume.cwiseSqrt().cwiseInverse();
      return f;
    }
    for (Eigen::Index e = 0; e < n; ++e) {
      Point centre = Point::Zero();
      for (const int a : mesh.tets[first + static_cast<std::size_t>(e)])
        centre += mesh.vertices[index_of(a)] / 4;
      f.row(e) << 1, centre.transpose();
    }
    for (int i = 0; i < functions; ++i) {
      const double before = (volume.array() * f.col(i).array().square()).sum();
      for (int twice = 0; twice < 2; ++twice)
        for (int j = 0; j < i; ++j)
          f.col(i) -= (volume.array() * f.col(i).array() * f.col(j).array()).sum() * f.col(j);
      const double after = (volume.array() * f.col(i).array().square()).sum();
      f.col(i) *= after > 1e-12 * before ? 1 / std::sqrt(after) : 0.0;
    }
    return f;
  }
};

/// Consecutive cells of one region. The moments g of the gradients of P's columns are one dense
/// matrix. Its product with itself gives the cells' part of the coarse stiffness:
///
///   G_kl = sum of g_I,k g_J,l over the cells and their functions
///   K_IJ += lambda G + mu G^T + mu (tr G) 1
class Cells {
 public:
  explicit Cells(std::array<double, 2> lame) : lame_(lame) {}
  /// Adds a cell of the elements [first, last).
  void add(std::size_t first, std::size_t last) { elements_.emplace_back(first, last); }

  void multiply(const TetMesh& mesh, const RowMatrix& P) {
    for (const auto& [first, last] : elements_) cells_.emplace_back(mesh, first, last);
    std::vector<int> place(static_cast<std::size_t>(P.cols()), -1);
    for (const Cell& cell : cells_)
      cell.for_moments(P, [&](int column, const Cell::Moments&) {
        if (std::exchange(place[index_of(column)], 0) < 0) columns_.push_back(column);
      });
    std::ranges::sort(columns_);
    const auto n = static_cast<Eigen::Index>(columns_.size());
    for (Eigen::Index i = 0; i < n; ++i)
      place[index_of(columns_[static_cast<std::size_t>(i)])] = static_cast<int>(i);
    Eigen::MatrixXd g =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(Cell::functions * cells_.size()), 3 * n);
    for (std::size_t c = 0; c < cells_.size(); ++c)
      cells_[c].for_moments(P, [&](int column, const Cell::Moments& moments) {
        for (int k = 0; k < 3; ++k)
          g.block<Cell::functions, 1>(static_cast<Eigen::Index>(Cell::functions * c),
                                      k * n + place[index_of(column)]) +=
              moments.row(k).transpose();
      });
    G_ = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    dense::add_gram(static_cast<int>(g.rows()), static_cast<int>(3 * n), g.data(), G_.data());
  }

  /// Adds the cells' part to the lower half of K, rows [3 first, 3 last).
  void add_to(Eigen::MatrixXd& K, int first, int last) const {
    const auto n = static_cast<Eigen::Index>(columns_.size());
    const auto sum = [&](Eigen::Index i, Eigen::Index j) { return i >= j ? G_(i, j) : G_(j, i); };
    const auto [lambda, mu] = lame_;
    for (auto I = std::ranges::lower_bound(columns_, first); I != columns_.end() && *I < last; ++I)
      for (auto J = columns_.begin(); J <= I; ++J) {
        const Eigen::Index i = I - columns_.begin(), j = J - columns_.begin();
        Eigen::Matrix3d G;
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 3; ++l) G(k, l) = sum(k * n + i, l * n + j);
        K.block<3, 3>(3 * *I, 3 * *J) +=
            lambda * G + mu * G.transpose() +
            Eigen::Matrix3d(mu * G.trace() * Eigen::Matrix3d::Identity());
      }
  }

 private:
  std::array<double, 2> lame_;
  std::vector<std::pair<std::size_t, std::size_t>> elements_;  // first and last + 1 of each cell
  std::vector<Cell> cells_;
  std::vector<int> columns_;
  Eigen::MatrixXd G_;  // lower half of the products; rows and columns are [k][column]
};

}  // namespace

Eigen::MatrixXd coarse_stiffness(const TetMesh& mesh,
                                 const std::vector<std::array<double, 2>>& lame,
                                 const RowMatrix& P) {
  const Kokkos::Profiling::ScopedRegion region("plica: coarse stiffness");
  constexpr std::size_t cells_per_column = 60, together = 32, at_a_time = 16;
  const auto region_of = [&](std::size_t e) {
    return mesh.region.empty() ? std::size_t{0} : index_of(mesh.region[e]);
  };
  const auto columns = static_cast<std::size_t>(P.cols());
  const std::size_t of_cell =
      std::max<std::size_t>(Cell::functions, mesh.tets.size() / (cells_per_column * columns));
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * P.cols(), 3 * P.cols());
  for (std::size_t first = 0; first < mesh.tets.size();) {
    std::vector<Cells> parts;
    while (parts.size() < at_a_time && first < mesh.tets.size()) {
      const std::size_t r = region_of(first);
      Cells& cells = parts.emplace_back(lame[r]);
      for (std::size_t c = 0; c < together && first < mesh.tets.size() && region_of(first) == r;
           ++c) {
        std::size_t last = first;
        while (last < std::min(first + of_cell, mesh.tets.size()) && region_of(last) == r) ++last;
        cells.add(first, last);
        first = last;
      }
    }
    for_row_ranges(parts.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) parts[p].multiply(mesh, P);
    });
    for_row_ranges(columns, [&](std::size_t begin, std::size_t end) {
      for (const Cells& part : parts)
        part.add_to(K, static_cast<int>(begin), static_cast<int>(end));
    });
  }
  return K.selfadjointView<Eigen::Lower>();
}

}  // namespace plica
