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
  constexpr Prefix prefixes[] = {{1e9, "G"},  {1e6, "M"},  {1e3, "k"}, {1, ""},
                                 {1e-3, "m"}, {1e-6, "u"}, {1e-9, "n"}};
  const double size = std::abs(value);
  const bool scaled = size > 0 && std::isfinite(size) && unit != "kg";
  if (!scaled) return fmt::format("{:.4g} {}", value, unit);
  for (const Prefix& prefix : prefixes)
    if (size >= 0.9995 * prefix.factor && !(unit == "s" && prefix.factor > 1))
      return fmt::format("{:.3g} {}{}", value / prefix.factor, prefix.symbol, unit);
  return fmt::format("{:.3g} {}", value, unit);
}

std::string percent(double fraction) { return fmt::format("{:.3g} %", 100 * fraction); }

std::string shell_word(const std::string& text) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+-=:,@%";
  if (!text.empty() && text.find_first_not_of(plain) == text.npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string counted(long count, const std::string& noun) {
  if (count != 1 && noun.ends_with("hedron"))
    return fmt::format("{} {}a", count, noun.substr(0, noun.size() - 2));
  if (count != 1 && noun.ends_with("vertex"))
    return fmt::format("{} {}ices", count, noun.substr(0, noun.size() - 2));
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string in_bytes(std::size_t bytes) {
  const double size = static_cast<double>(bytes);
  if (size >= 1e9) return fmt::format("{:.3g} GB", size / 1e9);
  if (size >= 1e6) return fmt::format("{:.3g} MB", size / 1e6);
  if (size >= 1e3) return fmt::format("{:.3g} kB", size / 1e3);
  return fmt::format("{} B", bytes);
}

namespace {

// Returns the number of characters of a UTF-8 text: of the bytes that begin a character
std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

std::string text_table(const std::vector<std::vector<std::string>>& rows,
                       const std::string& alignment, const std::string& indent) {
  std::vector<std::size_t> widths(alignment.size(), 0);
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], letters(row[c]));
  std::string text;
  for (const auto& row : rows) {
    std::string line = indent;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string gap = c > 0 ? "  " : "";
      const std::string room(widths[c] - letters(row[c]), ' ');
      line += gap + (alignment[c] == '>' ? room + row[c] : row[c] + room);
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

void ProgressLine::update(const std::string& line) const {
  if (!on_) return;
  const auto width = static_cast<std::size_t>(std::max(1, terminal_width() - 1));
  std::cerr << "\r\033[K" << coloured(line.substr(0, width), Colour::cyan) << std::flush;
}

void ProgressLine::clear() const {
  if (on_) std::cerr << "\r\033[K" << std::flush;
}

namespace {

std::string in_clock(double seconds) {
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  const long whole = static_cast<long>(seconds + 0.5);
  if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
  return fmt::format("{}:{:02} h", whole / 3600, whole % 3600 / 60);
}

}  // namespace

std::string progress_line(double time, double end_time, long steps, double wall_time, int width,
                          double first_time) {
  const double done = std::clamp(time / end_time, 0.0, 1.0);
  const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(end_time))), 0, 9);
  const std::string before =
      fmt::format("{:.{}f} / {:.{}f} s ", time, decimals, end_time, decimals);
  const double covered = time - first_time;
  const std::string after =
      fmt::format(" {:3.0f} % {:6.0f} steps/s {:6.2f} x real time {:>8} left", 100 * done,
                  static_cast<double>(steps) / wall_time, covered / wall_time,
                  covered > 0 ? in_clock(wall_time * (end_time - time) / covered) : "?");
  const int room = width - static_cast<int>(before.size() + after.size()) - 3;
  if (room < 5) return (before + after).substr(0, static_cast<std::size_t>(std::max(0, width - 1)));
  const std::size_t size = static_cast<std::size_t>(std::min(room, 40));
  const std::size_t filled = static_cast<std::size_t>(done * static_cast<double>(size));
  return before + "[" + std::string(filled, '#') + std::string(size - filled, '.') + "]" + after;
}

Progress::Progress(double end_time, bool quiet, double first_time, long first_step)
    : line_(quiet), duration_(end_time), first_time_(first_time), first_step_(first_step) {}

void Progress::update(double time, long steps, const std::function<long()>& halvings) {
  const Clock::time_point now = Clock::now();
  if (!line_.on() || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  const double wall_time = std::chrono::duration<double>(now - start_).count();
  const long halved = halvings ? halvings() : 0;
  const std::string retries = halved > 0 ? " " + counted(halved, "halving") : "";
  const int width = terminal_width() - static_cast<int>(retries.size());
  line_.update(progress_line(time, duration_, steps - first_step_, wall_time, width, first_time_) +
               retries);
}

}  // namespace plica::app
