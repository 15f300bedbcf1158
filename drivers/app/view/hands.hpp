// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/app/view/controls.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <vector>

namespace plica::app {

/// What somebody at the page of a live view does to the body, as forces on the vertices of every
/// level: the spring that pulls, the ball that pushes, and gravity's change.
template <class B>
class Hands {
 public:
  /// `size` of the body [m].
  Hands(const Scene& scene, const Simulation<B>& simulation, double size);

  /// The state of the controls during the next macro step, from this time [s] on. Hands follow the
  /// controls at a bounded speed.
  void hold(const Controls& controls, double time);
  /// After that step.
  void advance();
  /// After a step that the body did not bear and that was taken back: pulls half as strongly, and
  /// comes back to all of it in time. Whether that may help: false where nothing pulls, or hardly.
  bool give_way();
  /// Adds the forces, on the host.
  void operator()(const ForceRequest<B>& request);

  /// its force on the body, in the last state of level 0 [N]
  const Point& pull() const { return pull_; }
  const Point& push() const { return push_; }                    ///< likewise the ball's
  const std::optional<BallTool>& tool() const { return tool_; }  ///< where it is

 private:
  struct LevelParts {
    std::vector<double> mass;  // per vertex [kg]
    double edge = 0;           // mean [m]
    double step = 0;           // the longest that explicit sub-steps take [s]
    double critical = 0;       // cycle him: of the level by itself [s]
    // The vertices that are held
    long grip = 0;
    std::vector<std::size_t> held;
    std::vector<double> weight;  // of each, 1 together
    std::vector<Point> offset;   // from the place that is held [m]
  };
  // A place that follows the controls
  struct Follower {
    Point place = Point::Zero(), velocity = Point::Zero();
    void aim(const Point& goal, double reach, double step);
  };

  void take_hold(LevelParts& level, const ForceRequest<B>& request);
  void add_pull(LevelParts& level, const ForceRequest<B>& request);
  // How much of a pull the body bears, 0 to 1
  double bearing(const ForceRequest<B>& request) const;
  void add_push(const LevelParts& level, const ForceRequest<B>& request);
  // That explicit steps bear on a vertex, where a patch of this radius is pushed
  double most_stiffness(const LevelParts& level, const ForceRequest<B>& request, std::size_t vertex,
                        double radius) const;
  double since_start(const ForceRequest<B>& request) const;

  Point down_ = Point(0, 0, -1), scene_gravity_, more_gravity_ = Point::Zero();
  double size_, young_, macro_step_;
  const TetMesh& mesh_;  // of level 0
  bool nodal_;           // its elements
  std::vector<LevelParts> levels_;
  Controls controls_;
  double start_ = 0;  // of the macro step [s]
  long grips_ = 0;
  bool placed_ = false;  // whether the hand is where it took hold
  double grip_ = 1;      // how much of it there is, see give_way()
  // what it bore when it was last looked at [s], and how long that holds
  double bears_ = 1, looked_ = 0, between_ = 0;
  Follower hand_, ball_;
  std::optional<BallTool> tool_;
  Point pull_ = Point::Zero(), push_ = Point::Zero();
};

}  // namespace plica::app
