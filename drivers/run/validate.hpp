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

/// Checks the part of a problem that needs no mesh, for a body of so many levels. Throws
/// InputError.
void validate_options(const Problem& problem, std::size_t levels);

/// Checks what validate_options() does not: the meshes, and what needs them. Throws InputError.
void validate_meshes(const Problem& problem);

/// Checks the options of methods: what cycle, integrators and linear solvers cannot do together.
/// Throws InputError.
void validate_methods(const IntegrationOptions& options, std::size_t levels);

/// Checks that a body whose rest is sought has something that holds it, and nothing that moves by
/// itself. Throws InputError.
void validate_rest(const Problem& problem);

/// Returns why cycle him cannot step this problem, as a sentence with the option; empty: it can, as
/// far as is known before set-up.
std::string refused_by_him(const Problem& problem);

/// Returns why a problem's body cannot be cut, as a sentence with the option; empty: it can.
std::string refused_by_cuts(const Problem& problem);
/// Returns why a mesh of level 0 cannot be cut, as a sentence; empty: it can.
std::string refused_by_cuts(const TetMesh& mesh);

/// Returns why several ranks cannot simulate a problem, as a sentence with the option; empty: they
/// can, as far as is known before set-up.
std::string refused_by_ranks(const Problem& problem);

/// Checks the cuts of a problem, as far as that needs no mesh. Throws InputError.
void validate_cuts(const Problem& problem);
/// Checks that the body of a problem with cuts has a mesh and a surface that can be cut. Throws
/// InputError.
void validate_cut_meshes(const Problem& problem);

/// Checks obstacles, bodies that touch each other, and attachments. Throws InputError.
void validate_contact(const Problem& problem);

/// Checks how an obstacle turns, as far as that needs no obstacle. Throws InputError, with keys
/// below `path`.
void validate_turn(const Turn& turn, const std::string& path = "turn");
/// Checks how an obstacle moves, as far as that needs no obstacle. Throws InputError, with keys
/// below `path`.
void validate_motion(const Motion& motion, const std::string& path = "motion");

/// Returns which option needs all of an implicit stage's system in a matrix, as
/// "integration.integrator is v_cycle_euler"; empty: none.
std::string needs_matrix(const IntegrationOptions& options);

/// Checks cavities whose volume is given. Throws InputError where a method cannot have them.
void validate_cavities(const Problem& problem);

/// Checks a mesh for what readers and generators promise, but a caller's own mesh may lack: numbers
/// in range, finite places, positive volumes, every vertex used, a region for every tetrahedron.
/// Throws InputError with level and number.
void validate_mesh(const TetMesh& mesh, int level);

/// Checks what a mesh says of its pieces and of vertices that follow others. Throws InputError.
void validate_pieces(const TetMesh& mesh, int level);

/// Checks what a body with a part that is finer cannot have, and more where the part follows an
/// obstacle. Throws InputError.
void validate_parts(const Problem& problem);

/// Returns a sentence for each obstacle that the body starts deep in: where and how deep. Throws
/// InputError where an obstacle contains the whole body, or is inside it.
std::vector<std::string> starts_in_obstacles(const Problem& problem);

/// Returns warnings about a valid problem: a sentence for each thing that is allowed, but hardly
/// meant.
std::vector<std::string> problem_warnings(const Problem& problem);

}  // namespace plica
