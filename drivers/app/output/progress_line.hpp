// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <iostream>
#include <plica/drivers/app/output/terminal.hpp>

namespace plica::app {

/// One line that is written over and over, on a terminal.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet) : on_(!quiet && on_terminal()) {}
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  void update(const std::string& line) const {
    if (!on_) return;
    const auto width = static_cast<std::size_t>(std::max(1, terminal_width() - 1));
    std::cerr << "\r\033[K" << coloured(line.substr(0, width), Colour::cyan) << std::flush;
  }
  void clear() const {
    if (on_) std::cerr << "\r\033[K" << std::flush;
  }

 private:
  bool on_;
};

}  // namespace plica::app
