// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numeric>
#include <plica/drivers/spaces/block_rows.hpp>
#include <plica/drivers/spaces/coarse_stiffness.hpp>
#include <plica/drivers/spaces/edge_graph.hpp>
#include <plica/drivers/spaces/moving_least_squares.hpp>
#include <plica/drivers/study/level_probe.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"

// The stiffness of a mesh at rest, and as it is seen from a few points.
namespace {

using namespace plica;
using namespace plica::test;

Eigen::MatrixXd dense_matrix(const BlockRows& K) {
  const auto n = static_cast<Eigen::Index>(3 * K.size());
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < K.size(); ++i)
    for (const auto& [j, block] : K[i])
      full.block<3, 3>(static_cast<Eigen::Index>(3 * i), 3 * j) = block;
  return full;
}

/// From 20 points of a mesh.
RowMatrix from_some_points(const TetMesh& mesh) {
  const EdgeGraph graph = edge_graph(mesh);
  std::vector<int> all(mesh.vertices.size());
  std::iota(all.begin(), all.end(), 0);
  const std::vector<int> points = farthest_points(graph, 20);
  return moving_least_squares(graph, all, points, point_graph(graph, points).spacing, 1.8);
}

/// P^T K P, by all numbers.
Eigen::MatrixXd seen_from_points(const Eigen::MatrixXd& K, const RowMatrix& P) {
  Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(3 * P.rows(), 3 * P.cols());
  for (Eigen::Index a = 0; a < P.rows(); ++a)
    for (RowMatrix::InnerIterator e(P, a); e; ++e)
      for (int k = 0; k < 3; ++k) wide(3 * a + k, 3 * e.col() + k) = e.value();
  return wide.transpose() * K * wide;
}

TEST(BlockRows, AreTheStiffnessOfLinearElements) {
  Problem p = body_of({jittered_box(decimetre, {3, 3, 3})}, "linear");
  p.integration.macro_step = 1e-9;
  LevelProbe<Host> probe(p);
  const Lame<double> lame =
      lame_constants(p.body.material.young_modulus, p.body.material.poisson_ratio);
  const Eigen::MatrixXd expected = probe.stiffness_matrix(probe.zero());
  EXPECT_LE(
      (dense_matrix(rest_stiffness(p.body.levels[0], {{lame.lambda, lame.mu}})) - expected).norm(),
      1e-12 * expected.norm());
}

struct CoarseStiffnessOf {
  TetMesh mesh;
  RowMatrix P;
  Eigen::MatrixXd expected, found;

  explicit CoarseStiffnessOf(const std::array<int, 3>& cells)
      : mesh(jittered_box(decimetre, cells)), P(from_some_points(mesh)) {
    for (std::size_t e = 0; e < mesh.tets.size(); ++e) mesh.region.push_back(e % 100 < 30 ? 1 : 0);
    const std::vector<std::array<double, 2>> lame{{3e4, 1e4}, {0, 5e4}};
    expected = seen_from_points(dense_matrix(rest_stiffness(mesh, lame)), P);
    found = coarse_stiffness(mesh, lame, P);
  }
};

TEST(CoarseStiffness, IsThatOfTheMeshSeenFromItsPoints) {
  const CoarseStiffnessOf small({6, 6, 6});  // 20 columns, 1296 elements: four to a cell
  EXPECT_LE((small.found - small.expected).norm(), 1e-12 * small.expected.norm());
  EXPECT_EQ(small.found, small.found.transpose().eval());
}

TEST(CoarseStiffness, HasWhatIsLinearInLargerCells) {
  const CoarseStiffnessOf large({12, 12, 12});  // eight
  const Eigen::MatrixXd left_out = large.expected - large.found;
  EXPECT_GT(left_out.norm(), 1e-9 * large.expected.norm());
  EXPECT_LE(left_out.norm(), 0.1 * large.expected.norm());
  EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(left_out).eigenvalues()[0],
            -1e-12 * large.expected.norm());
}

TEST(GalerkinProduct, IsOfBothHalves) {
  const TetMesh mesh = jittered_box(decimetre, {5, 5, 5});
  const RowMatrix P = from_some_points(mesh),
                  A = product(RowMatrix(ring_smoothing(mesh).transpose()), ring_smoothing(mesh));
  const Eigen::MatrixXd expected = Eigen::MatrixXd(P).transpose() * Eigen::MatrixXd(A) *
                                   Eigen::MatrixXd(P),
                        found = galerkin_product(A, P);
  EXPECT_LE((found - expected).norm(), 1e-13 * expected.norm());
  EXPECT_EQ(found, found.transpose().eval());
}

}  // namespace
