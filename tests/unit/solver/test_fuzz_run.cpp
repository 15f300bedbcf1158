// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/replay.hpp"
#include "fuzz/run_target.hpp"

// What the fuzzer of runs starts from, and what it once found, without libFuzzer
namespace {

using namespace plica;

TEST(FuzzRun, IsRefusedOrDiagnosed) {
  for (const fuzz::Target& target : fuzz::run_targets) EXPECT_GE(fuzz::replay(target), 4);
}

// The seeds and findings are sound meshes, whose elements are found inverted
TEST(FuzzRun, SeedsAreStepped) {
  for (const char* kind : {"corpus", "findings"})
    for (const auto& entry : std::filesystem::directory_iterator(fuzz::folder / kind / "run")) {
      SCOPED_TRACE(entry.path().string());
      const std::string bytes = load_file(entry.path()).bytes;
      EXPECT_NO_THROW(fuzz::step(read_mesh(MemoryFile{bytes.starts_with('#') ? "m.vtk" : "m.msh", bytes})));
    }
}

}  // namespace
