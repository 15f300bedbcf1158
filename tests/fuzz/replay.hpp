// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <plica/meshes/files/file_bytes.hpp>

#include "target.hpp"

namespace plica::fuzz {

inline const std::filesystem::path folder =
    std::filesystem::path(PLICA_SOURCE_DIR) / "tests" / "fuzz";

/// Runs a target on what its fuzzer starts from and on what it once found; how many files that are.
inline int replay(const Target& target) {
  int count = 0;
  for (const char* kind : {"corpus", "findings"}) {
    if (!std::filesystem::exists(folder / kind / target.name)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder / kind / target.name)) {
      SCOPED_TRACE(entry.path().string());
      target.run(load_file(entry.path()).bytes);
      ++count;
    }
  }
  return count;
}

}  // namespace plica::fuzz
