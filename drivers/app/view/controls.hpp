// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Where the body is held, and where to.
struct Pull {
  Point at = Point::Zero();      ///< on the body as it rests [m]
  Point target = Point::Zero();  ///< [m]
};

/// A ball that one moves about.
struct BallTool {
  Point centre = Point::Zero();  ///< [m]
  double radius = 0;             ///< [m]
};

/// Where an obstacle of the scene is asked to be.
struct ObstacleAim {
  int obstacle = 0;                    ///< counts from 0
  Point displacement = Point::Zero();  ///< from where its shape says [m]
};

/// What the page of a live view may change while the scene runs.
struct Controls {
  bool running = true;
  int restarts = 0;          ///< so many times the start was asked for
  double speed = 1;          ///< simulated seconds per second, at most
  double gravity = 0;        ///< along the scene's own, or down where it has none [m/s^2]
  double stiffness = 0;      ///< of the spring that pulls [N/m]
  std::string colour;        ///< "", displacement, speed, von_mises or J
  std::optional<Pull> pull;  ///< none: it is let go
  std::optional<BallTool> tool;
  std::vector<ObstacleAim> moved;  ///< the others move as the scene says
};

/// From the page's message, in JSON. InputError that says which member is not as it should be, and
/// what was expected.
Controls controls_of(const std::string& text);

}  // namespace plica::app
