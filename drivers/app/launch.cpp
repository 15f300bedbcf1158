// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <cstdlib>
#include <initializer_list>
#include <plica/core/text.hpp>
#include <plica/drivers/app/failures.hpp>
#include <plica/drivers/app/launch.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/program.hpp>
#include <string_view>
#ifdef PLICA_WITH_MPI
#include <plica/drivers/mpi/mpi_session.hpp>
#endif

namespace plica::app {
namespace {

constexpr int unknown = -1;

// Returns the first of these environment variables that is a number
int number_in(std::initializer_list<const char*> variables) {
  for (const char* variable : variables) {
    const char* const value = std::getenv(variable);
    if (value == nullptr) continue;
    const std::string_view digits(value);
    int number = unknown;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error == std::errc{} && end == digits.data() + digits.size()) return number;
  }
  return unknown;
}

// Returns the number of processes that a launcher has started together: 1 without a launcher,
// `unknown` where it does not say
int started_processes() {
  const int count = number_in({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"});
  const bool launched =
      std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMI_SIZE") || std::getenv("PMIX_RANK");
  return launched ? count : 1;
}

#ifdef PLICA_WITH_MPI

int run_with_mpi(int argc, char** argv) {
  Waiting waiting;
  waiting.say = [](const std::string& text) {
    message(coloured("warning: ", Colour::yellow) + text);
  };
  MpiSession session(argc, argv, waiting);
  try {
    return program(argc, argv, &session.ranks());
  } catch (const LostRank& error) {
    session.end_all(static_cast<int>(failed(error.what(), ExitStatus::failed)));
  }
}

#else

int refuse_several(int count) {
  const auto status = ExitStatus::no_mpi;
  if (number_in({"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"}) <= 0)
    failed(text(count == unknown ? "several" : std::to_string(count),
                " processes were started, and this plica was built without MPI: each would do the "
                "same; expected one process, or a plica that is built with -DPLICA_BUILD_MPI=ON"),
           status);
  return static_cast<int>(status);
}

#endif

}  // namespace

int launch(int argc, char** argv) {
  const int count = started_processes();
  if (count == 1) return program(argc, argv);
#ifdef PLICA_WITH_MPI
  return run_with_mpi(argc, argv);
#else
  return refuse_several(count);
#endif
}

}  // namespace plica::app
