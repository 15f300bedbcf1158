// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/ranks.hpp>
#include <plica/drivers/mpi/waiting.hpp>

namespace plica {

/// MPI from its start to its end, for a program of our own. A program that starts MPI itself makes
/// MpiRanks.
class MpiSession {
 public:
  /// Starts MPI (MPI_Init_thread, MPI_THREAD_FUNNELED).
  MpiSession(int& argc, char**& argv, Waiting waiting = {});
  /// Ends MPI, when all ranks come here.
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  /// Returns all processes that were started together.
  Ranks& ranks() { return *ranks_; }
  /// Ends all ranks at once (MPI_Abort), wherever they are.
  [[noreturn]] void end_all(int status);

 private:
  std::unique_ptr<Ranks> ranks_;
};

}  // namespace plica
