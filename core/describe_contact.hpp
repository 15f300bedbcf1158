// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/keys.hpp>
#include <plica/core/problem.hpp>

// Tables of the options of contact, in the form that describe.hpp explains.
namespace plica {

using namespace keys;

template <class V>
void describe(V& v, CouplingOptions& o) {
  v("stiffness", o.stiffness, Quantity{{.mass = 1, .time = -2}, not_negative},
    "of the spring to where its motion asks it to be; 0: none");
  v("damping", o.damping, AutoQuantity{{{.mass = 1, .time = -1}, not_negative}},
    "against the velocity of its motion; auto: critical, 2 sqrt(stiffness mass)");
  v("angular_stiffness", o.angular_stiffness,
    Quantity{{.mass = 1, .length = 2, .time = -2}, not_negative},
    "of one with inertia: of the spring to where its turn asks it to be, for each radian; 0: none");
  v("angular_damping", o.angular_damping,
    AutoQuantity{{{.mass = 1, .length = 2, .time = -1}, not_negative}},
    "likewise, against the rate of its turn; auto: critical for its largest moment of inertia");
}

template <class V>
void describe(V& v, GraspOptions& o) {
  const ListOf<Quantity> times{{duration, not_negative}};
  v("from", o.from, times, "when it closes; left out: when a program says so");
  v("until", o.until, times, "when it opens, as often as it closes; left out: it stays closed");
  v("reach", o.reach, Quantity{length, not_negative},
    "how far outside it a point may be that it takes hold of; left out: 0, and with where any");
  v("where", o.where, Group{},
    "which points, by where they start; left out: all. Without reach it holds all of them, "
    "wherever "
    "it is");
  v("stiffness", o.stiffness, AutoQuantity{{{.mass = 1, .time = -2}, positive}},
    "of the spring of each point that it holds; auto: that of contact");
  v("strength", o.strength, Quantity{force, positive},
    "force at which a point's spring tears; left out: it never does");
}

template <class V>
void describe(V& v, AttachmentOptions& o) {
  v.required("body", o.body, Text{}, "whose surface points are attached");
  v.required("to", o.to, Text{},
             "the body whose surface they are attached to, each where it is nearest at the start");
  v("where", o.where, Group{}, "which of them, by where they start; left out: all");
  v.required("reach", o.reach, Quantity{length, not_negative},
             "how far from that surface a point may be");
  v("stiffness", o.stiffness, AutoQuantity{{{.mass = 1, .time = -2}, positive}},
    "of the spring of each point; auto: that of contact");
  v("strength", o.strength, Quantity{force, positive},
    "force at which a point's spring tears; left out: it never does");
}

/// Describes an obstacle without its shape.
template <class V>
void describe(V& v, ObstacleOptions& o) {
  v("name", o.name, Text{}, "what results call it; left out: obstacle_0, obstacle_1, ... in order");
  v("friction", o.friction, Quantity{plain, not_negative},
    "Coulomb's coefficient; left out: frictionless");
  v("mass", o.mass, Quantity{{.mass = 1}, positive},
    "the body pushes it, its coupling pulls it to its motion; left out: it is where its motion "
    "says");
  v("inertia", o.inertia, ListOf<Quantity>{{{.mass = 1, .length = 2}}},
    "of an obstacle with mass, about its centre of mass: [xx, yy, zz] or [xx, yy, zz, xy, xz, yz]; "
    "left out: it does "
    "not turn");
  v("centre_of_mass", o.centre_of_mass, Vector{length},
    "of an obstacle with inertia, at t = 0; left out: the shape's origin");
  v("coupling", o.coupling, Group{}, "of an obstacle with mass, to its motion and its turn");
  v("grasp", o.grasp, Group{}, "it takes hold of the surface points near it, and lets them go");
  v("rotate", o.turn, Group{},
    "about an axis that goes along with its motion; of one with mass and inertia what its coupling "
    "pulls it to");
  v.at_most_one();
  describe(v, o.motion);
}

/// Describes contact without the obstacles.
template <class V>
void describe(V& v, ContactOptions& o) {
  v("bodies", o.bodies, Flag{}, "false: several bodies pass through each other");
  v("self", o.self, Flag{}, "true: a body's surface touches itself, where it folds");
  v("friction", o.friction, Quantity{plain, not_negative},
    "of both, Coulomb's coefficient; left out: frictionless");
  v("whole_surface", o.whole_surface, Name{"rule", whole_surface_rules},
    "which obstacles touch the surface between its points, too");
  v("stiffness_scale", o.stiffness_scale, Quantity{plain, positive},
    "times the penalty stiffness 64 E A / h");
  v("damping_scale", o.damping_scale, Quantity{plain, not_negative},
    "times the damping of the approach");
  v("friction_stiffness_scale", o.friction_stiffness_scale, Quantity{plain, positive},
    "times the penalty stiffness: the spring by which friction sticks");
  v("tangential_damping_scale", o.tangential_damping_scale, Quantity{plain, not_negative},
    "times the damping beside that spring");
}

}  // namespace plica
