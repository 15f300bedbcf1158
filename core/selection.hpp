// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>
#include <string>
#include <variant>

/// Parts of a body, chosen at rest and before it is placed, anew on every level. They are vertices,
/// or the elements whose centroid is there; what is outside by a millionth of the body's size at
/// most counts as inside. Choosing nothing on a level is an error.
namespace plica {

/// Selection of what lies in a ball.
struct BallSelection {
  Point centre = Point::Zero();  ///< [m]
  double radius = 1;             ///< radius, surface included [m]
};

/// Selection of what lies on a plane or below it: on the side that its normal points away from.
struct HalfSpaceSelection {
  Point point = Point::Zero();    ///< point on the plane [m]
  Point normal = Point::UnitZ();  ///< normal; its length does not matter
};

/// Selection by name: the mesh's vertex set or, where there is none, its region.
struct GroupSelection {
  std::string name;  ///< name in the mesh
};

/// Selection of a region of the mesh or of the options.
struct RegionSelection {
  std::string name;  ///< name in the mesh or the options
};

/// Selection of the one nearest to a point; of several the one with the lowest number.
struct NearestSelection {
  Point to = Point::Zero();  ///< [m]
};

/// Selection of any kind.
using Selection = std::variant<Box, BallSelection, HalfSpaceSelection, GroupSelection,
                               RegionSelection, NearestSelection>;

}  // namespace plica
