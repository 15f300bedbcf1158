// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace plica::app::test {

/// An empty folder that lasts as long as this, one per test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = "plica_" + std::string(test->test_suite_name()) + "_" + test->name();
    for (char& letter : name)
      if (letter == '/') letter = '_';
    path_ = std::filesystem::path(testing::TempDir()) / name;
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// Another program, with what it wrote.
struct Child {
  int status = -1;  ///< its exit status; 128 + signal where one ended it
  std::string output, errors;
};

/// Runs it to its end; `meanwhile` is called with its process id again and again until it returns
/// true.
inline Child run_child(std::vector<std::string> words, const TemporaryFolder& folder,
                       const std::function<bool(pid_t)>& meanwhile = {}) {
  const std::string out = folder / "stdout.txt", err = folder / "stderr.txt";
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0600);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0600);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t id = 0;
  const int failure = posix_spawnp(&id, pointers[0], &files, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (failure != 0) return {};
  int state = 0;
  for (bool wanted = static_cast<bool>(meanwhile); wanted && waitpid(id, &state, WNOHANG) == 0;) {
    wanted = !meanwhile(id);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (!wanted) waitpid(id, &state, 0);
  }
  if (!meanwhile) waitpid(id, &state, 0);
  return {WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state), content_of(out),
          content_of(err)};
}

/// The Python of the project's own environment where that was made, else the system's.
inline std::string python() {
  const std::string own = PLICA_SOURCE_DIR "/.venv/bin/python";
  return std::filesystem::exists(own) ? own : "python3";
}

using Json = nlohmann::json;

inline constexpr const char* falling_block = R"(duration: 20 ms
gravity: [0, 0, -9.81]
body:
  levels: [{box: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}}]
integration: {macro_step: 1 ms}
output: {every: 5 ms}
)";

/// Two levels of a beam that is held at one end, for 50 ms.
inline std::string small_beam(const std::string& material, const std::string& more) {
  return R"(duration: 50 ms
gravity: [0, 0, -9.81]
body:
  levels:
    - {box: {size: [0.4, 0.1, 0.1], cells: [8, 2, 2]}}
    - {box: {size: [0.4, 0.1, 0.1], cells: [4, 1, 1]}}
  material: {young_modulus: 1 MPa, poisson_ratio: 0.3, model: )" +
         material + "}\n  fixed: [{half_space: {normal: [1, 0, 0]}}]\n" + more;
}

/// A folder with a scene, and the program run in it.
class ProgramTest : public testing::Test {
 protected:
  explicit ProgramTest(const std::string& text) { std::ofstream(scene) << text; }

  Child plica(std::vector<std::string> words,
              const std::function<bool(pid_t)>& meanwhile = {}) const {
    words.insert(words.begin(), PLICA_EXECUTABLE);
    return run_child(words, folder, meanwhile);
  }
  /// plica COMMAND, what it needs, and `more` words.
  Child plica(std::vector<std::string> words, const std::vector<std::string>& more,
              const std::function<bool(pid_t)>& meanwhile = {}) const {
    words.insert(words.end(), more.begin(), more.end());
    return plica(words, meanwhile);
  }
  Json json_of(const std::string& file) const { return Json::parse(content_of(folder / file)); }

  TemporaryFolder folder;
  std::string scene = folder / "block.yaml", out = folder / "out";
};

/// The same with a block that falls.
class Program : public ProgramTest {
 protected:
  Program() : ProgramTest(falling_block) {}
  Json summary() const { return json_of("out/summary.json"); }
  std::size_t lines(const std::string& file) const {
    const std::string text = content_of(folder / file);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
  // A run without end, and what to wait for before it is stopped
  std::vector<std::string> endless() const {
    return {"run",       scene, "-o", out, "--duration", "1000 s", "--set", "output.every=2 ms",
            "--threads", "1"};
  }
  bool has_frames() const {
    return std::filesystem::exists(folder / "out/frames/surface_0003.vtu");
  }
};

}  // namespace plica::app::test
