// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "fuzz/mesh_target.hpp"
#include "fuzz/replay.hpp"

// What the fuzzers start from, and what they once found, without libFuzzer
namespace {

using namespace plica;
using fuzz::folder;

TEST(FuzzCorpus, IsRefusedOrSound) {
  for (const fuzz::Target& target : fuzz::mesh_targets) EXPECT_GE(fuzz::replay(target), 3) << target.name;
}

// Every seed is a whole file, so that the fuzzers start behind the first checks
TEST(FuzzCorpus, SeedsAreRead) {
  for (const char* name : {"msh", "vtk", "vtu"})
    for (const auto& entry : std::filesystem::directory_iterator(folder / "corpus" / name))
      EXPECT_NO_THROW(read_mesh(MemoryFile{std::string("m.") + name, load_file(entry.path()).bytes})) << entry.path();
  for (const char* name : {"obj", "stl"})
    for (const auto& entry : std::filesystem::directory_iterator(folder / "corpus" / name))
      EXPECT_NO_THROW(read_surface(MemoryFile{std::string("m.") + name, load_file(entry.path()).bytes}))
          << entry.path();
}

}  // namespace
