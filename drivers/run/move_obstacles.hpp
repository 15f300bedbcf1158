// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/cycles/hierarchy.hpp>
#include <plica/kernels/contact/wrenches.hpp>

// Obstacles in a macro step: their wrenches, the motion of those with mass, and grasping.
namespace plica {

/// Computes the wrenches of a macro step that ends at `end`, from the levels' impulses. Tools with
/// mass then take this step.
template <class B>
void move_obstacles(Hierarchy<B>& hierarchy, const Doubles<B>& wrench, double end, double span) {
  const Contact<B>* contact = hierarchy[0].contact();
  if (!contact) return;
  for (const Level<B>& level : hierarchy.levels) level.response().finish_sums(hierarchy.exec());
  for (int i = 0; i < hierarchy.count(); ++i)
    update_vertices<B>(hierarchy.exec(), "plica::contact_impulses",
                       static_cast<int>(wrench.extent(0)),
                       SumImpulses<B>{hierarchy[i].response().impulse(), wrench, 1 / span, i == 0});
  contact->move_tools(hierarchy.exec(), wrench, end, span);
}

/// Makes an obstacle grasp what is near it in the present state (`closed`), or release all of it.
template <class B>
void hold(Hierarchy<B>& hierarchy, int obstacle, double time, bool closed) {
  Level<B>& level = hierarchy[0];
  if (closed)
    level.response().grasp(hierarchy.exec(), level, time, obstacle);
  else
    level.contact()->release(hierarchy.exec(), obstacle);
  for (Level<B>& each : hierarchy.levels) each.integrator->reset_history();
}

/// Makes obstacles grasp and release at the start of a macro step, as their options ask for in it.
template <class B>
void apply_grasp_schedule(Hierarchy<B>& hierarchy, double start, double span) {
  constexpr double rounding = 1e-9;  // part of the step
  const Contact<B>* contact = hierarchy[0].contact();
  const auto now = [&](double time) {
    return time >= start - rounding * span && time < start + (1 - rounding) * span;
  };
  for (int o = 0; contact && o < contact->obstacles(); ++o) {
    const auto& grasp = contact->grasp_options(o);
    for (std::size_t i = 0; grasp && i < grasp->from.size(); ++i) {
      if (now(grasp->from[i])) hold(hierarchy, o, start, true);
      if (i < grasp->until.size() && now(grasp->until[i])) hold(hierarchy, o, start, false);
    }
  }
}

/// Copies `from` to `to`, unless `from` is empty.
template <class Exec, class View>
void copy_memory(const Exec& exec, const View& from, View& to) {
  if (from.extent(0) == 0) return;
  if (to.extent(0) == 0) to = View("plica::contact.kept_memory", from.extent(0));
  copy(exec, to, from);
}

/// Throws InputError where a tool's coupling is too stiff for one step of it in every macro step.
/// At most, its stiffness is mass / step^2, and its angular stiffness the least moment of inertia /
/// step^2.
inline void check_couplings(const ContactOptions& contact, double step) {
  for (std::size_t i = 0; i < contact.obstacles.size(); ++i) {
    const ObstacleOptions& o = contact.obstacles[i];
    const auto expect_soft = [&](const char* key, const keys::Quantity& unit, double stiffness,
                                 double inertia, const char* what) {
      const double most = inertia / (step * step);
      if (stiffness <= most) return;
      throw InputError("contact.obstacles." + std::to_string(i) + ".coupling." + key + " is " +
                       unit.to_text(stiffness) + "; expected at most " + unit.to_text(most) +
                       ", which is its " + what + " over the square of the macro step, " +
                       keys::Quantity{keys::duration}.to_text(step) +
                       ": a softer coupling, more of it, or a shorter integration.macro_step");
    };
    if (o.mass)
      expect_soft("stiffness", {{.mass = 1, .time = -2}}, o.coupling.stiffness, *o.mass, "mass");
    if (!o.inertia.empty())
      expect_soft("angular_stiffness", {{.mass = 1, .length = 2, .time = -2}},
                  o.coupling.angular_stiffness, principal_moments(o)[0], "least moment of inertia");
  }
}

}  // namespace plica
