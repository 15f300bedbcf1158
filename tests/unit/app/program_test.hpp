// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/app/child.hpp"

namespace plica::app::test {

using Json = nlohmann::json;

inline constexpr const char* falling_block = R"(duration: 20 ms
gravity: [0, 0, -9.81]
body:
  levels: [{box: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}}]
integration: {macro_step: 1 ms}
output: {every: 5 ms}
)";

/// A folder with a scene, and the program run in it.
class Program : public testing::Test {
 protected:
  Program() { std::ofstream(scene) << falling_block; }

  Child plica(std::vector<std::string> words, const std::function<bool(pid_t)>& meanwhile = {}) {
    words.insert(words.begin(), PLICA_EXECUTABLE);
    return run_child(words, folder, meanwhile);
  }
  Json summary() const { return Json::parse(content_of(folder / "out/summary.json")); }
  std::size_t lines(const std::string& file) const {
    const std::string text = content_of(folder / file);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
  // A run without end, and what to wait for before it is stopped
  std::vector<std::string> endless() const {
    return {"run", scene, "-o", out, "--duration", "1000 s", "--set", "output.every=2 ms", "--threads", "1"};
  }
  bool has_frames() const { return std::filesystem::exists(folder / "out/frames/surface_0003.vtu"); }

  TemporaryFolder folder;
  std::string scene = folder / "block.yaml", out = folder / "out";
};

}  // namespace plica::app::test
