// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <plica/drivers/app/output/write_file.hpp>
#include <system_error>

namespace plica::app {

void write_file(const std::filesystem::path& file, const std::string& content, Durable durable) {
  std::filesystem::path draft = file;
  draft += ".part";
  errno = 0;
  std::ofstream stream(draft, std::ios::binary | std::ios::trunc);
  stream << content;
  stream.close();
  if (!stream) {
    const std::string reason = std::generic_category().message(errno);
    std::error_code ignored;
    std::filesystem::remove(draft, ignored);
    throw FileError("cannot write " + file.string() + ": " + reason);
  }
  if (durable == Durable::yes) sync_file(draft);
  std::error_code error;
  std::filesystem::rename(draft, file, error);
  if (error) throw FileError("cannot write " + file.string() + ": " + error.message());
  if (durable == Durable::yes) sync_file(file.parent_path());
}

void sync_file(const std::filesystem::path& file) {
  const int handle = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0) throw FileError("cannot read " + file.string() + ": " + std::generic_category().message(errno));
  fsync(handle);  // what cannot be synchronised is as safe as it gets
  close(handle);
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError("cannot make the folder " + folder.string() + ": " + error.message());
  if (!std::filesystem::is_directory(folder)) throw FileError(folder.string() + " is not a folder");
}

}  // namespace plica::app
