// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/level.hpp>
#include <plica/core/problem.hpp>
#include <plica/drivers/contact/attachments.hpp>
#include <plica/kernels/contact/contact_records.hpp>
#include <plica/kernels/contact/obstacle_place.hpp>
#include <plica/kernels/reduce.hpp>
#include <vector>

namespace plica {

/// One obstacle: launches the kernels of its shape.
template <class B>
class Obstacle {
 public:
  using Exec = typename B::Exec;
  virtual ~Obstacle() = default;
  /// Its slots of every point of a state, where it is now, and of the triangles if `faces`; with
  /// the way that it goes in the records' step. `number`: which of the obstacles it is.
  virtual void find(const Exec&, const EmbeddedSurface<B>&, const State<B>&, double time,
                    int number, bool faces, const ContactRecords<B>&) const = 0;
  /// Takes hold of what is no further than `reach` [m] from it.
  virtual void grasp(const Exec&, const EmbeddedSurface<B>&, const State<B>&, double time,
                     int number, double reach, const ContactRecords<B>&) const = 0;
  virtual ObstaclePlace<B> place(double time, double ahead) const = 0;
  /// From now on it moves so.
  virtual void set_motion(const Motion& motion) = 0;
  virtual void set_turn(const std::optional<Turn>& turn) = 0;
  /// One with mass takes a macro step that ends at `end`, pushed by the opposite of its wrench.
  virtual void move(const Exec&, const Doubles<B>& wrench, int number, double end,
                    double span) const = 0;
  /// Of the largest ball in it [m].
  virtual double radius() const = 0;
  /// Whether it has no hollows.
  virtual bool convex() const = 0;
  /// Device memory of its own.
  virtual std::size_t bytes() const = 0;
};

/// Launches the kernels of the shape that the options name. `memory`: see Contact::memory(); this
/// is number `number`. `longest` edge of the surface [m].
template <class B>
std::unique_ptr<Obstacle<B>> make_obstacle(const ObstacleOptions& options,
                                           const DepthWatch<B>& watch, const Doubles<B>& memory,
                                           int number, double longest);

/// What contact needs to know of the surface, and of the bodies that it belongs to.
struct TouchingSurface {
  /// One of them, or all there is.
  struct Part {
    const MaterialOptions* material;
    double edge = 0;  ///< mean, of the finest level [m]
  };
  const TriangleSurface& surface;  ///< placed
  std::vector<Part> parts;
  std::vector<int> body;                ///< of each point its part; empty: there is one
  std::vector<AttachedPoint> attached;  ///< to another of its bodies
  /// of each obstacle the points that it may hold; empty: all
  std::vector<std::vector<int>> held;
  double edge = 0;  ///< mean, of all [m]
  double size = 0;  ///< of the whole: a point deeper than that is lost [m]
};

/// Contact of the body's surface with all obstacles, and with itself: what all levels share of it.
template <class B>
class Contact {
 public:
  using Exec = typename B::Exec;
  using Real = typename B::Real;

  /// See ContactOptions for the law. `pairs`: the surface touches itself.
  Contact(const ContactOptions& options, const TouchingSurface& surface, bool pairs);

  /// Records of one level.
  ContactRecords<B> make_records(const EmbeddedSurface<B>& surface, int vertices,
                                 bool implicit) const;
  /// The slots of obstacles at a state, for the records' step.
  void find(const Exec&, const Level<B>&, const State<B>&, double time,
            const ContactRecords<B>&) const;

  /// A surface point that since the last call was found deeper in an obstacle than deepest(), or
  /// nowhere; -1: none. Waits.
  int take_lost(const Exec&) const;
  double deepest() const { return deepest_; }  ///< [m]

  double stiffness() const { return stiffness_; }  ///< of a point of the first body [N/m]
  double damping() const { return damping_; }      ///< along the normal, likewise [N s/m]
  int points() const { return points_; }
  int whole() const;  ///< obstacles that touch the surface between its points
  /// It couples vertices of several tetrahedra, for which assembled matrices have no room.
  bool couples() const { return pairs_ || whole() > 0; }
  int attached() const { return attached_count_; }  ///< points that are attached to another body
  const Attachments<B>& attached_points() const { return attached_; }
  int obstacles() const { return static_cast<int>(obstacles_.size()); }
  ObstaclePlace<B> place(int obstacle, double time, double ahead = 0) const {
    return obstacles_[static_cast<std::size_t>(obstacle)]->place(time, ahead);
  }
  /// From now on this obstacle moves so; work that is enqueued already has the motion it had.
  void set_motion(int obstacle, const Motion& motion) const {
    obstacles_[static_cast<std::size_t>(obstacle)]->set_motion(motion);
  }
  void set_turn(int obstacle, const std::optional<Turn>& turn) const {
    obstacles_[static_cast<std::size_t>(obstacle)]->set_turn(turn);
  }
  /// What obstacles carry from one step to the next: where those with mass are, see ObstaclePlace,
  /// then what they hold, see Grasps, then what is torn, see Attachments; empty where there is none
  /// of it.
  const Doubles<B>& memory() const { return memory_; }
  /// The obstacle takes hold of what is near it in a state of level 0, whose records these are.
  void grasp(const Exec&, const Level<B>&, double time, int obstacle,
             const ContactRecords<B>&) const;
  void release(const Exec&, int obstacle) const;
  const std::optional<GraspOptions>& grasp_options(int obstacle) const {
    return options_[static_cast<std::size_t>(obstacle)];
  }
  /// The points that it holds. Waits.
  std::vector<int> held_by(const Exec&, int obstacle) const;
  /// Points whose attachments are torn. Waits.
  int torn(const Exec&) const;
  /// Tools with mass take a macro step that ends at `end`.
  void move_tools(const Exec&, const Doubles<B>& wrench, double end, double span) const;
  std::size_t grid_bytes() const;  ///< of sampled distances
  const PairLimits<Real>& limits() const { return limits_; }
  int touching_bodies() const { return pairs_ && bodies_ > 1 ? bodies_ : 0; }
  bool has_pairs() const { return pairs_; }
  bool rubs() const { return rubs_; }  ///< there is friction
  int wrenches() const { return obstacles() + touching_bodies(); }

 private:
  int points_, attached_count_, bodies_;
  bool pairs_, rubs_;
  double stiffness_ = 0, damping_ = 0, reach_, deepest_;
  Indices<B> lost_;  ///< [1] see DepthWatch
  typename ContactRecords<B>::Laws laws_;
  Indices<B> body_;
  Doubles<B> memory_;
  Grasps<B> grasps_;
  Attachments<B> attached_;
  std::vector<std::optional<GraspOptions>> options_;  ///< of obstacles that can hold
  std::vector<std::unique_ptr<Obstacle<B>>> obstacles_;
  std::vector<bool> whole_;  ///< of obstacles: they touch the surface between its points
  SurfaceMesh<B> mesh_;
  PairLimits<Real> limits_;

  void make_laws(const ContactOptions& options, const TouchingSurface& surface);
  void attach(const TouchingSurface& surface);
  void make_memory(const ContactOptions& options);
  void choose_held(const std::vector<std::vector<int>>& chosen);
  void choose_whole(const std::string& rule, const TriangleSurface& surface);
  void connect(const TriangleSurface& surface);
  void connect_edges(const TriangleSurface& surface);
};

}  // namespace plica
