// SPDX-License-Identifier: BSD-3-Clause
#include "unit/app/child.hpp"

namespace plica::app::test {

#ifndef PLICA_WITH_MPI

// A launcher of MPI names each process by its environment.
TEST(Launch, ProgramWithoutMpiIsNoneOfSeveral) {
  const TemporaryFolder folder;
  const auto started = [&](const std::vector<std::string>& variables) {
    std::vector<std::string> words = {"env"};
    words.insert(words.end(), variables.begin(), variables.end());
    words.insert(words.end(), {PLICA_EXECUTABLE, "list", "cycles"});
    return run_child(words, folder);
  };
  const Child first = started({"OMPI_COMM_WORLD_SIZE=3", "OMPI_COMM_WORLD_RANK=0"});
  EXPECT_EQ(first.status, 4);
  EXPECT_NE(first.errors.find("3 processes were started"), std::string::npos) << first.errors;
  const Child second = started({"PMI_SIZE=3", "PMI_RANK=1"});
  EXPECT_EQ(second.status, 4);
  EXPECT_EQ(second.errors, "");  // one message is enough
  EXPECT_EQ(started({"PMIX_RANK=0"}).status, 4);
  EXPECT_EQ(started({"OMPI_COMM_WORLD_SIZE=1", "PMIX_RANK=0"}).status, 0);
  EXPECT_EQ(started({"PMIX_RANK=0", "SLURM_STEP_NUM_TASKS=1"}).status, 0);
}

#endif

}  // namespace plica::app::test
