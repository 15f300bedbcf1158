// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <plica/drivers/linear/multigrid.hpp>
#include <plica/kernels/linear/krylov.hpp>
#include <plica/kernels/linear/vertex_blocks.hpp>
#include <plica/meshes/generators.hpp>
#include <set>

// Symmetric matrices of blocks; the same in 16 bits a number, by slots, and the polynomial that
// smooths with them.
namespace {

using namespace plica;
using B = Backend<float, Kokkos::DefaultHostExecutionSpace>;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Eigen::MatrixXd dense(const BlockMatrix<B>& A) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * A.rows, 3 * A.rows);
  for (int a = 0; a < A.rows; ++a)
    for (int s = A.first(a); s < A.first(a + 1); ++s)
      for (int k = 0; k < 9; ++k)
        all(3 * a + k % 3, 3 * A.column(s) + k / 3) = static_cast<double>(A.number(a, s, k));
  return all;
}

/// A positive definite matrix of the neighbours in a box of cells; some vertices have a given
/// motion, and no row.
struct Sample {
  HostPattern pattern;
  BlockMatrix<B> A;

  Sample() {
    const TetMesh mesh = box_mesh({{0, 0, 0}, {1, 1, 1}}, {6, 5, 4});
    const int n = static_cast<int>(mesh.vertices.size());
    std::vector<std::set<int>> row(at(n));
    for (int a = 0; a < n; ++a) row[at(a)].insert(a);
    for (const auto& tet : mesh.tets)
      for (const int a : tet)
        for (const int b : tet)
          if (!is_given(a)) row[at(a)].insert(b);
    std::vector<int> first{0}, column;
    for (const auto& columns : row) {
      column.insert(column.end(), columns.begin(), columns.end());
      first.push_back(static_cast<int>(column.size()));
    }
    pattern = {first, column};
    A = block_matrix<B>("test", pattern);
    for (int a = 0; a < n; ++a)
      for (int s = A.first(a); s < A.first(a + 1); ++s)
        for (int k = 0; k < 9 && A.is_stored(a, s); ++k)
          A.value(A.place(s), k) = s < A.diagonal(a) ? block(A.column(s), a, k % 3, k / 3)
                                                     : block(a, A.column(s), k % 3, k / 3);
  }

  static bool is_given(int a) { return a % 11 == 3; }
  /// Of sizes that differ from vertex to vertex.
  static float block(int a, int b, int i, int j) {
    const auto size = [](int v) { return static_cast<float>(1 + v % 5); };
    if (a == b) return size(a) * size(a) * (i == j ? 30.0F + static_cast<float>(i) : 2.0F);
    if (a > b) std::swap(a, b), std::swap(i, j);
    return size(a) * size(b) * std::sin(static_cast<float>(7 * a + 3 * b + 5 * i + 2 * j));
  }
};

TEST(BlockMatrix, StoresOneOfTwoBlocks) {
  const Sample m;
  std::set<int> places;
  for (int a = 0; a < m.A.rows; ++a)
    for (int s = m.A.first(a); s < m.A.first(a + 1); ++s) {
      const int b = m.A.column(s);
      if (m.A.is_stored(a, s)) {
        EXPECT_TRUE(places.insert(m.A.place(s)).second) << a << ' ' << b;
      } else {
        EXPECT_FALSE(Sample::is_given(b));
      }
      for (int k = 0; k < 9; ++k)
        EXPECT_EQ(m.A.number(a, s, k), Sample::block(a, b, k % 3, k / 3)) << a << ' ' << b;
    }
  EXPECT_EQ(static_cast<int>(places.size()), m.A.stored());
  EXPECT_LT(m.A.stored(), 0.6 * m.A.blocks());
}

// Also of vertices whose motion is given: only their rows are empty.
TEST(BlockMatrix, ProductsAreThoseOfTheDenseOne) {
  const Sample m;
  const Eigen::MatrixXd A = dense(m.A);
  SolutionSpace<B> space;
  for (int i = 0; i < SolutionSpace<B>::size; ++i) {
    space.w[i] = zeros<Vectors<B>>("test.w", at(m.A.rows)),
    space.q[i] = zeros<Vectors<B>>("test.q", at(m.A.rows));
    for (int a = 0; a < 3 * m.A.rows; ++a)
      space.w[i](a / 3, a % 3) = std::sin(static_cast<float>(2 * a + 5 * i));
  }
  const auto y = zeros<Vectors<B>>("test.y", at(m.A.rows));
  update_vertices<B>({}, "test", m.A.rows, BlockProduct<B>{m.A, space.w[1], y});
  update_vertices<B>({}, "test", m.A.rows, SpaceProducts<B>{m.A, space});
  Kokkos::fence();
  for (int i = 0; i < SolutionSpace<B>::size; ++i) {
    Eigen::VectorXd w(A.rows());
    for (int a = 0; a < w.size(); ++a) w[a] = static_cast<double>(space.w[i](a / 3, a % 3));
    const Eigen::VectorXd want = A * w;
    for (int a = 0; a < w.size(); ++a) {
      const double bound = 2e-6 * A.row(a).cwiseAbs().sum();
      EXPECT_NEAR(static_cast<double>(space.q[i](a / 3, a % 3)), want[a], bound) << a;
      if (i == 1) {
        EXPECT_NEAR(static_cast<double>(y(a / 3, a % 3)), want[a], bound) << a;
      }
    }
  }
}

