// SPDX-License-Identifier: BSD-3-Clause
#include <lz4.h>
#include <zlib.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <limits>
#include <plica/meshes/files/file_bytes.hpp>
#include <plica/meshes/files/reading.hpp>
#include <system_error>

namespace plica {

namespace {

// Returns a name for a message; a very long one is cut to its end
std::string path_shown(const std::string& name) {
  constexpr std::size_t longest = 300;
  return name.size() > longest ? "..." + name.substr(name.size() - longest) : name;
}

}  // namespace

FileBytes load_file(const std::filesystem::path& path) {
  FileBytes file{path.string(), {}};
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) refuse(file.name, {}, "is a folder, not a file");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    refuse(file.name, {}, "is a pipe or a device, not a file");
  errno = error.value();
  std::ifstream in(path, std::ios::binary);
  if (!in)
    refuse(path_shown(file.name), {},
           "cannot be opened: " + std::generic_category().message(errno));
  file.bytes.assign(std::istreambuf_iterator<char>(in), {});
  if (in.bad()) refuse(file.name, {}, "cannot be read: " + std::generic_category().message(errno));
  return file;
}

std::string to_text(const Place& place) {
  if (place.line > 0) return "on line " + std::to_string(place.line);
  return place.byte >= 0 ? "at byte " + std::to_string(place.byte) : "";
}

void refuse(const std::string& file, const Place& place, const std::string& message) {
  if (place.line > std::numeric_limits<int>::max())
    throw InputError(to_text(place) + ": " + message, {file});
  if (place.line > 0 || place.byte < 0)
    throw InputError(message, {file, static_cast<int>(place.line)});
  throw InputError("byte " + std::to_string(place.byte) + ": " + message, {file});
}

std::string shown(std::string_view input) {
  constexpr std::size_t longest = 60;
  std::string text = "'";
  for (const char c : input.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (input.size() > longest ? "...'" : "'");
}

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  return lower_case(extension);
}

namespace {

std::optional<std::string> by_zlib(std::string_view block, std::size_t size) {
  std::string bytes(size, '\0');
  uLongf length = size;
  const int result = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                                reinterpret_cast<const Bytef*>(block.data()), block.size());
  if (result != Z_OK || length != size) return {};
  return bytes;
}

std::optional<std::string> by_lz4(std::string_view block, std::size_t size) {
  constexpr std::size_t most = std::numeric_limits<int>::max();
  if (size > most || block.size() > most) return {};
  std::string bytes(size, '\0');
  const int length = LZ4_decompress_safe(block.data(), bytes.data(), static_cast<int>(block.size()),
                                         static_cast<int>(size));
  if (length < 0 || static_cast<std::size_t>(length) != size) return {};
  return bytes;
}

constexpr Compressor compressors[] = {{"vtkZLibDataCompressor", 1100, by_zlib},
                                      {"vtkLZ4DataCompressor", 260, by_lz4}};

}  // namespace

const Compressor* find_compressor(std::string_view name) {
  for (const Compressor& one : compressors)
    if (name == one.name) return &one;
  return nullptr;
}

std::string compressor_names() {
  std::string names;
  for (const Compressor& one : compressors)
    names += (names.empty() ? "" : " and ") + std::string(one.name);
  return names;
}

}  // namespace plica
