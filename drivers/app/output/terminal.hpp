// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

/// Text for people. Results go to the standard output, everything else to the standard error.
namespace plica::app {

/// Whether messages go to a terminal that shows more than plain lines.
bool on_terminal();

/// Columns of that terminal.
int terminal_width();

enum class Colour { red = 31, green = 32, yellow = 33, cyan = 36 };

/// The text in colour where messages go to a terminal and NO_COLOR (https://no-color.org) does not
/// ask for none.
std::string coloured(const std::string& text, Colour colour);

/// A line on the standard error.
void message(const std::string& text);

/// "1.94 ms", "50 kPa", "12 um": three or four digits and a prefix. Units of masses start from kg
/// and keep it.
std::string in_units(double value, const std::string& unit);

/// As one word of a shell's command line: quoted where it has to be.
std::string shell_word(const std::string& text);

/// "1 frame", "2 frames".
std::string counted(long count, const std::string& noun);

/// "12.3 MB", in powers of 1000.
std::string in_bytes(std::size_t bytes);

/// Rows of text, columns aligned: one letter per column, '<' left or '>' right; two spaces between
/// them.
std::string text_table(const std::vector<std::vector<std::string>>& rows,
                       const std::string& alignment, const std::string& indent = "  ");

/// The text broken into lines of at most `width`, each after the indent.
std::string wrapped(const std::string& text, std::size_t width, const std::string& indent);

/// One line that is written over and over, on a terminal; nothing where there is none, or where
/// told to be quiet.
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

/// That line, telling how far a run is.
class Progress {
 public:
  /// The run goes on from `first_time` and `first_step`.
  Progress(double end_time, bool quiet, double first_time = 0, long first_step = 0);
  /// After a macro step; draws ten times a second at most. `halvings` of macro steps are told of
  /// where there are any.
  void update(double time, long steps, const std::function<long()>& halvings = {});

 private:
  using Clock = std::chrono::steady_clock;
  ProgressLine line_;
  double duration_, first_time_;
  long first_step_;
  Clock::time_point start_ = Clock::now(), drawn_{};
};

/// The line; `steps` took `wall_time` and led from `first_time` to here: "0.62 / 3.00 s [###.......]  21 %    812 steps/s   1.58 x real time    1.5 s left".
std::string progress_line(double time, double end_time, long steps, double wall_time, int width,
                          double first_time = 0);

}  // namespace plica::app