struct Packed : Sample {
  B::Exec exec;
  SlotOrder order = slot_order(pattern, PackedRows<B>::height);
  PackedRows<B> rows = packed_rows<B>(pattern, order);

  Packed() {
    update_vertices<B>(exec, "test", rows.slots(), ScaleOfVertex<B>{A, rows});
    update_vertices<B>(exec, "test", rows.slots(), PackRow<B>{A, rows});
    exec.fence();
  }
  double scale(int a) const { return static_cast<double>(rows.scale(order.slot[at(a)])); }
};

TEST(PackedRows, HaveEveryVertexInOneSlot) {
  const Packed m;
  std::set<int> vertices;
  for (std::size_t s = 0; s < m.order.vertex.size(); ++s)
    if (const int a = m.order.vertex[s]; a >= 0) {
      EXPECT_TRUE(vertices.insert(a).second);
      EXPECT_EQ(m.order.slot[at(a)], static_cast<int>(s));
    }
  EXPECT_EQ(static_cast<int>(vertices.size()), m.A.rows);
  EXPECT_EQ(static_cast<int>(m.order.vertex.size()) % PackedRows<B>::height, 0);
}

TEST(PackedRows, AreTheMatrixTo16Bits) {
  const Packed m;
  const Eigen::MatrixXd A = dense(m.A);
  const Eigen::VectorXd x = Eigen::VectorXd::NullaryExpr(
      A.rows(), [](Eigen::Index i) { return std::cos(3 * static_cast<double>(i)); });
  const auto scaled = zeros<Fours<B>>("test.scaled", m.order.vertex.size());
  for (int b = 0; b < m.A.rows; ++b)
    for (int k = 0; k < 3; ++k)
      scaled(m.order.slot[at(b)], k) = static_cast<float>(m.scale(b) * x[3 * b + k]);
  const Eigen::VectorXd want = A * x;
  for (int a = 0; a < m.A.rows; ++a) {
    const int slot = m.order.slot[at(a)];
    const Vec3<RowPack<B>> got = packed_product<B>(m.rows, RowsAt<B>(slot / B::lanes), scaled);
    for (int i = 0; i < 3; ++i) {
      double bound = 0;  // half a step of every number, and what float rounds
      for (int s = m.A.first(a); s < m.A.first(a + 1); ++s)
        for (int k = 0; k < 3; ++k) {
          const int b = m.A.column(s);
          bound += 0.51 * 0x1p16 * m.scale(a) * m.scale(b) * std::abs(x[3 * b + k]);
          bound += 1e-6 * std::abs(A(3 * a + i, 3 * b + k) * x[3 * b + k]);
        }
      EXPECT_NEAR(m.scale(a) * static_cast<double>(lane(got[i], slot % B::lanes)), want[3 * a + i],
                  bound)
          << a;
    }
  }
}

