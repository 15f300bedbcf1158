// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <string>
#include <vector>

/// Text for people. Results go to the standard output, everything else to the standard error.
namespace plica::app {

/// Whether messages go to a terminal that shows more than plain lines.
bool on_terminal();

/// Columns of that terminal.
int terminal_width();

enum class Colour { red = 31, green = 32, yellow = 33, cyan = 36 };

/// The text in colour where messages go to a terminal and NO_COLOR (https://no-color.org) does not ask for none.
std::string coloured(const std::string& text, Colour colour);

/// A line on the standard error.
void message(const std::string& text);

/// "1.94 ms", "50 kPa", "12 um": three or four digits and a prefix. Units of masses start from kg and keep it.
std::string in_units(double value, const std::string& unit);

/// "1 frame", "2 frames".
std::string counted(long count, const std::string& noun);

/// "12.3 MB", in powers of 1000.
std::string in_bytes(std::size_t bytes);

/// Rows of text, columns aligned: one letter per column, '<' left or '>' right; two spaces between them.
std::string text_table(const std::vector<std::vector<std::string>>& rows, const std::string& alignment,
                       const std::string& indent = "  ");

/// The text broken into lines of at most `width`, each after the indent.
std::string wrapped(const std::string& text, std::size_t width, const std::string& indent);

}  // namespace plica::app
