// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// Closes the holes of a surface that are narrower than `width` [m] in the mean, each by triangles
/// from its edges to their middle: a slit that a CAD program left, a sliver that is missing.
/// Returns how many. Wider ones stay.
int close_slits(TriangleSurface& surface, double width);

}  // namespace plica
