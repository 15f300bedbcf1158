// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/selection.hpp>
#include <variant>
#include <vector>

/// Forces from outside. Dead loads keep their size and direction whatever the body does; pressures
/// follow the body.
namespace plica {

/// Force per area at rest, on the chosen boundary triangles: those of a group of triangles, else
/// those with all their vertices chosen.
struct Traction {
  Point value = Point::Zero();  ///< [Pa]
};

/// Force on the chosen vertices together, on each in proportion to its mass.
struct TotalForce {
  Point value = Point::Zero();  ///< [N]
};

/// Pressure on the boundary triangles chosen as for a traction. It acts against their current
/// sides: it turns and grows with them.
struct FollowerPressure {
  double value = 0;  ///< [Pa]; above 0 it pushes into the body
};

/// Pressure of a fluid in a cavity: K (volume given - current volume) / volume at rest. The fluid
/// fills what the boundary triangles, chosen as for a traction, enclose on their outer side.
/// The volume given goes from that at rest, where the time function is 0, to `ratio` times that,
/// where it is 1.
struct EnclosedVolume {
  double ratio = 1;         ///< volume given over that at rest, above 0
  double bulk_modulus = 0;  ///< K of the fluid [Pa]
};

/// Time function that is 1 at all times.
struct ConstantCourse {};

/// Time function that rises smoothly from 0 to 1 over the duration: (1 - cos(pi t / duration)) / 2.
struct RampCourse {
  double duration = 1;  ///< [s]
};

/// Time function that is linear between given factors. Before the first knot it has the first
/// factor, after the last knot the last.
struct PolygonCourse {
  /// A factor at a time.
  struct Knot {
    double time = 0;    ///< [s], each after the one before
    double factor = 1;  ///< factor of the load
  };
  std::vector<Knot> knots;  ///< at least one
};

/// Time function sin(2 pi frequency t + phase).
struct SineCourse {
  double frequency = 1;  ///< [1/s]
  double phase = 0;      ///< [rad]
};

/// Time function by which a load is multiplied.
using LoadCourse = std::variant<ConstantCourse, RampCourse, PolygonCourse, SineCourse>;

/// Volume and pressure of the cavity of a load that gives the volume.
struct CavityState {
  int load = 0;         ///< number among the body's loads
  double volume = 0;    ///< [m^3]
  double pressure = 0;  ///< [Pa]
};

/// A load on a part of the body.
struct LoadOptions {
  Selection where;  ///< chosen vertices
  /// Load on the chosen vertices
  std::variant<Traction, TotalForce, FollowerPressure, EnclosedVolume> load;
  LoadCourse course;  ///< factor of the load over time
  /// True: tractions and pressures also act on faces that cuts open, where their vertices are
  /// chosen
  bool on_cuts = false;
};

}  // namespace plica
