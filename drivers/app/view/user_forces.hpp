// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/app/view/controls.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <vector>

namespace plica::app {

/// Forces of a user of the live view on the vertices of every level. They are those of a spring
/// that pulls, of a ball that pushes, and of the change of gravity.
template <class B>
class UserForces {
 public:
  /// Prepares the forces on the body of a scene; `size` is the size of the body [m].
  UserForces(const Scene& scene, const Simulation<B>& simulation, double size);

  /// Sets the controls for the next macro step, which starts at this time [s]. Hand and ball follow
  /// the controls at a bounded speed.
  void hold(const Controls& controls, double time);
  /// Moves hand and ball to their places at the end of a macro step. To be called after it.
  void advance();
  /// Halves the pull after a step that failed and was taken back. The pull grows back to its full
  /// strength over the next steps. Returns false if this cannot help: nothing pulls, or hardly.
  bool give_way();
  /// Adds the forces, on the host.
  void operator()(const ForceRequest<B>& request);

  /// Returns the force of the pull on the body, in the last state of level 0 [N].
  const Point& pull() const { return pull_; }
  /// Returns the force of the ball on the body, in the last state of level 0 [N].
  const Point& push() const { return push_; }
  const std::optional<BallTool>& tool() const { return tool_; }  ///< the ball at its present place

 private:
  struct LevelParts {
    std::vector<double> mass;  // mass of each vertex [kg]
    double edge = 0;           // mean edge length [m]
    double step = 0;           // length of the level's sub-steps [s]
    double critical = 0;       // cycle him: critical step of the level by itself [s]; else 0
    // Grasped vertices
    long grip = 0;                  // number of the grasp that they belong to
    std::vector<std::size_t> held;  // numbers of the vertices
    std::vector<double> weight;     // weight of each vertex; their sum is 1
    std::vector<Point> offset;      // position relative to the middle of the patch [m]
  };
  // Point that follows the controls
  struct Follower {
    Point place = Point::Zero(), velocity = Point::Zero();
    void aim(const Point& goal, double reach, double step);
  };

  void take_hold(LevelParts& level, const ForceRequest<B>& request);
  void add_pull(LevelParts& level, const ForceRequest<B>& request);
  // Returns which part of a pull the body bears, from 0 to 1
  double bearing(const ForceRequest<B>& request) const;
  void add_push(const LevelParts& level, const ForceRequest<B>& request);
  // Returns the stiffness m / h^2 of a vertex [N/m], in a patch of this radius [m]. The limits of
  // explicit steps are relative to it
  double most_stiffness(const LevelParts& level, const ForceRequest<B>& request, std::size_t vertex,
                        double radius) const;
  double since_start(const ForceRequest<B>& request) const;

  Point down_ = Point(0, 0, -1), scene_gravity_, more_gravity_ = Point::Zero();
  double size_, young_, macro_step_;
  const TetMesh& mesh_;  // mesh of level 0
  bool nodal_;           // true: level 0 has nodal elements
  std::vector<LevelParts> levels_;
  Controls controls_;
  double start_ = 0;     // start of the macro step [s]
  long grips_ = 0;       // number of grasps so far
  bool placed_ = false;  // true: the hand has its place for the present grasp
  double grip_ = 1;      // part of the pull that acts, see give_way()
  // result of bearing() and the time when it was computed, and how long it is used [s]
  double bears_ = 1, looked_ = 0, between_ = 0;
  Follower hand_, ball_;
  std::optional<BallTool> tool_;
  Point pull_ = Point::Zero(), push_ = Point::Zero();
};

}  // namespace plica::app
