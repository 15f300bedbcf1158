// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// Whether a body starts in another shape than that of its rest.
bool starts_deformed(const InitialOptions& options);

/// Where the body's rest mesh is at the start: its translation. [m]
Point placement_of(const Body& body);

/// The points of a body's surface as they are placed; none where it has no surface.
std::vector<Point> places_at_start(const Body& body);

/// Per vertex of level 0 at rest, before it is placed, as if all were free: its displacement at the
/// start [m]. `box` is that mesh's bounding box. The same seed gives the same places everywhere,
/// vertex by vertex.
std::vector<Point> initial_displacement(const InitialOptions& options, const TetMesh& mesh,
                                        const Box& box);

/// What is to be said of elements that start flat or inside out, empty where there are none: how
/// many, the worst, its J.
std::string inverted_at_start(const TetMesh& mesh, const std::vector<Point>& displacement);

/// Per vertex of level 0 at rest, before it is placed, as if all were free [m/s]; `middle` is the
/// point its angular velocity is about. Throws InputError where a part has no vertex.
std::vector<Point> initial_velocity(const InitialOptions& options, const TetMesh& mesh,
                                    const Point& middle);

}  // namespace plica
