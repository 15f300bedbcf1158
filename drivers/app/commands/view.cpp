// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <plica/drivers/app/commands/interrupt.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/view/live_view.hpp>

namespace plica::app {
namespace {

// Opens the address in a browser; returns false if none was found
bool open_in_browser(const std::string& address) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return false;
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&quiet, stream, "/dev/null", O_WRONLY, 0);
  std::string program = "xdg-open", word = address;
  char* words[] = {program.data(), word.data(), nullptr};
  pid_t id = 0;
  const bool started = posix_spawnp(&id, program.c_str(), &quiet, nullptr, words, environ) == 0;
  posix_spawn_file_actions_destroy(&quiet);
  int state = 0;
  return started && waitpid(id, &state, 0) == id && WIFEXITED(state) && WEXITSTATUS(state) == 0;
}

void invite(const std::string& address, const ViewArguments& arguments) {
  const bool opened = arguments.browser && open_in_browser(address);
  message(opened ? address + " is open in the browser; Ctrl-C ends it"
                 : "open " + address + " in a browser on this machine; Ctrl-C ends it");
}

}  // namespace

ExitStatus view(const SceneArguments& arguments, const ViewArguments& more) {
  InterruptWatch watch;
  const Port port(more.port);  // taken before the set-up, which may take long
  with_simulation(arguments,
                  [&](const Scene& scene, auto& simulation, const Machine& machine, double) {
                    watch.end_in_order();
                    LiveOptions options{port, live_method(scene, simulation, machine.choice)};
                    options.listening = [&](const std::string& address) { invite(address, more); };
                    options.ended = interrupted;
                    show_live(scene, simulation, options);
                  });
  return ExitStatus::done;
}

}  // namespace plica::app
