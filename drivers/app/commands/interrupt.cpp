// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <iostream>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/commands/interrupt.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <system_error>

namespace plica::app {
namespace {

constexpr std::chrono::milliseconds patience(500);
constexpr int leave_now = static_cast<int>(ExitStatus::interrupted);

volatile std::sig_atomic_t raised = 0;
int wake_up[2] = {-1, -1};  // pipe: the handler writes to its end [1], the thread reads from [0]

// Sets the flag and wakes the thread; the second signal ends the program. A signal handler may do
// little more than set a flag, write to a pipe or end the program
void on_signal(int) {
  if (raised != 0) _exit(leave_now);
  raised = 1;
  const int before = errno;
  [[maybe_unused]] const ssize_t written = write(wake_up[1], "s", 1);
  errno = before;
}

void set_handlers(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

bool interrupted() { return raised != 0; }

InterruptWatch::InterruptWatch()
    : leave_([] { message("interrupted during the set-up; nothing was written"); }) {
  raised = 0;
  if (pipe2(wake_up, O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
  thread_ = std::thread([this] { wait(); });
  set_handlers(on_signal);
}

InterruptWatch::~InterruptWatch() {
  set_handlers(SIG_DFL);
  end_in_order();
  [[maybe_unused]] const ssize_t written = write(wake_up[1], "e", 1);
  thread_.join();
  for (int& end : wake_up) close(end), end = -1;
}

InterruptWatch::Leaving InterruptWatch::on_leave(const Lock&, std::function<void()> leave) {
  leave_ = std::move(leave);
  return Leaving(*this);
}

void InterruptWatch::end_in_order() {
  {
    const auto lock = hold();
    in_order_ = true;
  }
  ended_.notify_all();
}

void leave_files(const std::vector<FileBytes>& files, const std::filesystem::path& folder) {
  write_files(files);
  message(files.empty() ? "interrupted before the first row; nothing new was written"
                        : "interrupted; the rows so far are in " + folder.string());
}

void InterruptWatch::wait() {
  char why = 0;
  while (read(wake_up[0], &why, 1) < 0 && errno == EINTR) {
  }
  auto lock = hold();
  if (ended_.wait_for(lock, patience, [this] { return in_order_; })) return;
  if (on_terminal()) std::cerr << "\r\033[K";
  try {
    leave_();
  } catch (const std::exception& error) {
    message(coloured("error: ", Colour::red) + error.what());
  }
  std::cout.flush();
  _exit(leave_now);
}

}  // namespace plica::app
