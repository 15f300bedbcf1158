// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <plica/core/nodal_rows.hpp>
#include <vector>

namespace plica {

/// What nodal elements need to know of a mesh's regions; an entry each, one where the mesh names
/// none.
struct NodalConstants {
  std::vector<std::vector<double>> material;  ///< constants of the material
  std::vector<double> stabiliser;             ///< beta mu [Pa]
  std::vector<double> excess;                 ///< of lambda, on smoothed volumes [Pa]; empty: none
  std::vector<double> damping;                ///< by stiffness [s]; empty: none
};

/// The rows of a mesh at rest, in its vertices' order but for short windows, in which rows of a
/// like length stand together.
template <class B>
NodalRows<B> build_nodal_rows(const TetMesh& mesh, const NodalConstants& constants);

/// Buffers for them.
template <class B>
NodalWork<B> make_nodal_work(const NodalRows<B>& rows);

}  // namespace plica
