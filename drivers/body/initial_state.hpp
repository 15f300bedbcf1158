// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// Returns whether a body starts in another shape than that at rest.
bool starts_deformed(const InitialOptions& options);

/// Returns the translation of the body's rest mesh at the start [m].
Point placement_of(const Body& body);

/// Returns the points of a body's surface where they are placed [m]; none where it has no surface.
std::vector<Point> places_at_start(const Body& body);

/// Returns the displacement of each vertex of level 0 at the start [m], as if all were free. `mesh`
/// is at rest, before it is placed, and `box` is its bounding box. The same seed gives the same
/// places everywhere, vertex by vertex.
std::vector<Point> initial_displacement(const InitialOptions& options, const TetMesh& mesh,
                                        const Box& box);

/// Returns a sentence about elements that start flat or inside out: how many, the worst, its J.
/// Empty where there are none.
std::string inverted_at_start(const TetMesh& mesh, const std::vector<Point>& displacement);

/// Returns the velocity of each vertex of level 0 at the start [m/s], as if all were free. `mesh`
/// is at rest, before it is placed; the angular velocity is about `middle`. Throws InputError where
/// a part has no vertex.
std::vector<Point> initial_velocity(const InitialOptions& options, const TetMesh& mesh,
                                    const Point& middle);

}  // namespace plica
