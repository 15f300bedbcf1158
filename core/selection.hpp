// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <string>
#include <variant>

/// Parts of a body, chosen at rest and before it is placed, anew on every level: vertices, or the
/// elements whose centroid is there. Choosing nothing on a level is an error.
namespace plica {

/// What lies in a ball.
struct BallSelection {
  Point centre = Point::Zero();  ///< [m]
  double radius = 1;             ///< its surface included [m]
};

/// What lies on the plane or below it: on the side its normal points away from.
struct HalfSpaceSelection {
  Point point = Point::Zero();    ///< on the plane [m]
  Point normal = Point::UnitZ();  ///< its length does not matter
};

/// The mesh's vertex set of that name or, where there is none, its region.
struct GroupSelection {
  std::string name;  ///< as the mesh has it
};

/// A region of the mesh or of the options.
struct RegionSelection {
  std::string name;  ///< as they have it
};

/// The one nearest to a point; of several the one with the lowest number.
struct NearestSelection {
  Point to = Point::Zero();  ///< [m]
};

/// Any of them.
using Selection = std::variant<Box, BallSelection, HalfSpaceSelection, GroupSelection,
                               RegionSelection, NearestSelection>;

}  // namespace plica
