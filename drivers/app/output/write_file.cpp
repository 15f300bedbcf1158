// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <plica/core/error.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <system_error>

namespace plica::app {

namespace {

std::filesystem::path draft_of(const std::filesystem::path& file) {
  return file.string() + ".part";
}

void write_draft(const std::filesystem::path& file, const std::string& content) {
  errno = 0;
  std::ofstream stream(draft_of(file), std::ios::binary | std::ios::trunc);
  stream << content;
  stream.close();
  if (stream) return;
  const std::string reason = std::generic_category().message(errno);
  std::error_code ignored;
  std::filesystem::remove(draft_of(file), ignored);
  throw FileError("cannot write " + file.string() + ": " + reason);
}

void put_in_place(const std::filesystem::path& file) {
  std::error_code error, ignored;
  std::filesystem::rename(draft_of(file), file, error);
  if (!error) return;
  std::filesystem::remove(draft_of(file), ignored);
  throw FileError("cannot write " + file.string() + ": " + error.message());
}

std::filesystem::path nearest_existing(std::filesystem::path path) {
  std::error_code unknown;
  for (path = std::filesystem::absolute(path); path.has_relative_path(); path = path.parent_path())
    if (std::filesystem::exists(path, unknown)) break;
  return path;
}

}  // namespace

void write_file(const std::filesystem::path& file, const std::string& content, Durable durable) {
  write_draft(file, content);
  if (durable == Durable::yes) sync_file(draft_of(file));
  put_in_place(file);
  if (durable == Durable::yes) sync_file(file.parent_path());
}

void write_files(const std::vector<FileBytes>& files) {
  try {
    for (const FileBytes& file : files) write_draft(file.name, file.bytes);
  } catch (const FileError&) {
    std::error_code ignored;
    for (const FileBytes& file : files) std::filesystem::remove(draft_of(file.name), ignored);
    throw;
  }
  for (const FileBytes& file : files) put_in_place(file.name);
}

void sync_file(const std::filesystem::path& file) {
  const int handle = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0)
    throw FileError("cannot read " + file.string() + ": " + std::generic_category().message(errno));
  fsync(handle);  // errors are ignored: a file that cannot be synchronised cannot be made safer
  close(handle);
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && std::filesystem::is_directory(folder)) return;
  const std::filesystem::path there = nearest_existing(folder);
  if (!std::filesystem::is_directory(there))
    throw FolderError("cannot make the folder " + folder.string() + ": " + there.string() +
                      " is a file, not a folder");
  throw FolderError("cannot make the folder " + folder.string() +
                    ": the system lets none be made in " + there.string() + " (" + error.message() +
                    "); expected a place to write to");
}

FolderLock::FolderLock(const std::filesystem::path& folder)
    : handle_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (handle_ < 0 || flock(handle_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK)
    return;  // locked, or the system has no locks
  close(handle_);
  throw InputError("another run is writing to the folder " + folder.string() +
                   "; expected its end, or another folder with -o");
}

FolderLock::~FolderLock() {
  if (handle_ >= 0) close(handle_);
}

GrowingFile::GrowingFile(std::filesystem::path file, const std::string& head)
    : file_(std::move(file)) {
  write_file(file_, head);
  size_ = head.size();
  open();
}

GrowingFile::GrowingFile(std::filesystem::path file, std::uint64_t size)
    : file_(std::move(file)), size_(size) {
  std::error_code error;
  const std::uint64_t found = std::filesystem::file_size(file_, error);
  if (error || found < size)
    throw InputError(
        "cannot resume: " + file_.string() + " was changed since the checkpoint: " +
        (error ? error.message()
               : std::to_string(found) + " bytes, " + std::to_string(size) + " expected"));
  cut_back(size);
  open();
}

void GrowingFile::cut_back(std::uint64_t size) {
  std::error_code error;
  std::filesystem::resize_file(file_, size, error);
  if (error) throw FileError("cannot write " + file_.string() + ": " + error.message());
  size_ = size;
}

GrowingFile::~GrowingFile() {
  if (handle_ >= 0) close(handle_);
}

void GrowingFile::open() {
  handle_ = ::open(file_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (handle_ < 0)
    throw FileError("cannot write " + file_.string() + ": " +
                    std::generic_category().message(errno));
}

void GrowingFile::add(const std::string& line) {
  // one call of write(), so that the file gets all of the line or nothing
  const ssize_t written = ::write(handle_, line.data(), line.size());
  if (written != static_cast<ssize_t>(line.size())) {
    const std::string reason = std::generic_category().message(written < 0 ? errno : ENOSPC);
    std::error_code ignored;
    std::filesystem::resize_file(file_, size_, ignored);
    throw FileError("cannot write " + file_.string() + ": " + reason);
  }
  size_ += line.size();
}

void GrowingFile::sync() const { fsync(handle_); }

}  // namespace plica::app
