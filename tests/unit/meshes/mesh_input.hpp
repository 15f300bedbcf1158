// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <plica/core/error.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <string>
#include <vector>

// What the tests of every format do with files, in memory.
namespace plica::test {

/// `text` with the first `from` replaced.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// A file of meshes/data/formats.
inline MemoryFile sample(const std::string& name) {
  return load_file(std::filesystem::path(PLICA_SOURCE_DIR) / "meshes" / "data" / "formats" / name);
}

inline void expect_same(const TetMesh& a, const TetMesh& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.tets, b.tets);
  EXPECT_EQ(a.region, b.region);
  EXPECT_EQ(a.region_names, b.region_names);
  EXPECT_EQ(a.vertex_sets, b.vertex_sets);
}

/// `read` fails with "PLACE: ..." (like "m.msh:3" or "m.vtk: byte 40") and a message that has every one of `parts`.
inline void expect_refused(const std::function<void()>& read, const std::string& place,
                           const std::vector<std::string>& parts) {
  try {
    read();
    ADD_FAILURE() << "read; expected " << place;
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.substr(0, place.size() + 2), place + ": ") << message;
    for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << part << "\n" << message;
  }
}

inline void expect_refused(const MemoryFile& file, const std::string& place, const std::vector<std::string>& parts) {
  expect_refused([&] { read_mesh(file); }, place, parts);
}

/// Cut at any byte, a file is refused, unless only the last `optional` bytes are missing.
template <typename Read>
void expect_whole(const MemoryFile& file, std::size_t optional, const Read& read) {
  for (std::size_t bytes = 0; bytes < file.bytes.size(); ++bytes) {
    const MemoryFile part{file.name, file.bytes.substr(0, bytes)};
    if (bytes + optional >= file.bytes.size())
      EXPECT_NO_THROW(read(part)) << bytes;
    else
      EXPECT_THROW(read(part), InputError) << bytes << " of " << file.bytes.size();
  }
}

/// Any byte may turn into any other: an error or a sound result, but no crash. `check` sees what was read.
template <typename Read, typename Check>
void change_every_byte(const MemoryFile& file, const Read& read, const Check& check,
                       const std::vector<char>& into = {' ', '\n', '9', '-', '$', '"', 'e', '\0', '\xff'}) {
  for (std::size_t at = 0; at < file.bytes.size(); ++at)
    for (const char c : into) {
      MemoryFile changed = file;
      changed.bytes[at] = c;
      try {
        check(read(changed));
      } catch (const InputError&) {
      }
    }
}

}  // namespace plica::test
