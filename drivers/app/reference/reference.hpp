// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/commands/commands.hpp>
#include <string>

/// Pages of Markdown that the program writes about itself: the reference of the documents.
namespace plica::app {

/// Runs `plica list reference`: writes all pages of the reference to the folder, or to
/// out/reference. Those in cmake/docs/reference are written so; a test compares them.
ExitStatus write_reference(const CLI::App& app, const RunArguments& arguments);

/// Returns the page of the keys of a scene, from the tables that read scenes.
std::string keys_page();
/// Returns the page of the program's commands with their options and manuals.
std::string commands_page(const CLI::App& app);
/// Returns the page of exit statuses, of what messages look like, and of the reasons for which a
/// run stops.
std::string errors_page();
/// Returns the page of the materials' parameters.
std::string material_parameters_page();
/// Returns the page of what works with what. Each combination is set up on a small body; what is
/// refused is shown with its message. Needs Kokkos.
std::string support_page();

/// Comment that begins each page.
inline constexpr const char* written_by =
    "<!-- Written by the program: build/bin/plica list reference -o cmake/docs/reference -->\n";

/// Returns words as Markdown has them in a table's cell: without its signs for other things.
std::string markdown(std::string words);
/// Returns words as a sentence of Markdown, with a capital and a full stop.
std::string sentence(std::string words);
/// Returns a word as code: `word`.
std::string as_code(const std::string& word);
/// Returns what a value may be, for a table's cell: "a length (m) > 0", "one of `a`, `b`".
std::string values_in_words(const std::string& type_text);

}  // namespace plica::app
