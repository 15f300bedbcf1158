// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/mesh.hpp>

namespace plica {

/// Closes the holes of a surface that are narrower than `width` [m] in the mean. Triangles go from
/// the edges of a hole to the middle of its points. Such holes are slits that a CAD program left,
/// or missing slivers. Wider holes stay.
/// @return the number of holes that were closed
int close_slits(TriangleSurface& surface, double width);

}  // namespace plica
