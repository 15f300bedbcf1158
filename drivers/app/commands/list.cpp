// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>
#include <plica/core/error.hpp>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/scene/describe.hpp>
#include <plica/drivers/app/scene/key_list.hpp>
#include <plica/drivers/app/scene/units.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/drivers/study/verify.hpp>
#include <plica/meshes/files/list.hpp>

namespace plica::app {

namespace {

using Json = nlohmann::ordered_json;

struct Family {
  const char* name;
  const char* summary;
  std::vector<Choice> (*choices)();
};
// Returns the file extensions that are read, with the description of the format each
template <class Formats>
std::vector<Choice> formats(const Formats& known) {
  std::vector<Choice> choices;
  for (const auto& format : known) choices.push_back({format.extension, format.description});
  return choices;
}
std::vector<Choice> unit_choices() {
  std::vector<Choice> choices;
  for (const UnitInfo& unit : unit_infos()) choices.push_back({unit.symbol, unit.summary});
  return choices;
}
std::vector<Choice> meshes_read() { return formats(mesh_formats); }
// Returns the shapes of obstacles; each summary has the names of the keys of the shape
std::vector<Choice> shapes_with_keys() {
  std::vector<Choice> shapes = obstacle_shapes();
  for (Choice& shape : shapes) {
    const std::string above = "contact.obstacles[]." + shape.name + ".";
    std::string between = ": ";
    for (const KeyInfo& key : scene_keys())
      if (key.path.starts_with(above))
        shape.summary += between + key.path.substr(above.size()), between = ", ";
  }
  return shapes;
}

constexpr Family families[] = {
    {"presets", "published methods, as what they consist of here", presets},
    {"materials", "constitutive laws", materials},
    {"tissues", "materials with values of a source, by name", tissues},
    {"volumes", "stiffness of the volume in laws of tissue", volumes},
    {"ogden_conventions", "what mu is in the terms of ogden", ogden_conventions},
    {"elements", "how strains follow from the vertices", elements},
    {"integrators", "how a level is stepped in time", integrators},
    {"cycles", "how the levels take a macro step together", cycle_choices},
    {"error_classes", "how far cycle auto may be from the finest level", error_classes},
    {"distributions", "how they share its time", distributions},
    {"shapes", "what a body can touch", shapes_with_keys},
    {"solvers", "of the implicit levels' linear systems", linear_solvers},
    {"preconditioners", "of conjugate gradients", preconditioners},
    {"outside", "what becomes of vertices outside another level's mesh", outside_rules},
    {"relaxations", "how the stresses of Prony series go on in time", relaxation_rules},
    {"formats", "mesh files that are read", meshes_read},
    {"units", "of numbers in scenes and on the command line", unit_choices}};
constexpr const char* keys_summary = "everything that a scene can say";
constexpr const char* reference_summary = "the reference as pages of Markdown, in a folder";

void list_choices(const std::vector<Choice>& choices, bool json) {
  std::vector<std::vector<std::string>> rows;
  Json array = Json::array();
  for (const Choice& choice : choices) {
    rows.push_back({choice.name, choice.summary});
    array.push_back({{"name", choice.name}, {"summary", choice.summary}});
  }
  std::cout << (json ? array.dump(2) + "\n" : text_table(rows, "<<", ""));
}

// Prints all keys of a scene, one paragraph each: the path, the allowed values, the meaning
void list_keys(bool json) {
  Json array = Json::array();
  std::string text;
  for (const KeyInfo& key : scene_keys()) {
    array.push_back({{"key", key.path},
                     {"expects", key.type_text},
                     {"otherwise", key.otherwise},
                     {"help", key.help}});
    const bool has_default = !key.otherwise.empty() && key.otherwise != "required" &&
                             !key.otherwise.ends_with("one of these");
    const std::string otherwise =
        key.otherwise.empty() ? "" : (has_default ? "; default " : "; ") + key.otherwise;
    if (!text.empty() && key.path.find('.') == std::string::npos) text += "\n";
    text += key.path + "\n" + wrapped(key.type_text + otherwise, 96, "    ") +
            wrapped(key.help, 96, "    ");
  }
  std::cout << (json ? array.dump(2) + "\n" : text);
}

}  // namespace

std::vector<std::string> list_names() {
  std::vector<std::string> names;
  for (const Family& family : families) names.emplace_back(family.name);
  names.emplace_back("keys");
  names.emplace_back("reference");
  return names;
}

std::string families_text() {
  std::vector<std::vector<std::string>> rows;
  for (const Family& family : families) rows.push_back({family.name, family.summary});
  rows.push_back({"keys", keys_summary});
  rows.push_back({"reference", reference_summary});
  return text_table(rows, "<<");
}

ExitStatus list_families(bool json) {
  Json array = Json::array();
  for (const Family& family : families)
    array.push_back({{"name", family.name}, {"summary", family.summary}});
  array.push_back({{"name", "keys"}, {"summary", keys_summary}});
  std::cout << (json ? array.dump(2) + "\n" : families_text());
  return ExitStatus::done;
}

ExitStatus list(const std::string& name, bool json) {
  for (const Family& family : families)
    if (name == family.name) return list_choices(family.choices(), json), ExitStatus::done;
  if (name != "keys") throw InputError(unknown_name("list", name, list_names()));
  list_keys(json);
  return ExitStatus::done;
}

namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands(
      [](const CLI::App* command) { return command->get_group() != "Planned"; });
}

// Returns the words that may follow a command: its subcommands and its options
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
  const std::string text =
      fmt::format(script, fmt::join(names(precisions()), " "), fmt::join(list_names(), " "),
                  fmt::join(names(verify_problems()), " "), cases, words_of(app));
  return shell == "zsh" ? "autoload -U +X bashcompinit && bashcompinit\n" + text : text;
}

}  // namespace plica::app
