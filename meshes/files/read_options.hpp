// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <vector>

namespace plica {

/// Treatment of tetrahedra that cannot be simulated: an InputError, or kept for repair_mesh().
enum class Flaws { refused, kept };

/// Treatment of second-order tetrahedra. Split: eight linear ones by the nodes on the edges, where
/// all cells of the file are of this kind. Linear: one by the corners.
enum class SecondOrder { split, linear };

/// Distance up to which points on the open edges of a surface become one, as a part of the diagonal
/// of its box. Exporters leave such points at seams of textures and normals.
inline constexpr double weld_distance = 1e-6;

/// Choices of a user for a file of tetrahedra, or of triangles.
struct ReadOptions {
  Flaws flaws = Flaws::refused;
  /// name of the array of cells that numbers the regions; empty: the format's own, or an array with
  /// a usual name; "none": no regions
  std::string regions = {};
  std::vector<std::string> leave_out = {};  ///< names or numbers of regions that are left out
  SecondOrder order = SecondOrder::split;
  double weld = weld_distance;  ///< part of the diagonal, for a file of triangles; 0: points on
                                ///< open edges stay
};

/// Returns the treatment of this name, "split" or "linear"; throws an InputError for another name.
SecondOrder second_order_named(const std::string& name);

}  // namespace plica
