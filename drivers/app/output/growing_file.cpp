// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <plica/core/error.hpp>
#include <plica/drivers/app/output/growing_file.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <system_error>

namespace plica::app {

GrowingFile::GrowingFile(std::filesystem::path file, const std::string& head) : file_(std::move(file)) {
  write_file(file_, head);
  size_ = head.size();
  open();
}

GrowingFile::GrowingFile(std::filesystem::path file, std::uint64_t size) : file_(std::move(file)), size_(size) {
  std::error_code error;
  const std::uint64_t found = std::filesystem::file_size(file_, error);
  if (error || found < size)
    throw InputError(
        "cannot resume: " + file_.string() + " is not what the run left: " +
        (error ? error.message() : std::to_string(found) + " bytes, " + std::to_string(size) + " expected"));
  std::filesystem::resize_file(file_, size, error);
  if (error) throw FileError("cannot write " + file_.string() + ": " + error.message());
  open();
}

GrowingFile::~GrowingFile() {
  if (handle_ >= 0) close(handle_);
}

void GrowingFile::open() {
  handle_ = ::open(file_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (handle_ < 0) throw FileError("cannot write " + file_.string() + ": " + std::generic_category().message(errno));
}

void GrowingFile::add(const std::string& line) {
  const ssize_t written = write(handle_, line.data(), line.size());  // one call: all of the line or nothing
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
