// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/terminal.hpp>

namespace plica::app {

KokkosSession::KokkosSession(const KokkosArguments& arguments) {
  // Kokkos warns where OpenMP's threads are not bound. Binding is the user's choice, and comes too late from here.
  setenv("OMP_PROC_BIND", "false", 0);
  std::vector<std::string> words = {"plica"};
  words.insert(words.end(), arguments.pass_through.begin(), arguments.pass_through.end());
  if (arguments.threads > 0) words.push_back("--kokkos-num-threads=" + std::to_string(arguments.threads));
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  int count = static_cast<int>(words.size());
  Kokkos::initialize(count, pointers.data());
}

void warn(const Scene& scene) {
  for (const std::string& warning : scene.warnings) message(coloured("warning: ", Colour::yellow) + warning);
}

}  // namespace plica::app
