// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/reference/reference.hpp>

namespace plica::app {

namespace {

constexpr const char* commands_head = R"(# Commands

```sh
build/bin/plica --help            # all commands
build/bin/plica run --help        # one of them
```

Results go to the standard output, messages to the standard error. `--kokkos-*` is handed to Kokkos. What the exit
statuses mean is in [errors](errors.md#exit-status).

)";

/// Returns an option's names and value: "-o, --output FOLDER".
std::string name_of_option(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true);
  std::string names;
  for (const std::string& one : option.get_snames()) names += "-" + one + ", ";
  for (const std::string& one : option.get_lnames()) names += "--" + one + ", ";
  names.resize(names.size() - 2);
  std::string value = option.get_items_expected_max() > 0 ? option.get_type_name() : "";
  value = value.substr(0, value.find(':'));  // without CLI11's words for a range
  return names + (value.empty() ? "" : " " + value);
}

std::string option_table(const CLI::App& command) {
  Lines rows{{"option", "meaning"}};
  for (const CLI::Option* option : command.get_options())
    if (option != command.get_help_ptr())
      rows.push_back(
          {as_code(markdown(name_of_option(*option))),
           (option->get_required() ? "**required**; " : "") + markdown(option->get_description())});
  return rows.size() > 1 ? markdown_table(rows) + "\n" : "";
}

std::string command_section(const CLI::App& command, const std::string& above) {
  const std::string name = above + " " + command.get_name();
  const auto all = [](const CLI::App*) { return true; };
  std::string text = fmt::format("## `{}`\n\n{}\n\n", name, sentence(command.get_description()));
  text += option_table(command);
  if (const std::string manual = command.get_footer(); !manual.empty())
    text += fmt::format("```text\n{}\n```\n\n", manual);
  for (const CLI::App* own : command.get_subcommands(all)) text += command_section(*own, name);
  return text;
}

}  // namespace

std::string commands_page(const CLI::App& app) {
  std::string text = written_by + std::string(commands_head);
  Lines rows{{"command", "what it does"}};
  const auto all = [](const CLI::App*) { return true; };
  for (const CLI::App* command : app.get_subcommands(all))
    rows.push_back({fmt::format("[{0}](#plica-{0})", command->get_name()),
                    markdown(command->get_description())});
  text += markdown_table(rows) + "\n";
  for (const CLI::App* command : app.get_subcommands(all))
    text += command_section(*command, "plica");
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

}  // namespace plica::app
