// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "fuzz/replay.hpp"
#include "fuzz/scene_target.hpp"

// What the fuzzer of scenes starts from, and what it once found, without libFuzzer
namespace {

TEST(FuzzScenes, AreRefusedOrSound) {
  for (const plica::fuzz::Target& target : plica::fuzz::scene_targets) EXPECT_GE(plica::fuzz::replay(target), 3);
}

}  // namespace
