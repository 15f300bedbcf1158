// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace plica::app {

/// Runs the program plica, as one process or as one of those that a launcher of MPI has started.
/// MPI is initialised in the latter case only: alone it takes a third of a second.
///
/// Returns the exit status. It is that of ExitStatus::no_mpi where several processes were started
/// and the program was built without MPI.
int launch(int argc, char** argv);

}  // namespace plica::app
