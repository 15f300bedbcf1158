// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <plica/core/error.hpp>
#include <plica/drivers/app/commands/completion.hpp>
#include <plica/drivers/app/commands/list.hpp>
#include <plica/drivers/app/scene/describe.hpp>
#include <plica/drivers/study/verify.hpp>

namespace plica::app {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return command->get_group() != "Planned"; });
}

// What may stand after a command: its own commands and its options
std::string words_of(const CLI::App& command) {
  std::string words;
  for (const CLI::App* own : commands_of(command)) words += own->get_name() + " ";
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) words += "--" + name + " ";
  return words;
}

constexpr const char* script = R"(_plica() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} words=
  case $before in
    --precision) words="{}" ;;
    -o|--output|--resume) COMPREPLY=($(compgen -d -- "$word")); return ;;
    --checkpoint) words="every=" ;;
    --set|--duration|--threads) return ;;
    list) words="{} " ;;
    verify) words="{} " ;;
    completion) words="bash zsh" ;;
  esac
  if [ -z "$words" ] || [ "${{word#-}}" != "$word" ]; then
    case "${{COMP_WORDS[1]}} ${{COMP_WORDS[2]}}" in
{}    esac
    [ "$COMP_CWORD" -gt 1 ] || words="{}"
  fi
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}}
complete -o default -F _plica plica
)";

}  // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  const std::vector<std::string> shells = {"bash", "zsh"};
  if (shell != "bash" && shell != "zsh") throw InputError(unknown_name("shell", shell, shells));
  std::string cases;
  const auto add = [&cases](const std::string& pattern, const CLI::App& command) {
    cases += fmt::format("      {}) words=\"{}\" ;;\n", pattern, words_of(command));
  };
  for (const CLI::App* command : commands_of(app)) {
    for (const CLI::App* own : commands_of(*command))
      add(fmt::format("\"{} {}\"*", command->get_name(), own->get_name()), *own);
    add(fmt::format("\"{} \"*", command->get_name()), *command);
  }
  const std::string text = fmt::format(script, fmt::join(names(precisions()), " "), fmt::join(list_names(), " "),
                                       fmt::join(names(verify_problems()), " "), cases, words_of(app));
  return shell == "zsh" ? "autoload -U +X bashcompinit && bashcompinit\n" + text : text;
}

}  // namespace plica::app
