// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <plica/drivers/app/output/progress.hpp>
#include <plica/drivers/app/output/terminal.hpp>

namespace plica::app {
namespace {

std::string in_clock(double seconds) {
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  const long whole = static_cast<long>(seconds + 0.5);
  if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
  return fmt::format("{}:{:02} h", whole / 3600, whole % 3600 / 60);
}

}  // namespace

std::string progress_line(double time, double duration, long steps, double wall_time, int width, double first_time) {
  const double done = std::clamp(time / duration, 0.0, 1.0);
  const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(duration))), 0, 9);
  const std::string before = fmt::format("{:.{}f} / {:.{}f} s ", time, decimals, duration, decimals);
  const double covered = time - first_time;
  const std::string after = fmt::format(" {:3.0f} % {:6.0f} steps/s {:6.2f} x real time {:>8} left", 100 * done,
                                        static_cast<double>(steps) / wall_time, covered / wall_time,
                                        covered > 0 ? in_clock(wall_time * (duration - time) / covered) : "?");
  const int room = width - static_cast<int>(before.size() + after.size()) - 3;
  if (room < 5) return (before + after).substr(0, static_cast<std::size_t>(std::max(0, width - 1)));
  const std::size_t size = static_cast<std::size_t>(std::min(room, 40));
  const std::size_t filled = static_cast<std::size_t>(done * static_cast<double>(size));
  return before + "[" + std::string(filled, '#') + std::string(size - filled, '.') + "]" + after;
}

Progress::Progress(double duration, bool quiet, double first_time, long first_step)
    : on_(!quiet && on_terminal()), duration_(duration), first_time_(first_time), first_step_(first_step) {}

Progress::~Progress() {
  if (on_) std::cerr << "\r\033[K" << std::flush;  // the summary takes its place
}

void Progress::update(double time, long steps, const std::function<long()>& halvings) {
  const Clock::time_point now = Clock::now();
  if (!on_ || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  const double wall_time = std::chrono::duration<double>(now - start_).count();
  const long halved = halvings ? halvings() : 0;
  const std::string retries = halved > 0 ? " " + counted(halved, "halving") : "";
  const int width = terminal_width() - static_cast<int>(retries.size());
  std::cerr << "\r\033[K"
            << coloured(progress_line(time, duration_, steps - first_step_, wall_time, width, first_time_) + retries,
                        Colour::cyan)
            << std::flush;
}

}  // namespace plica::app
