// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <plica/core/text.hpp>
#include <plica/core/time_functions.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/cycles/hierarchy.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/kernels/reduce.hpp>
#include <string>
#include <vector>

// Check whether a body has more energy than was put into it.
namespace plica {

/// Compares energies during a run with those at its start. They include gravity and contact; the
/// work of obstacles is an argument.
class EnergyBudget {
 public:
  static constexpr double notable = 0.1;  ///< part of the energy put in: discrete ones oscillate

  /// Starts a budget. `rounding`: how far energies oscillate where nothing was put in [J].
  explicit EnergyBudget(double rounding = 0) : put_in_(rounding) {}
  template <class B>
  EnergyBudget(const Simulation<B>& simulation, const Problem& problem)
      : EnergyBudget(10 * static_cast<double>(std::numeric_limits<typename B::Real>::epsilon()) *
                     p_wave_modulus(problem.body.material) * simulation.levels()[0].mass /
                     problem.body.material.density) {}

  /// Returns whether nothing but gravity and obstacles does work, and the elastic energy is
  /// complete.
  static bool knows(const Problem& problem) {
    return problem.body.loads.empty() && problem.body.prescribed.empty() &&
           !is_viscous(problem.body);
  }

  /// Compares the energies at this time [s], after obstacles have done this work on the body [J].
  void look(double time, const Energies& e, double work = 0) {
    if (!looked_) start_ = e.total(), looked_ = true;
    put_in_ = std::max(put_in_, start_ + work - e.potential);
    const double surplus = e.total() - start_ - work;
    if (surplus > surplus_) surplus_ = surplus, at_ = time;
  }

  /// Returns the numbers from which restore() continues.
  std::vector<double> save() const { return {looked_ ? 1.0 : 0.0, start_, put_in_, surplus_, at_}; }
  /// Continues from saved numbers. Throws InputError for another number of them.
  void restore(const std::vector<double>& saved) {
    expect_saved("the energy budget", saved.size(), 5);
    looked_ = saved[0] > 0, start_ = saved[1], put_in_ = std::max(put_in_, saved[2]),
    surplus_ = saved[3], at_ = saved[4];
  }

  /// Returns the largest surplus of energy, over the maximum that was ever put in. That is the
  /// maximum of the whole run, since at a first touch next to nothing has been put in.
  double growth() const { return put_in_ > 0 ? surplus_ / put_in_ : 0; }
  double at() const { return at_; }  ///< time of the largest surplus [s]

  /// Returns a sentence where the growth is notable, else an empty one.
  std::string warning() const {
    if (!(growth() > notable)) return {};
    return text("energy: at ", number(at_, 4), " s the body had ", number(surplus_, 3),
                " J that nobody put in, ", number(growth(), 3),
                " of all that was put in: its motion from there on is not to be trusted; expected "
                "a shorter "
                "integration.macro_step, integration.on_failure, or cycle: single with integrator: "
                "symplectic_euler");
  }

 private:
  bool looked_ = false;
  double start_ = 0, put_in_, surplus_ = 0, at_ = 0;
};

/// Returns from a simulation's counters how often its stepper has cut its own steps.
inline long cuts_of(const std::map<std::string, long>& counters) {
  long cuts = 0;
  for (const char* name : {"inertia_refits", "substep_halvings"})
    if (const auto found = counters.find(name); found != counters.end()) cuts += found->second;
  return cuts;
}

/// Work that moving obstacles have done on a body [J], added up over its macro steps.
template <class B>
class ObstacleWork {
 public:
  ObstacleWork(const Simulation<B>& simulation, const Problem& problem) {
    const auto& obstacles = problem.contact.obstacles;
    for (std::size_t o = 0; o < obstacles.size(); ++o)
      if (moves(obstacles[o]))
        moving_.push_back({o, obstacles[o].mass ? tools_++ : none, Point::Zero(), Point::Zero()});
    for (Moving& one : moving_) move(simulation, simulation.tools(), one);
  }

  /// Adds the work of the last macro step, or of the shorter one at the end of a run. To be called
  /// after every one.
  void step(const Simulation<B>& simulation) {
    if (moving_.empty()) return;
    known_ = known_ && cuts_of(simulation.counters()) == 0;
    const std::vector<Wrench> wrenches = simulation.wrenches_of_last_step();
    const std::vector<ToolState> tools = simulation.tools();
    for (Moving& one : moving_) {
      const Moving before = one;
      move(simulation, tools, one);
      const Point turned =
          rotation_vector(rotation_by(one.rotation) * rotation_by(-before.rotation));
      const Wrench& w = wrenches[one.obstacle];
      done_ += w.force.dot(one.place - before.place) + w.torque.dot(turned);
    }
  }

  void restore(double done, bool known) { done_ = done, known_ = known; }
  double done() const { return done_; }
  /// Returns whether the stepper has never cut its own steps. Macro steps are then taken again
  /// whose work was added already.
  bool known() const { return known_; }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  struct Moving {
    std::size_t obstacle, tool;  // tool: its number among those with mass
    Point place, rotation;
  };
  std::vector<Moving> moving_;
  std::size_t tools_ = 0;
  double done_ = 0;
  bool known_ = true;

  static void move(const Simulation<B>& simulation, const std::vector<ToolState>& tools,
                   Moving& one) {
    const int number = static_cast<int>(one.obstacle);
    one.place =
        one.tool == none ? simulation.obstacle_origin(number) : tools[one.tool].displacement;
    one.rotation =
        one.tool == none ? simulation.obstacle_rotation(number) : tools[one.tool].rotation;
  }
};

/// Motion of level 0 as a whole, and the speed of its fastest vertex relative to that.
struct MotionReport {
  Energies energies;            ///< kinetic and potential energy alone [J]
  Point drift = Point::Zero();  ///< mean velocity [m/s]
  double about_mean = 0;        ///< kinetic energy of the motion about the mean [J]
  /// largest speed of a vertex relative to a given drift, over the edge there [1/s]
  double edges_per_second = 0;
};

/// Sums level 0's energies, in a fixed order.
template <class B>
class EnergyMeter {
 public:
  /// Prepares the sums. `mesh` is that of level 0, all of it, and `mass` its mass [kg].
  EnergyMeter(const Hierarchy<B>& hierarchy, const TetMesh& mesh, double mass,
              const Point& gravity);
  void set_gravity(const Point& gravity);         ///< from now on [m/s^2]
  MotionReport motion(const Point& drift) const;  ///< one pass over the vertices
  Energies all(double time) const;  ///< one pass each over vertices, elements and surface

 private:
  const Hierarchy<B>& hierarchy_;
  Vec3<typename B::Real> gravity_;
  Scalars<B> inverse_edge_;
  double mass_;
  BlockSums<B> blocks_;
  Doubles<B> result_;

  std::array<double, 6> read() const;
};

}  // namespace plica
