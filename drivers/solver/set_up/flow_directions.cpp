// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/set_up/flow_directions.hpp>
#include <plica/drivers/solver/set_up/selection.hpp>

namespace plica {

namespace {

using Gradients = Eigen::Matrix<double, 3, 4>;  // of the shape functions

const Point& corner_of(const TetMesh& mesh, std::size_t tet, std::size_t corner) {
  return mesh.vertices[static_cast<std::size_t>(mesh.tets[tet][corner])];
}

Gradients shape_gradients(const TetMesh& mesh, std::size_t tet) {
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k)
    edges.row(k) = corner_of(mesh, tet, static_cast<std::size_t>(k) + 1) - corner_of(mesh, tet, 0);
  Gradients g;
  g.rightCols<3>() = edges.inverse();
  g.col(0) = -g.rightCols<3>().rowwise().sum();
  return g;
}

double volume_of(const TetMesh& mesh, std::size_t t) {
  return mesh.part(t) *
         tet_volume(corner_of(mesh, t, 0), corner_of(mesh, t, 1), corner_of(mesh, t, 2), corner_of(mesh, t, 3));
}

/// What is given of each vertex: 0 or 1, or NaN where it is free.
std::vector<double> given_temperatures(const TetMesh& mesh, const Selection& from, const Selection& to,
                                       const std::string& path) {
  const double free = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> given(mesh.vertices.size(), free);
  for (const int v : select_vertices(mesh, from, {path + ".from", 0})) given[static_cast<std::size_t>(v)] = 0;
  for (const int v : select_vertices(mesh, to, {path + ".to", 0})) {
    double& value = given[static_cast<std::size_t>(v)];
    if (value == 0)
      throw InputError(path + ".to: vertex " + std::to_string(v) +
                       " of level 0 is in `from` as well; expected sets apart");
    value = 1;
  }
  return given;
}

/// int grad w . grad T = 0 for every w that is 0 where T is given.
std::vector<double> temperatures(const TetMesh& mesh, std::vector<double> T) {
  std::vector<int> unknown(T.size(), -1);
  int count = 0;
  for (std::size_t v = 0; v < T.size(); ++v)
    if (std::isnan(T[v])) unknown[v] = count++;
  if (count == 0) return T;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(count);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Gradients g = shape_gradients(mesh, t);
    const Eigen::Matrix4d K = volume_of(mesh, t) * g.transpose() * g;
    for (int i = 0; i < 4; ++i) {
      const int row = unknown[static_cast<std::size_t>(mesh.tets[t][static_cast<std::size_t>(i)])];
      for (int j = 0; row >= 0 && j < 4; ++j) {
        const auto w = static_cast<std::size_t>(mesh.tets[t][static_cast<std::size_t>(j)]);
        if (unknown[w] >= 0)
          entries.emplace_back(row, unknown[w], K(i, j));
        else
          b[row] -= K(i, j) * T[w];
      }
    }
  }
  Eigen::SparseMatrix<double> A(count, count);
  A.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(A);
  solver.setTolerance(1e-12);
  const Eigen::VectorXd x = solver.solve(b);
  for (std::size_t v = 0; v < T.size(); ++v)
    if (unknown[v] >= 0) T[v] = x[unknown[v]];
  return T;
}

/// Gives elements without a direction the mean of those that share a vertex with them, from these on; false where none of them has one.
bool take_from_neighbours(const TetMesh& mesh, std::vector<Point>& direction) {
  std::vector<Point> at_vertex(mesh.vertices.size(), Point::Zero());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const int v : mesh.tets[t]) at_vertex[static_cast<std::size_t>(v)] += direction[t];
  bool found = false;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!direction[t].isZero(0)) continue;
    for (const int v : mesh.tets[t]) direction[t] += at_vertex[static_cast<std::size_t>(v)];
    if (direction[t].norm() > 0) direction[t].normalize(), found = true;
  }
  return found;
}

}  // namespace

std::vector<Point> flow_directions(const TetMesh& mesh, const Selection& from, const Selection& to,
                                   const std::string& path) {
  const std::vector<double> T = temperatures(mesh, given_temperatures(mesh, from, to, path));
  const Box box = bounding_box(mesh.vertices);
  const double nothing = 1e-9 / (box.max - box.min).norm();
  std::vector<Point> direction;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Eigen::Vector4d at;
    for (int k = 0; k < 4; ++k) at[k] = T[static_cast<std::size_t>(mesh.tets[t][static_cast<std::size_t>(k)])];
    const Point g = shape_gradients(mesh, t) * at;
    direction.push_back(g.norm() > nothing ? g.normalized() : Point::Zero());
  }
  const auto none = [](const Point& d) { return d.isZero(0); };
  for (auto at = std::ranges::find_if(direction, none); at != direction.end();
       at = std::ranges::find_if(direction, none))
    if (!take_from_neighbours(mesh, direction))
      throw InputError(path + ": the part of the body with element " + std::to_string(at - direction.begin()) +
                       " of level 0 touches only one of `from` and `to`, or none; expected fibres between both");
  return direction;
}

}  // namespace plica
