// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/label_image.hpp>
#include <vector>

namespace plica {

/// Tetrahedra of a label image.
struct LabelMesh {
  TetMesh mesh;             ///< a region for each label
  std::vector<int> labels;  ///< label of each region, ascending
  /// Volume of the tetrahedra of each label of the image over that of its voxels; 0: the label is
  /// lost, as it is thinner than the tetrahedra
  std::map<int, double> filled_part;
};

/// Returns tetrahedra that fill the labels of an image above 0, with common faces at interfaces.
///
/// They are those of a body-centred cubic lattice (Labelle & Shewchuk, Isosurface stuffing, ACM
/// TOG 26, 2007, shows it). A vertex of the lattice has the label with the largest part of a ball
/// around it. Of each edge between two labels, the end that is nearer to the interface belongs to
/// the interface. A tetrahedron has the label of its other vertices. Then interfaces are smoothed
/// and moved onto those of the image, such that the body keeps its volume, as far as no tetrahedron
/// becomes worse than a height ratio of 5 (see TetShape).
///
/// @param size  mean length of the edges, in the unit of the image
/// @throw InputError for an image without a label above 0, and for a size that is not above zero,
/// larger than the body, or so small that the lattice has more than 2 million cubes
LabelMesh fill_labels(const LabelImage& image, double size);

}  // namespace plica
