// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/LU>
#include <plica/core/mesh.hpp>

namespace plica {

/// Gradients of the shape functions of a linear element, and the volume of body in it.
struct TetGradients {
  Eigen::Matrix<double, 4, 3> gradient;  ///< per corner [1/m]
  double volume;                         ///< volume times TetMesh::part() [m^3]

  /// Computes the gradients and the volume of element e.
  TetGradients(const TetMesh& mesh, std::size_t e) {
    const auto& tet = mesh.tets[e];
    Eigen::Matrix3d edges;
    for (std::size_t c = 0; c < 3; ++c)
      edges.row(static_cast<Eigen::Index>(c)) =
          (mesh.vertices[static_cast<std::size_t>(tet[c + 1])] -
           mesh.vertices[static_cast<std::size_t>(tet[0])])
              .transpose();
    volume = mesh.part(e) * edges.determinant() / 6;
    gradient.bottomRows<3>() = edges.inverse().transpose();
    gradient.row(0) = -gradient.bottomRows<3>().colwise().sum();
  }
};

}  // namespace plica
