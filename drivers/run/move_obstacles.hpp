// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/cycles/hierarchy.hpp>
#include <plica/kernels/contact/wrenches.hpp>

// What obstacles did in a macro step, and where those with mass then are.
namespace plica {

/// The wrenches of a macro step that ends at `end`, from the levels' impulses; tools with mass take
/// it.
template <class B>
void move_obstacles(Hierarchy<B>& hierarchy, const Doubles<B>& wrench, double end, double span) {
  const Contact<B>* contact = hierarchy[0].contact();
  if (!contact) return;
  for (int i = 0; i < hierarchy.count(); ++i)
    update_vertices<B>(hierarchy.exec(), "plica::contact_impulses",
                       static_cast<int>(wrench.extent(0)),
                       SumImpulses<B>{hierarchy[i].response().impulse(), wrench, 1 / span, i == 0});
  contact->move_tools(hierarchy.exec(), wrench, end, span);
}

/// An obstacle takes hold of what is near it in the present state, or lets go.
template <class B>
void hold(Hierarchy<B>& hierarchy, int obstacle, double time, bool closed) {
  SolverLevel<B>& level = hierarchy[0];
  if (closed)
    level.response().grasp(hierarchy.exec(), level, time, obstacle);
  else
    level.contact()->release(hierarchy.exec(), obstacle);
  for (SolverLevel<B>& each : hierarchy.levels) each.integrator->forget();
}

/// What obstacles are asked to hold and to let go of in a macro step, at its start.
template <class B>
void hold_as_asked(Hierarchy<B>& hierarchy, double start, double span) {
  constexpr double rounding = 1e-9;  // of the step
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

/// to = from, where there is any
template <class Exec, class View>
void copy_memory(const Exec& exec, const View& from, View& to) {
  if (from.extent(0) == 0) return;
  if (to.extent(0) == 0) to = View("plica::contact.kept_memory", from.extent(0));
  copy(exec, to, from);
}

/// A tool with mass takes one step of its coupling in every macro step: no more than the springs
/// turn in it.
inline void check_couplings(const ContactOptions& contact, double step) {
  for (std::size_t i = 0; i < contact.obstacles.size(); ++i) {
    const ObstacleOptions& o = contact.obstacles[i];
    const auto expect_soft = [&](const char* key, const keys::Quantity& unit, double stiffness,
                                 double inertia, const char* what) {
      const double most = inertia / (step * step);
      if (stiffness <= most) return;
      throw InputError("contact.obstacles." + std::to_string(i) + ".coupling." + key + " is " +
                       unit.shown(stiffness) + "; expected at most " + unit.shown(most) +
                       ", which is its " + what + " over the square of the macro step, " +
                       keys::Quantity{keys::duration}.shown(step) +
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
