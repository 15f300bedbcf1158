// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/selection.hpp>
#include <variant>
#include <vector>

/// Forces from outside: those that keep their size and direction whatever the body does (dead
/// loads), and pressures that follow it.
namespace plica {

/// On the boundary triangles at rest all of whose vertices are chosen.
struct Traction {
  Point value = Point::Zero();  ///< [Pa]
};

/// On the chosen vertices together, each in proportion to its mass.
struct TotalForce {
  Point value = Point::Zero();  ///< [N]
};

/// On the boundary triangles all of whose vertices are chosen, against their sides as they are now:
/// it turns and grows with them.
struct FollowerPressure {
  double value = 0;  ///< [Pa]; above 0 it pushes into the body
};

/// On the same triangles, the pressure of a fluid that fills what they enclose on their outer side:
/// K (V given - V now) / V at rest. The volume given goes from that at rest, where the course is 0,
/// to `ratio` times that, where it is 1.
struct EnclosedVolume {
  double ratio = 1;         ///< above 0
  double bulk_modulus = 0;  ///< K [Pa]
};

/// 1 at all times.
struct ConstantCourse {};

/// From 0 to 1 over the duration, smoothly: (1 - cos(pi t / duration)) / 2.
struct RampCourse {
  double duration = 1;  ///< [s]
};

/// Straight from one factor to the next; the first holds before it, the last after it.
struct PolygonCourse {
  /// A factor at a time.
  struct Knot {
    double time = 0;    ///< [s], each after the one before
    double factor = 1;  ///< of the load
  };
  std::vector<Knot> knots;  ///< at least one
};

/// sin(2 pi frequency t + phase)
struct SineCourse {
  double frequency = 1;  ///< [1/s]
  double phase = 0;      ///< [rad]
};

/// A load's factor over time.
using LoadCourse = std::variant<ConstantCourse, RampCourse, PolygonCourse, SineCourse>;

/// What a load has that gives a volume.
struct CavityState {
  int load = 0;         ///< of the body's loads
  double volume = 0;    ///< [m^3]
  double pressure = 0;  ///< [Pa]
};

/// A load on a part of the body.
struct LoadOptions {
  Selection where;                                                            ///< of vertices
  std::variant<Traction, TotalForce, FollowerPressure, EnclosedVolume> load;  ///< what acts on them
  LoadCourse course;                                                          ///< times this factor
};

}  // namespace plica
