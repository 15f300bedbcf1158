// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <plica/meshes/files/memory_file.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace plica::app {

/// A file or folder that cannot be read or written; what() names it and the reason.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A folder for results that cannot be made or is none: what was asked for is wrong, not what
/// became of it.
class FolderError : public FileError {
 public:
  using FileError::FileError;
};

enum class Durable { no, yes };

/// Replaces the file as a whole: readers, and whoever finds it after a killed run, see the old
/// content or the new; where it is durable also after the power failed.
void write_file(const std::filesystem::path& file, const std::string& content,
                Durable durable = Durable::no);

/// Waits until a file's content, or a folder's list of names, is on the disk.
void sync_file(const std::filesystem::path& file);

/// The same of several that belong together: all are written out before the first is replaced.
void write_files(const std::vector<MemoryFile>& files);

/// Makes the folder, and those above it, where they are missing. FolderError says what stands in
/// the way, and why.
void make_folder(const std::filesystem::path& folder);

/// Keeps other runs out of a folder as long as it lives: the system gives the folder back even
/// where the program is killed.
class FolderLock {
 public:
  /// InputError where another run has it.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int handle_;
};

/// A text file that grows by whole lines. Whoever looks at it, also after the run was killed, finds
/// whole lines. FileError where it cannot be written.
class GrowingFile {
 public:
  /// Starts anew with this head.
  GrowingFile(std::filesystem::path file, const std::string& head);
  /// Goes on after the first `size` bytes; what stood behind them is cut off. InputError where
  /// there are fewer.
  GrowingFile(std::filesystem::path file, std::uint64_t size);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  void add(const std::string& line);
  void sync() const;                  ///< waits until it is on the disk
  void cut_back(std::uint64_t size);  ///< what stands behind is cut off
  std::uint64_t size() const { return size_; }

 private:
  void open();
  std::filesystem::path file_;
  int handle_ = -1;
  std::uint64_t size_ = 0;
};

/// FNV-1a with eight bytes at a time: tells damage and change, not malice.
/// http://www.isthe.com/chongo/tech/comp/fnv/
class Digest {
 public:
  void add(const void* data, std::size_t size) {
    const auto* from = static_cast<const unsigned char*>(data);
    for (std::size_t at = 0; at < size; at += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, from + at, std::min(sizeof word, size - at));
      value_ = (value_ ^ word) * 0x100000001b3ULL;
    }
  }
  template <class T>
  void add(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add_size(values.size());
    add(values.data(), values.size() * sizeof(T));
  }
  void add(std::string_view text) {
    add_size(text.size());
    add(text.data(), text.size());
  }
  std::uint64_t value() const { return value_; }

 private:
  void add_size(std::uint64_t size) { add(&size, sizeof size); }
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace plica::app
