// SPDX-License-Identifier: BSD-3-Clause
#include <cctype>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/app/reference/reference.hpp>

namespace plica::app {

ExitStatus write_reference(const CLI::App& app, const RunArguments& arguments) {
  const KokkosSession session(arguments.kokkos);
  const std::filesystem::path folder =
      arguments.folder.empty() ? "out/reference" : arguments.folder;
  make_folder(folder);
  write_file(folder / "keys.md", keys_page());
  write_file(folder / "commands.md", commands_page(app));
  write_file(folder / "errors.md", errors_page());
  write_file(folder / "material_parameters.md", material_parameters_page());
  write_file(folder / "support.md", support_page());
  return ExitStatus::done;
}

std::string markdown(std::string words) {
  std::string text;
  bool in_code = false;
  for (const char letter : words) {
    if (letter == '`') in_code = !in_code;
    if (letter == '|' || (!in_code && (letter == '<' || letter == '*' || letter == '_')))
      text += '\\';
    text += letter;
  }
  return text;
}

std::string sentence(std::string words) {
  words.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(words.front())));
  return markdown(words) + ".";
}

std::string as_code(const std::string& word) { return "`" + word + "`"; }

std::string values_in_words(const std::string& type_text) {
  const std::string between = " | ";
  const std::string names = type_text.substr(0, type_text.find(';'));
  if (names.find(between) == std::string::npos) return markdown(type_text);
  std::string text = "one of ";
  for (std::size_t from = 0, to = 0; to != std::string::npos; from = to + between.size()) {
    to = names.find(between, from);
    text += (from > 0 ? ", " : "") + as_code(names.substr(from, to - from));
    if (to == std::string::npos) break;
  }
  return text + markdown(type_text.substr(names.size()));
}

}  // namespace plica::app
