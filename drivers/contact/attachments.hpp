// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/core/problem.hpp>
#include <vector>

namespace plica {

/// Point of the surface that is attached to a place on one of the surface's triangles.
struct AttachedPoint {
  /// number of the point in the surface, of the attachment in the options, of the triangle
  int point, attachment, triangle;
  std::array<double, 3> weight;  ///< barycentric weights of the triangle's corners
};

/// Returns the points of all attachments, found where the placed surface starts.
/// Throws InputError where an attachment has no point, with the distance of the nearest one [m],
/// and where two attachments have the same point.
std::vector<AttachedPoint> attached_points(const std::vector<AttachmentOptions>& attachments,
                                           const TriangleSurface& surface,
                                           const std::vector<BodyPart>& parts);

}  // namespace plica
