// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <plica/core/error.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <string>
#include <vector>

#include "mesh_input.hpp"

// What the tests of every format do with files, in memory.
namespace plica::test {

/// `text` with the first `from` replaced.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// A file of meshes/data/formats.
inline FileBytes sample(const std::string& name) {
  return load_file(std::filesystem::path(PLICA_SOURCE_DIR) / "meshes" / "data" / "formats" / name);
}

inline void expect_same(const TetMesh& a, const TetMesh& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.tets, b.tets);
  EXPECT_EQ(a.region, b.region);
  EXPECT_EQ(a.region_names, b.region_names);
  EXPECT_EQ(a.vertex_sets, b.vertex_sets);
}

/// `read` fails with "PLACE: ..." (like "m.msh:3" or "m.vtk: byte 40") and a message that has every
/// one of `parts`.
inline void expect_refused(const std::function<void()>& read, const std::string& place,
                           const std::vector<std::string>& parts) {
  try {
    read();
    ADD_FAILURE() << "read; expected " << place;
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.substr(0, place.size() + 2), place + ": ") << message;
    for (const std::string& part : parts)
      EXPECT_NE(message.find(part), std::string::npos) << part << "\n" << message;
  }
}

inline void expect_refused(const FileBytes& file, const std::string& place,
                           const std::vector<std::string>& parts) {
  expect_refused([&] { read_mesh(file); }, place, parts);
}

/// Cut at any byte, a file is refused, unless only the last `optional` bytes are missing.
template <typename Read>
void expect_whole(const FileBytes& file, std::size_t optional, const Read& read) {
  for (std::size_t bytes = 0; bytes < file.bytes.size(); ++bytes) {
    const FileBytes part{file.name, file.bytes.substr(0, bytes)};
    if (bytes + optional >= file.bytes.size())
      EXPECT_NO_THROW(read(part)) << bytes;
    else
      EXPECT_THROW(read(part), InputError) << bytes << " of " << file.bytes.size();
  }
}

/// Any byte may turn into any other: an error or a sound result, but no crash. `check` sees what
/// was read.
template <typename Read, typename Check>
void change_every_byte(const FileBytes& file, const Read& read, const Check& check,
                       const std::vector<char>& into = {' ', '\n', '9', '-', '$', '"', 'e', '\0',
                                                        '\xff'}) {
  for (std::size_t at = 0; at < file.bytes.size(); ++at)
    for (const char c : into) {
      FileBytes changed = file;
      changed.bytes[at] = c;
      try {
        check(read(changed));
      } catch (const InputError&) {
      }
    }
}

/// Two tetrahedra on a common face, a region each, and a set of the three lower nodes. Line 13 is
/// node 1, 22 element 7.
inline const std::string two_tets =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n3\n2 4 \"base\"\n3 1 \"tissue\"\n3 2 \"large tumour\"\n$EndPhysicalNames\n"
    "\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n10 0 0 1\n11 1 1 1\n$EndNodes\n"
    "$Elements\n3\n6 2 2 4 1 1 2 3\n7 4 2 1 1 1 2 3 10\n8 4 2 2 2 2 3 10 11\n$EndElements\n";

/// The same in MSH 4.1. Line 11 is the counts of entities, 17 those of nodes, 30 those of elements.
inline const std::string two_tets_4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n3\n2 4 \"base\"\n3 1 \"tissue\"\n3 2 \"large tumour\"\n$EndPhysicalNames\n"
    "$Entities\n0 0 1 2\n3 0 0 0 1 1 0 1 4 0\n1 0 0 0 1 1 1 1 1 1 -3\n2 0 0 0 1 1 1 1 2 "
    "0\n$EndEntities\n"
    "$Nodes\n2 5 1 11\n2 3 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n3 1 0 2\n10\n11\n0 0 1\n1 1 "
    "1\n$EndNodes\n"
    "$Elements\n3 3 6 8\n2 3 2 1\n6 1 2 3\n3 1 4 1\n7 1 2 3 10\n3 2 4 1\n8 2 3 10 "
    "11\n$EndElements\n";

inline TetMesh read_text(const std::string& content, MeshReport* report = nullptr) {
  return read_mesh(FileBytes{"m.msh", content}, report);
}

/// Reading fails at `line` (0: the message has none), and the message has every one of `parts`.
inline void expect_refused(const std::string& content, int line,
                           const std::vector<std::string>& parts) {
  expect_refused(FileBytes{"m.msh", content},
                 "m.msh" + (line > 0 ? ":" + std::to_string(line) : ""), parts);
}

}  // namespace plica::test
