// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/motion.hpp>
#include <variant>

/// Rigid solids that a body's surface can touch.
namespace plica {

/// The half-space below a plane is solid.
struct PlaneOptions {
  Point point = Point::Zero();    ///< on the plane [m]
  Point normal = Point::UnitZ();  ///< out of the solid; any length > 0
};

/// A solid sphere.
struct SphereOptions {
  Point centre = Point::Zero();  ///< [m]
  double radius = 1;             ///< [m] > 0
};

/// A block with flat top out of which a sphere is hollowed: the inside of a spherical shell, up to its rim.
struct BowlOptions {
  Point centre = Point::Zero();  ///< of the sphere [m]
  double radius = 1;             ///< [m] > 0
  double rim = 0;  ///< height of the flat top above the bowl's lowest point [m], in (0, radius]; 0: radius
};

/// All points within the radius of the straight line between two points, its ends round.
struct CapsuleOptions {
  Point from = Point::Zero();  ///< [m]
  Point to = Point::UnitZ();   ///< [m], another point
  double radius = 1;           ///< [m] > 0
};

/// A solid box.
struct BlockOptions {
  Point centre = Point::Zero();    ///< [m]
  Point size = Point::Ones();      ///< edges [m] > 0
  Point rotation = Point::Zero();  ///< about the centre: its direction is the axis, its length the angle [rad]
};

/// A solid cylinder with flat ends.
struct CylinderOptions {
  Point from = Point::Zero();  ///< centre of one end [m]
  Point to = Point::UnitZ();   ///< of the other [m], another point
  double radius = 1;           ///< [m] > 0
};

/// The inside of a closed surface, by its signed distance on a regular grid.
struct SurfaceOptions {
  TriangleSurface surface;  ///< closed, every triangle counter-clockwise seen from outside
  int cells = 0;            ///< of the grid along the surface's longest extent, 4 to 512; 0: chosen from its shape
};

/// A shape, how rough it is and how it moves.
struct ObstacleOptions {
  std::variant<PlaneOptions, SphereOptions, BowlOptions, CapsuleOptions, BlockOptions, CylinderOptions, SurfaceOptions>
      shape;                       ///< at t = 0
  std::optional<double> friction;  ///< Coulomb's coefficient >= 0; none: frictionless
  Motion motion;                   ///< from where the shape says
};

}  // namespace plica
