// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/report/read_files.hpp>

namespace plica::app {

/// Gives a frame from before a cut the mesh of the last frame, so that one animation shows both. A
/// vertex that the frame does not have moves with the nearest one at rest that it has. That is
/// where it was before it split, or beside it where the cut has laid it bare.
void take_mesh_of_last(FrameFile& frame, const FrameFile& last);

}  // namespace plica::app
