// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <plica/drivers/app/output/terminal.hpp>
#include <sstream>

namespace plica::app {

bool on_terminal() {
  const char* type = std::getenv("TERM");
  return isatty(STDERR_FILENO) != 0 && type != nullptr && std::strcmp(type, "dumb") != 0;
}

int terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string coloured(const std::string& text, Colour colour) {
  const char* no_colour = std::getenv("NO_COLOR");
  if (!on_terminal() || (no_colour != nullptr && *no_colour != '\0')) return text;
  return fmt::format("\033[{}m{}\033[0m", static_cast<int>(colour), text);
}

void message(const std::string& text) { std::cerr << text << std::endl; }

std::string in_units(double value, const std::string& unit) {
  struct Prefix {
    double factor;
    const char* symbol;
  };
  constexpr Prefix prefixes[] = {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}, {1e-3, "m"}, {1e-6, "u"}, {1e-9, "n"}};
  const double size = std::abs(value);
  const bool scaled = size > 0 && std::isfinite(size) && unit != "kg";
  if (!scaled) return fmt::format("{:.4g} {}", value, unit);
  for (const Prefix& prefix : prefixes)
    if (size >= 0.9995 * prefix.factor && !(unit == "s" && prefix.factor > 1))
      return fmt::format("{:.3g} {}{}", value / prefix.factor, prefix.symbol, unit);
  return fmt::format("{:.3g} {}", value, unit);
}

std::string counted(long count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string in_bytes(std::size_t bytes) {
  const double size = static_cast<double>(bytes);
  if (size >= 1e9) return fmt::format("{:.3g} GB", size / 1e9);
  if (size >= 1e6) return fmt::format("{:.3g} MB", size / 1e6);
  if (size >= 1e3) return fmt::format("{:.3g} kB", size / 1e3);
  return fmt::format("{} B", bytes);
}

std::string text_table(const std::vector<std::vector<std::string>>& rows, const std::string& alignment,
                       const std::string& indent) {
  std::vector<std::size_t> widths(alignment.size(), 0);
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  std::string text;
  for (const auto& row : rows) {
    std::string line = indent;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string gap = c > 0 ? "  " : "";
      line += gap + (alignment[c] == '>' ? fmt::format("{:>{}}", row[c], widths[c])
                                         : fmt::format("{:<{}}", row[c], widths[c]));
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string wrapped(const std::string& text, std::size_t width, const std::string& indent) {
  std::istringstream words(text);
  std::string result, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && indent.size() + line.size() + 1 + word.size() > width) {
      result += indent + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return result + indent + line + "\n";
}

}  // namespace plica::app
