// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <map>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica {

/// A segmented image: a label for each voxel of a regular grid. Label 0 is outside of the body.
struct LabelImage {
  std::array<int, 3> size = {0, 0, 0};  ///< number of voxels along i, j, k
  Point origin = Point::Zero();         ///< centre of the first voxel
  /// Columns: ways from the centre of a voxel to the next one along i, j, k
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  std::vector<int> labels;           ///< 0 or more, of each voxel; i is the fastest index
  std::map<int, std::string> names;  ///< names of labels, where the file has them
};

}  // namespace plica
