// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/problem.hpp>
#include <vector>

namespace plica {

/// A point of the surface, and the place on a triangle of it that it is attached to.
struct AttachedPoint {
  int point, attachment, triangle;
  std::array<double, 3> weight;  ///< of the triangle's corners
};

/// The points of all attachments, where the placed surface starts. InputError where one holds no
/// point, with the distance of the nearest, and where two hold one point.
std::vector<AttachedPoint> attached_points(const std::vector<AttachmentOptions>& attachments,
                                           const TriangleSurface& surface,
                                           const std::vector<BodyPart>& parts);

}  // namespace plica
