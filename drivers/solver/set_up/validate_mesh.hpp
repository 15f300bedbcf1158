// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// What readers and generators promise and a caller's own mesh may not keep: numbers in range, finite places, positive volumes,
/// every vertex used, a region for every tetrahedron. InputError otherwise, with level and number.
void validate_mesh(const TetMesh& mesh, int level);

}  // namespace plica
