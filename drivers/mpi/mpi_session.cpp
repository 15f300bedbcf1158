// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <plica/drivers/mpi/mpi_ranks.hpp>
#include <plica/drivers/mpi/mpi_session.hpp>

namespace plica {

MpiSession::MpiSession(int& argc, char**& argv, Waiting waiting) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  ranks_ = std::make_unique<MpiRanks>(MPI_COMM_WORLD, std::move(waiting));
}

MpiSession::~MpiSession() {
  ranks_.reset();
  MPI_Finalize();
}

void MpiSession::end_all(int status) {
  MPI_Abort(MPI_COMM_WORLD, status);
  std::_Exit(status);
}

}  // namespace plica
