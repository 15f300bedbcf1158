// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <iterator>
#include <limits>
#include <plica/meshes/files/memory_file.hpp>
#include <plica/meshes/files/reading.hpp>

namespace plica {

MemoryFile load_file(const std::filesystem::path& path) {
  MemoryFile file{path.string(), {}};
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) refuse(file.name, {}, "is a folder, not a file");
  std::ifstream in(path, std::ios::binary);
  if (!in) refuse(file.name, {}, "cannot be opened");
  file.bytes.assign(std::istreambuf_iterator<char>(in), {});
  if (in.bad()) refuse(file.name, {}, "cannot be read");
  return file;
}

std::string to_text(const Place& place) {
  if (place.line > 0) return "on line " + std::to_string(place.line);
  return place.byte >= 0 ? "at byte " + std::to_string(place.byte) : "";
}

void refuse(const std::string& file, const Place& place, const std::string& message) {
  if (place.line > std::numeric_limits<int>::max()) throw InputError(to_text(place) + ": " + message, {file});
  if (place.line > 0 || place.byte < 0) throw InputError(message, {file, static_cast<int>(place.line)});
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

}  // namespace plica
