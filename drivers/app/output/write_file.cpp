// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <plica/drivers/app/output/write_file.hpp>
#include <system_error>

namespace plica::app {

namespace {

std::filesystem::path draft_of(const std::filesystem::path& file) { return file.string() + ".part"; }

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

}  // namespace

void write_file(const std::filesystem::path& file, const std::string& content, Durable durable) {
  write_draft(file, content);
  if (durable == Durable::yes) sync_file(draft_of(file));
  put_in_place(file);
  if (durable == Durable::yes) sync_file(file.parent_path());
}

void write_files(const std::vector<MemoryFile>& files) {
  try {
    for (const MemoryFile& file : files) write_draft(file.name, file.bytes);
  } catch (const FileError&) {
    std::error_code ignored;
    for (const MemoryFile& file : files) std::filesystem::remove(draft_of(file.name), ignored);
    throw;
  }
  for (const MemoryFile& file : files) put_in_place(file.name);
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
