// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/level_data.hpp>
#include <plica/core/problem.hpp>
#include <plica/drivers/contact/attachments.hpp>
#include <plica/kernels/contact/contact_records.hpp>
#include <plica/kernels/contact/obstacle_pose.hpp>
#include <plica/kernels/reduce.hpp>
#include <vector>

namespace plica {

/// Obstacle of one shape, which launches the kernels for that shape.
template <class B>
class Obstacle {
 public:
  using Exec = typename B::Exec;
  virtual ~Obstacle() = default;
  /// Fills this obstacle's slots of the records: one a point, and one a triangle if `faces`.
  /// The obstacle's pose is that at `time` [s], its way that of the records' span. `number`: index
  /// of this obstacle.
  virtual void find(const Exec&, const EmbeddedSurface<B>&, const State<B>&, double time,
                    int number, bool faces, const ContactRecords<B>&) const = 0;
  /// Grasps the points at most `reach` [m] outside the obstacle, except points left out.
  virtual void grasp(const Exec&, const EmbeddedSurface<B>&, const State<B>&, double time,
                     int number, double reach, const ContactRecords<B>&) const = 0;
  /// Returns the obstacle's pose at `time` [s], with the mean velocity of the next `ahead` [s].
  virtual ObstacleMotion<B> place(double time, double ahead) const = 0;
  /// Replaces the motion, and set_turn() the turn, for all later calls.
  virtual void set_motion(const Motion& motion) = 0;
  virtual void set_turn(const std::optional<Turn>& turn) = 0;
  /// Updates a tool with mass at the end of a macro step of `span` [s] that ends at `end` [s].
  /// `wrench` is on the body [6 obstacles] N and N m; its opposite acts on the tool. Does nothing
  /// for an obstacle without mass. See MoveTool.
  virtual void move(const Exec&, const Doubles<B>& wrench, int number, double end,
                    double span) const = 0;
  /// Returns the radius of the largest ball inside the shape [m].
  virtual double radius() const = 0;
  /// Returns true where the shape has no hollows.
  virtual bool convex() const = 0;
  /// Returns the size of the shape's own device memory [bytes].
  virtual std::size_t bytes() const = 0;
};

/// Returns an obstacle that launches the kernels of the shape that the options name.
/// `memory`: see Contact::memory(). `number`: index of this obstacle. `longest`: longest edge of
/// the surface [m].
template <class B>
std::unique_ptr<Obstacle<B>> make_obstacle(const ObstacleOptions& options,
                                           const DepthWatch<B>& watch, const Doubles<B>& memory,
                                           int number, double longest);

/// Surface that contact acts on, and the bodies that it belongs to.
struct TouchingSurface {
  /// One of several bodies, or the only body.
  struct Part {
    const MaterialOptions* material;
    double edge = 0;  ///< mean edge of the body's finest level [m]
  };
  const TriangleSurface& surface;  ///< placed
  std::vector<Part> parts;
  std::vector<int> body;                ///< [points] index into parts; empty: there is one part
  std::vector<AttachedPoint> attached;  ///< points attached to another of the bodies
  /// [obstacles] points that each obstacle may grasp; an empty list: all points
  std::vector<std::vector<int>> held;
  double edge = 0;  ///< mean edge of all bodies [m]
  double size = 0;  ///< size of the whole surface [m]; a point deeper in an obstacle is lost
};

/// Contact of the body's surface with all obstacles and with itself: the part that all levels
/// share.
template <class B>
class Contact {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;

  /// Makes contact with the law that ContactOptions describes. `pairs`: the surface may touch
  /// itself.
  Contact(const ContactOptions& options, const TouchingSurface& surface, bool pairs);

  /// Returns empty records for one level of `vertices` vertices.
  ContactRecords<B> make_records(const EmbeddedSurface<B>& surface, int vertices,
                                 bool implicit) const;
  /// Fills the records' slots of all obstacles at a state, for a step of the records' span.
  void find(const Exec&, const LevelData<B>&, const State<B>&, double time,
            const ContactRecords<B>&) const;

  /// Returns a surface point that is lost, found since the last call; -1: none. Waits.
  /// A point is lost that is deeper in an obstacle than deepest(), or whose depth is not a number.
  /// On one of several ranks: found by this one.
  int take_lost(const Exec&) const;
  double deepest() const { return deepest_; }  ///< largest depth of a point that is not lost [m]

