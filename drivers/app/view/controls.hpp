// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Pull of the user: the grasped point of the body and its target.
struct Pull {
  Point at = Point::Zero();      ///< grasped point on the body at rest [m]
  Point target = Point::Zero();  ///< position to pull the point to [m]
};

/// Ball that the user moves.
struct BallTool {
  Point centre = Point::Zero();  ///< centre [m]
  double radius = 0;             ///< radius [m]
};

/// Target of an obstacle of the scene that the user moves.
struct ObstacleAim {
  int obstacle = 0;                    ///< number of the obstacle, from 0
  Point displacement = Point::Zero();  ///< displacement from the place in its shape's options [m]
};

/// Settings that a user of the live view can change while the scene runs.
struct Controls {
  bool running = true;             ///< false: the simulation is paused
  int restarts = 0;                ///< number of restarts that the user has asked for
  double speed = 1;                ///< maximum simulated seconds per second
  double gravity = 0;              ///< gravity along the scene's, or down if it has none [m/s^2]
  double stiffness = 0;            ///< stiffness of the spring that pulls [N/m]
  std::string colour;              ///< "", displacement, speed, von_mises or J
  std::optional<Pull> pull;        ///< none: the body is released
  std::optional<BallTool> tool;    ///< none: there is no ball
  std::vector<ObstacleAim> moved;  ///< targets of obstacles; all others move as in the scene
};

/// Reads the controls from the page's message in JSON. Throws InputError that names the wrong
/// member and what was expected.
Controls controls_of(const std::string& text);

}  // namespace plica::app