// Start and two steps, the last of which leaves what is asked for, against Lottes' recurrence in
// double.
TEST(Chebyshev, IsThePolynomial) {
  const Packed m;
  const Eigen::MatrixXd A = dense(m.A);
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(A.rows(), A.rows());
  Chebyshev<B> on{m.rows, zeros<SlotBlocks<B>>("test.D", at(m.rows.slices)),
                  zeros<Doubles<B>>("test.largest", 1),
                  zeros<SlotVectors<B>>("test.r", at(m.rows.slices)),
                  zeros<SlotVectors<B>>("test.x", at(m.rows.slices))};
  constexpr double largest = 2.5;
  on.largest(0) = largest;
  const auto blocks = zeros<Blocks<B>>("test.blocks", at(m.A.rows));
  const auto right = zeros<Vectors<B>>("test.right", at(m.A.rows));
  Eigen::VectorXd r(A.rows());
  for (int a = 0; a < m.A.rows; ++a) {
    const Eigen::Matrix3d inverse = A.block<3, 3>(3 * a, 3 * a).inverse();
    D.block<3, 3>(3 * a, 3 * a) = inverse;
    set_block<B>(blocks, a,
                 {{static_cast<float>(inverse(0, 0)), static_cast<float>(inverse(1, 1)),
                   static_cast<float>(inverse(2, 2)), static_cast<float>(inverse(0, 1)),
                   static_cast<float>(inverse(0, 2)), static_cast<float>(inverse(1, 2))}});
    for (int k = 0; k < 3; ++k)
      r[3 * a + k] = std::sin(1.0 + 2 * a + k), right(a, k) = static_cast<float>(r[3 * a + k]);
  }
  update_vertices<B>(m.exec, "test", m.rows.slots(),
                     TakeSlotBlocks<B, Blocks<B>>{m.rows.vertex, blocks, on.inverse_diagonal});
  update_vertices<B>(m.exec, "test", m.rows.slots(),
                     TakeSlots<B, Vectors<B>>{m.rows.vertex, right, on.r});
  const auto d = zeros<Fours<B>>("test.d", at(m.rows.slots())),
             e = zeros<Fours<B>>("test.e", at(m.rows.slots()));
  update_vertices<B>(m.exec, "test", m.rows.items(), ChebyshevStart<B>{on, d});
  update_vertices<B>(m.exec, "test", m.rows.items(),
                     ChebyshevStep<B>{on, d, e, 0.2F, 2.4F, Leaves::direction});
  update_vertices<B>(m.exec, "test", m.rows.items(),
                     ChebyshevStep<B>{on, e, d, 0.4F, 2.8F, Leaves::residual});

  Eigen::VectorXd x = Eigen::VectorXd::Zero(r.size()), direction = 4 / (3 * largest) * (D * r);
  const auto step = [&](double keep, double gain) {
    x += direction, r -= A * direction;
    direction = keep * direction + gain / largest * (D * r);
  };
  step(0.2, 2.4), step(0.4, 2.8);
  const auto expect_same = [&](const Fours<B>& got, const Eigen::VectorXd& want) {
    const auto back = zeros<Vectors<B>>("test.back", at(m.A.rows));
    update_vertices<B>(m.exec, "test", m.rows.slots(),
                       PutSlots<B, Vectors<B>>{m.rows.vertex, got, back});
    m.exec.fence();
    for (int a = 0; a < m.A.rows; ++a)
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(static_cast<double>(back(a, k)), want[3 * a + k],
                    1e-3 * want.cwiseAbs().maxCoeff())
            << a;
  };
  expect_same(d, r);
  // another direction, from a coarser level; the last step leaves x with the next direction added
  for (int s = 0; s < m.rows.slots(); ++s)
    for (int k = 0; k < 3; ++k) d(s, k) = m.order.vertex[at(s)] < 0 ? 0 : m.rows.scale(s) * 0.01F;
  direction.setConstant(0.01);
  update_vertices<B>(m.exec, "test", m.rows.items(),
                     ChebyshevStep<B>{on, d, e, 0.3F, 2.0F, Leaves::answer});
  step(0.3, 2.0);
  expect_same(e, x + direction);
}

// Its blocks are sums that are listed once; own blocks are there where nothing reaches them.
TEST(CoarseMatrix, IsTheGalerkinProduct) {
  const Sample m;
  constexpr int coarse = 21;
  RowMatrix P(m.A.rows, coarse);
  Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(3 * m.A.rows, 3 * coarse);
  for (int a = 0; a < m.A.rows; ++a)
    for (int j = 0; j < 3 && !Sample::is_given(a); ++j) {
      const int column = (a / 12 + 4 * j) % (coarse - 1);
      P.insert(a, column) = 0.25 * (j + 1);
      for (int k = 0; k < 3; ++k) wide(3 * a + k, 3 * column + k) = 0.25 * (j + 1);
    }
  P.makeCompressed();
  const CoarseMatrix<B> made = coarse_matrix<B>(m.pattern, P);
  galerkin_product<B>({}, made.map, m.A, made.matrix);
  Kokkos::fence();
  const Eigen::MatrixXd want = wide.transpose() * dense(m.A) * wide;
  EXPECT_LE((dense(made.matrix) - want).norm(), 1e-5 * want.norm());
  EXPECT_EQ(made.matrix.first(coarse) - made.matrix.first(coarse - 1), 1);
  EXPECT_EQ(made.matrix.column(made.matrix.diagonal(coarse - 1)), coarse - 1);
}

}  // namespace