  /// Returns the normal stiffness of contact at a point of the first body [N/m].
  double stiffness() const { return stiffness_; }
  /// Returns the normal damping of contact at a point of the first body [N s/m].
  double damping() const { return damping_; }
  int points() const { return points_; }
  int whole() const;  ///< number of obstacles that also touch triangles between their corners
  /// Returns true where a record may couple vertices of several tetrahedra.
  /// Assembled matrices have no blocks for these.
  bool couples() const { return pairs_ || whole() > 0; }
  int attached() const { return attached_count_; }  ///< points that are attached to another body
  const Attachments<B>& attached_points() const { return attached_; }
  int obstacles() const { return static_cast<int>(obstacles_.size()); }
  ObstacleMotion<B> place(int obstacle, double time, double ahead = 0) const {
    return obstacles_[static_cast<std::size_t>(obstacle)]->place(time, ahead);
  }
  /// Replaces the motion of an obstacle; work that is enqueued already keeps the earlier motion.
  void set_motion(int obstacle, const Motion& motion) const {
    obstacles_[static_cast<std::size_t>(obstacle)]->set_motion(motion);
  }
  void set_turn(int obstacle, const std::optional<Turn>& turn) const {
    obstacles_[static_cast<std::size_t>(obstacle)]->set_turn(turn);
  }
  /// Returns the values that contact carries from one step to the next; empty: there are none.
  /// In this order: poses of tools with mass (see ObstaclePose), grasped points (see Grasps), torn
  /// points (see Attachments).
  const Doubles<B>& memory() const { return memory_; }
  /// Takes the memory of contact with the same obstacles, whose surface has the first of these
  /// points. `former`: point there of each further one, which is grasped as that one is; -1: none.
  void take_memory(const Exec&, const Contact& before, const std::vector<int>& former) const;
  /// Grasps the points near an obstacle in the state of level 0, whose records these are.
  void grasp(const Exec&, const LevelData<B>&, double time, int obstacle,
             const ContactRecords<B>&) const;
  void release(const Exec&, int obstacle) const;
  const std::optional<GraspOptions>& grasp_options(int obstacle) const {
    return options_[static_cast<std::size_t>(obstacle)];
  }
  /// Returns the points that an obstacle has grasped. Waits.
  std::vector<int> held_by(const Exec&, int obstacle) const;
  /// Returns the number of points whose attachments are torn. Waits.
  int torn(const Exec&) const;
  /// Updates all tools with mass at the end of a macro step, see Obstacle::move().
  void move_tools(const Exec&, const Doubles<B>& wrench, double end, double span) const;
  std::size_t grid_bytes() const;  ///< memory of sampled distances [bytes]
  const PairLimits<Real>& limits() const { return limits_; }
  int touching_bodies() const { return pairs_ && bodies_ > 1 ? bodies_ : 0; }
  bool has_pairs() const { return pairs_; }
  bool rubs() const { return rubs_; }  ///< true where there is friction
  int wrenches() const { return obstacles() + touching_bodies(); }

 private:
  int points_, attached_count_, bodies_;
  bool pairs_, rubs_;
  double stiffness_ = 0, damping_ = 0, reach_, deepest_;
  Indices<B> lost_;  ///< [1] last lost point + 1, see DepthWatch
  typename ContactRecords<B>::Laws laws_;
  std::vector<int> body_;  ///< [points] body of each; empty: there is one
  Doubles<B> memory_;
  Grasps<B> grasps_;
  Attachments<B> attached_;
  std::vector<std::optional<GraspOptions>> options_;  ///< [obstacles] empty: it cannot grasp
  std::vector<std::unique_ptr<Obstacle<B>>> obstacles_;
  std::vector<bool> whole_;  ///< [obstacles] true: it also touches triangles between corners
  SurfaceMesh<B> mesh_;
  PairLimits<Real> limits_;

  Indices<B> bodies_of(const EmbeddedSurface<B>& surface) const;
  void make_laws(const ContactOptions& options, const TouchingSurface& surface);
  void attach(const TouchingSurface& surface);
  void make_memory(const ContactOptions& options);
  void choose_held(const std::vector<std::vector<int>>& chosen);
  void choose_whole(const std::string& rule, const TriangleSurface& surface);
  void connect(const TriangleSurface& surface);
  void connect_edges(const TriangleSurface& surface);
};

}  // namespace plica
