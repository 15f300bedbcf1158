// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace plica::app {

/// What the program tells its caller.
enum class ExitStatus {
  done = 0,
  failed = 1,         ///< a file or folder could not be read or written
  bad_input = 2,      ///< arguments, scenes, meshes; steps and combinations that are refused
  diverged = 3,       ///< the run was stopped; its last good state is on disk
  interrupted = 130,  ///< Ctrl-C; the files are complete up to there
};

}  // namespace plica::app
