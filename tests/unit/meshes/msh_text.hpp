// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <plica/core/error.hpp>
#include <plica/meshes/read_msh.hpp>
#include <string>

namespace plica::test {

/// Two tetrahedra on a common face, a region each, and a set of the three lower nodes. Line 13 is node 1, 22 element 7.
inline const std::string two_tets =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n3\n2 4 \"base\"\n3 1 \"tissue\"\n3 2 \"large tumour\"\n$EndPhysicalNames\n"
    "\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n10 0 0 1\n11 1 1 1\n$EndNodes\n"
    "$Elements\n3\n6 2 2 4 1 1 2 3\n7 4 2 1 1 1 2 3 10\n8 4 2 2 2 2 3 10 11\n$EndElements\n";

/// A file that lasts as long as this, one per test.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& content, const std::string& extension = ".msh") {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) /
            ("plica_" + std::string(test->test_suite_name()) + "_" + test->name() + extension);
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// `text` with the first `from` replaced.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

inline TetMesh read_text(const std::string& content, MeshReport* report = nullptr) {
  const TemporaryFile file(content);
  return read_msh(file.path(), report);
}

/// Reading fails at `line` (0: the message has none), and the message has every one of `parts`.
inline void expect_refused(const std::string& content, int line, const std::vector<std::string>& parts) {
  const TemporaryFile file(content);
  try {
    read_msh(file.path());
    ADD_FAILURE() << "read:\n" << content;
  } catch (const InputError& error) {
    const std::string message = error.what();
    const std::string place = file.path().string() + ":" + (line > 0 ? std::to_string(line) + ": " : " ");
    EXPECT_EQ(message.substr(0, place.size()), place) << message;
    for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << part << "\n" << message;
  }
}

}  // namespace plica::test
