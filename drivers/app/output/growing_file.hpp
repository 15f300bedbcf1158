// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

namespace plica::app {

/// A text file that grows by whole lines. Whoever looks at it, also after the run was killed, finds whole lines. FileError
/// where it cannot be written.
class GrowingFile {
 public:
  /// Starts anew with this head.
  GrowingFile(std::filesystem::path file, const std::string& head);
  /// Goes on after the first `size` bytes; what stood behind them is cut off. InputError where there are fewer.
  GrowingFile(std::filesystem::path file, std::uint64_t size);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  void add(const std::string& line);
  void sync() const;  ///< waits until it is on the disk
  std::uint64_t size() const { return size_; }

 private:
  void open();
  std::filesystem::path file_;
  int handle_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace plica::app
