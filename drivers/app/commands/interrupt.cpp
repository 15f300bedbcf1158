// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <plica/drivers/app/commands/interrupt.hpp>

namespace plica::app {
namespace {

volatile std::sig_atomic_t raised = 0;  // the one thing a signal handler may write

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = [](int) { raised = 1; };
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return raised != 0; }

}  // namespace plica::app
