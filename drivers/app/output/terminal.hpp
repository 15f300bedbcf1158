// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

/// Text output for users. Results go to the standard output, everything else to the standard error.
namespace plica::app {

/// Returns true if messages go to a terminal that shows colours and can overwrite a line.
bool on_terminal();

/// Returns the number of columns of the terminal that messages go to; 80: unknown.
int terminal_width();

/// Colours of text, with their ANSI codes.
enum class Colour { red = 31, green = 32, yellow = 33, cyan = 36 };

/// Returns the text in colour. Returns it unchanged if messages do not go to a terminal, or if
/// NO_COLOR (https://no-color.org) is set.
std::string coloured(const std::string& text, Colour colour);

/// Prints a line on the standard error.
void message(const std::string& text);

/// Returns a value with a unit: "1.94 ms", "50 kPa", "12 um". It has three or four digits and a
/// prefix. A value in kg gets no prefix.
std::string in_units(double value, const std::string& unit);

/// Returns a fraction as text: "0.123 %".
std::string percent(double fraction);

/// Returns the text as one word of a shell's command line, quoted if needed.
std::string shell_word(const std::string& text);

/// Returns a count and its noun: "1 frame", "2 frames".
std::string counted(long count, const std::string& noun);

/// Returns a size in bytes as text: "12.3 MB", in powers of 1000.
std::string in_bytes(std::size_t bytes);

/// Returns rows of text as a table with two spaces between columns. `alignment` has one letter per
/// column: '<' left, '>' right.
std::string text_table(const std::vector<std::vector<std::string>>& rows,
                       const std::string& alignment, const std::string& indent = "  ");

/// Returns the text broken into lines of at most `width` columns, each after the indent.
std::string wrapped(const std::string& text, std::size_t width, const std::string& indent);

/// Line on a terminal that is overwritten again and again. Prints nothing if there is no terminal,
/// or if it is told to be quiet.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet) : on_(!quiet && on_terminal()) {}
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  bool on() const { return on_; }
  void update(const std::string& line) const;
  void clear() const;

 private:
  bool on_;
};

/// Progress line of a run.
class Progress {
 public:
  /// Starts the line. A resumed run starts at `first_time` [s] and `first_step`.
  Progress(double end_time, bool quiet, double first_time = 0, long first_step = 0);
  /// Draws the line, at most ten times a second. To be called after a macro step. `halvings`
  /// returns the number of halvings of macro steps; it is shown if it is above 0.
  void update(double time, long steps, const std::function<long()>& halvings = {});

 private:
  using Clock = std::chrono::steady_clock;
  ProgressLine line_;
  double duration_, first_time_;
  long first_step_;
  Clock::time_point start_ = Clock::now(), drawn_{};
};

/// Returns the progress line of a run. `steps` steps from `first_time` [s] to `time` [s] took
/// `wall_time` [s]. Example:
///     0.62 / 3.00 s [###.......]  21 %    812 steps/s   1.58 x real time    1.5 s left
std::string progress_line(double time, double end_time, long steps, double wall_time, int width,
                          double first_time = 0);

}  // namespace plica::app
