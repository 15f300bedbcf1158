// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace plica {

/// Options of ranks that wait for each other.
struct Waiting {
  /// a wait this long is said, once
  std::chrono::milliseconds patience{60'000};
  /// receives "rank 3 waits for rank 2: shares of level 0"; empty: nothing is said
  std::function<void(const std::string&)> say;
  /// a longer message is sent in parts [bytes]
  std::size_t largest_message = std::size_t{1} << 30;
};

}  // namespace plica
