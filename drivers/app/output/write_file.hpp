// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <plica/meshes/files/file_bytes.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace plica::app {

/// Error of a file or folder that cannot be read or written; what() has its name and the reason.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Error of a folder for results that cannot be made or is no folder. It counts as bad input: the
/// user has named a wrong folder.
class FolderError : public FileError {
 public:
  using FileError::FileError;
};

/// Option of write_file(): yes waits until the file is on disk, so that it survives a power
/// failure.
enum class Durable { no, yes };

/// Replaces the file as a whole. Readers see either the old content or the new one, also after the
/// program was killed; if it is durable, also after a power failure.
void write_file(const std::filesystem::path& file, const std::string& content,
                Durable durable = Durable::no);

/// Waits until a file's content, or a folder's list of names, is on disk.
void sync_file(const std::filesystem::path& file);

/// Replaces several files that belong together: all are written before the first one is replaced.
void write_files(const std::vector<FileBytes>& files);

/// Makes the folder and its parents, if they are missing. Throws FolderError, which says what
/// prevents it and why.
void make_folder(const std::filesystem::path& folder);

/// Lock on a folder: keeps other runs out while the object exists. The system releases the lock
/// even if the program is killed.
class FolderLock {
 public:
  /// Locks the folder. Throws InputError if another run has locked it.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int handle_;
};

/// Text file that grows by whole lines. A reader finds whole lines only, also after the run was
/// killed. Throws FileError if it cannot be written.
class GrowingFile {
 public:
  /// Starts a new file with this head.
  GrowingFile(std::filesystem::path file, const std::string& head);
  /// Continues the file after its first `size` bytes, and removes the rest. Throws InputError if
  /// the file has fewer bytes.
  GrowingFile(std::filesystem::path file, std::uint64_t size);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  void add(const std::string& line);
  void sync() const;                  ///< waits until the file is on disk
  void cut_back(std::uint64_t size);  ///< keeps the first `size` bytes
  std::uint64_t size() const { return size_; }

 private:
  void open();
  std::filesystem::path file_;
  int handle_ = -1;
  std::uint64_t size_ = 0;
};

/// Digest of data by FNV-1a with eight bytes at a time. Detects damage and changes, but no attacks.
/// Source: http://www.isthe.com/chongo/tech/comp/fnv/
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
