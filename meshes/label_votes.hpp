// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/meshes/label_image.hpp>
#include <utility>
#include <vector>

namespace plica {

/// The place of a point beside the interface of two labels.
struct BesideInterface {
  int inside = 0;                 ///< label that the point is in
  int other = 0;                  ///< label across the interface
  double distance = 0;            ///< distance of the point to the interface
  Point normal = Point::UnitX();  ///< unit vector from the interface into `inside`
};

/// Labels of an image in balls around points. Balls that are wider than a voxel see a smooth
/// interface where voxels make steps. The image must outlive this.
class LabelVotes {
 public:
  /// @param radius  radius of the balls, above 0
  LabelVotes(const LabelImage& image, double radius);

  /// Returns the label of the voxel at a point; 0 beyond the image.
  int at(const Point& x) const;
  /// Returns the label with the largest part of the ball at a point; of equal ones the lowest.
  int most(const Point& x) const;
  /// Returns by how much of the ball at a point label `a` has more than label `b`, in -1 to 1.
  double margin(const Point& x, int a, int b) const;
  /// Returns where a point is beside the interface of the two of these labels that have the largest
  /// parts of its ball; nothing where the ball has fewer than two of them.
  ///
  /// The interface is taken as a plane. At the distance t r from a plane, a ball of radius r has
  /// the part 1/2 + 3 t / 4 - t^3 / 4 on its own side, which gives t = 2 sin(asin(2 part - 1) / 3).
  std::optional<BesideInterface> beside(const Point& x, const std::vector<int>& labels) const;

 private:
  std::vector<std::pair<int, int>> votes(const Point& x) const;

  const LabelImage& image_;
  double radius_;
  Eigen::Matrix3d to_voxels_;
  std::vector<Point> offsets_;  // from the centre of a ball to points in it
};

}  // namespace plica
