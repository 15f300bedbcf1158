// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/label_image.hpp>
#include <plica/meshes/label_votes.hpp>
#include <vector>

namespace plica {

/// Tetrahedra of a lattice that have a label above 0, see fill_labels().
struct LabelledTets {
  TetMesh mesh;            ///< without regions
  std::vector<int> label;  ///< label of each tetrahedron
};

/// Returns the tetrahedra of a body-centred cubic lattice, with cubes of `edge`, over a box.
/// @throw InputError for more than 2 million cubes
LabelledTets label_lattice(const LabelVotes& votes, const Box& box, double edge);

}  // namespace plica
