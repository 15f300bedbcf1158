// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <string>
#include <vector>

namespace plica {

/// Throws InputError for the first value out of its range, unknown name or combination without
/// meaning. It names the option as a scene would: "body.material.young_modulus is -1 Pa; expected a
/// pressure (Pa) > 0". Ranges and names are those of the tables in core/describe.hpp and
/// kernels/contact/shapes/.
void validate(const Problem& problem);

/// The part of it that needs no mesh, for a body of so many levels.
void validate_options(const Problem& problem, std::size_t levels);

/// The part of that about methods: what cycle, integrators and linear solvers cannot do together.
void validate_methods(const IntegrationOptions& options, std::size_t levels);

/// The part of it about obstacles, bodies that touch each other, and what obstacles hold.
void validate_contact(const Problem& problem);

/// How an obstacle turns, as far as that needs no obstacle; keys are those below `path`.
void validate_turn(const Turn& turn, const std::string& path = "turn");
/// The same of how it moves.
void validate_motion(const Motion& motion, const std::string& path = "motion");

/// What asks for all of an implicit stage's system in a matrix, as "integration.integrator is
/// v_cycle_euler"; empty: nothing.
std::string needs_matrix(const IntegrationOptions& options);

/// The part of it about cavities whose volume is given.
void validate_cavities(const Problem& problem);

/// What readers and generators promise and a caller's own mesh may not keep: numbers in range,
/// finite places, positive volumes, every vertex used, a region for every tetrahedron. InputError
/// otherwise, with level and number.
void validate_mesh(const TetMesh& mesh, int level);

/// Of each obstacle that the body starts deep in: where and how deep. InputError where one contains
/// the whole body, or is inside it.
std::vector<std::string> starts_in_obstacles(const Problem& problem);

/// What is allowed, but hardly meant: a sentence each. Of a problem that is valid.
std::vector<std::string> doubts(const Problem& problem);

}  // namespace plica
