// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/generators.hpp>
#include <sstream>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"

// Standard runs, down to the last bit: the same for every number of threads, and what they were
// when they were pinned. Threads are chosen once per process, so this program runs itself again for
// each number of them.
namespace {

using namespace plica;
using namespace plica::test;

/// A liver that slides over a plate, clamped at its left end, on two meshes.
Problem organ() {
  Problem p;
  for (const char* mesh : {"fine", "coarse"})
    p.body.levels.push_back(
        read_mesh(std::string(PLICA_SOURCE_DIR "/meshes/data/liver_") + mesh + ".msh"));
  const Box box = bounding_box(p.body.levels[0].vertices);
  p.body.element = {"linear"};
  p.body.material = {"neo_hookean", 20e3, 0.4, 1000};
  p.body.damping.mass = 1;
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  p.body.initial.velocity = {0.2, 0, -0.5};
  p.gravity = {0, 0, -9.81};
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, box.min[2] + 1e-3}, {0, 0, 1}}, 0.3, {}});
  return p;
}

Problem explicit_run() {
  Problem p = organ();
  p.integration.cycle = "rsv", p.integration.macro_step = 1e-3;
  return p;
}

Problem him_run() {
  Problem p = organ();
  p.integration.cycle = "him", p.integration.macro_step = 2e-3;
  return p;
}

Problem implicit_run() {
  Problem p = organ();
  p.integration.integrator = {"newmark"}, p.integration.macro_step = 2e-3;
  p.integration.implicit.solver = "conjugate_gradients",
  p.integration.implicit.preconditioner = "multigrid";
  return p;
}

Problem nodal_run() {
  Problem p = explicit_run();
  p.body.element = {"nodal", "linear"};
  return p;
}

Problem nodal_implicit_run() {
  Problem p = implicit_run();
  p.body.element = {"nodal"}, p.integration.implicit.newton_iterations = 1;
  return p;
}

/// FNV-1a over the bytes of numbers.
struct Hash {
  std::uint64_t value = 0xcbf29ce484222325ULL;
  void add(const std::vector<Point>& field) {
    for (const Point& p : field)
      for (int k = 0; k < 3; ++k) {
        unsigned char bytes[sizeof(double)];
        std::memcpy(bytes, &p[k], sizeof bytes);
        for (const unsigned char byte : bytes) value = (value ^ byte) * 0x100000001b3ULL;
      }
  }
};

template <class B>
std::string hash_of(const Problem& problem) {
  Simulation<B> simulation(problem);
  advance(simulation, 40);
  EXPECT_GT(simulation.energies().contact, 0);
  Hash hash;
  hash.add(simulation.positions()), hash.add(simulation.velocities());
  std::ostringstream text;
  text << std::hex << hash.value;
  return text.str();
}

using Hashes = std::map<std::string, std::string>;

/// Of every run on every backend; their names without blanks.
Hashes all_hashes() {
  Hashes hashes;
  const auto add = [&](const std::string& backend, const auto& hash) {
    for (const auto& [name, run] :
         {std::pair{"explicit", &explicit_run}, std::pair{"him", &him_run},
          std::pair{"implicit", &implicit_run}, std::pair{"nodal", &nodal_run},
          std::pair{"nodal_implicit", &nodal_implicit_run}})
      hashes[backend + "." + name] = hash(run());
  };
#define PLICA_HASHES(Real, Exec) \
  add(#Real "." + std::string(Exec::name()), &hash_of<Backend<Real, Exec>>);
  PLICA_FOR_EACH_BACKEND(PLICA_HASHES)
#undef PLICA_HASHES
  return hashes;
}

/// What this program writes when it runs itself with so many threads.
Hashes hashes_with(int threads) {
  const std::string file =
      std::filesystem::temp_directory_path() /
      ("plica-hashes-" + std::to_string(getpid()) + "-" + std::to_string(threads));
  setenv("PLICA_HASHES_TO", file.c_str(), 1);
  setenv("OMP_WAIT_POLICY", "passive", 1);  // there may be fewer processors than threads
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  std::vector<std::string> words = {self, "--gtest_filter=PinnedRuns.*", "--gtest_brief=1",
                                    "--kokkos-num-threads=" + std::to_string(threads)};
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t id = 0;
  int state = -1;
  EXPECT_EQ(posix_spawn(&id, self.c_str(), nullptr, nullptr, pointers.data(), environ), 0);
  waitpid(id, &state, 0);
  unsetenv("PLICA_HASHES_TO"), unsetenv("OMP_WAIT_POLICY");
  EXPECT_TRUE(WIFEXITED(state) && WEXITSTATUS(state) == 0) << threads << " threads";
  Hashes hashes;
  std::ifstream in(file);
  for (std::string name, hash; in >> name >> hash;) hashes[name] = hash;
  std::filesystem::remove(file);
#if defined(KOKKOS_ENABLE_OPENMP)
  EXPECT_EQ(hashes["threads"], std::to_string(threads));
#endif
  hashes.erase("threads");
  return hashes;
}

/// The processor that the compiler tunes for, where runs on it are pinned: tuning decides which
/// products are fused with sums.
#if defined(__tune_znver3__)
constexpr const char* processor = "znver3";
#elif defined(__tune_sapphirerapids__)
constexpr const char* processor = "sapphirerapids";
#elif defined(__tune_rocketlake__)
constexpr const char* processor = "rocketlake";
#else
constexpr const char* processor = "another processor";
#endif

/// By processor and bytes of a vector register, then by precision and run. They hold for GNU 12,
/// optimised. A change of method changes them, which is then what its commit says.
const std::map<std::pair<std::string, int>, Hashes> pinned = {
    {{"rocketlake", 64},
     {{"double.explicit", "42bd0ce9ea681446"},
      {"double.him", "c8b2c936ea87a61e"},
      {"double.implicit", "10c28429650d58d2"},
      {"double.nodal", "7c2d98a87a74a963"},
      {"double.nodal_implicit", "e479d7d3b0600b33"},
      {"float.explicit", "846b92efd59b405c"},
      {"float.him", "cd675ce335d30669"},
      {"float.implicit", "89c37d4e50b54021"},
      {"float.nodal", "dde8a54df638813e"},
      {"float.nodal_implicit", "ea7ec6080a10cabb"}}},
};

#if defined(__GNUC__) && !defined(__clang__) && __GNUC__ == 12 && defined(__OPTIMIZE__) && \
    defined(NDEBUG)
constexpr bool compiler_of_the_pins = true;
#else
constexpr bool compiler_of_the_pins = false;
#endif

TEST(PinnedRuns, AreTheSameForEveryNumberOfThreads) {
  if (const char* file = std::getenv("PLICA_HASHES_TO")) {
    std::ofstream out(file);
    out << "threads " << Kokkos::DefaultHostExecutionSpace().concurrency() << "\n";
    for (const auto& [name, hash] : all_hashes()) out << name << " " << hash << "\n";
    return;
  }
  const Hashes one = hashes_with(1);
  ASSERT_GE(one.size(), is_built<float> ? 10u : 5u);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(hashes_with(threads), one) << threads << " threads";
  const auto pins = pinned.find({processor, PLICA_VECTOR_BYTES});
  for (const auto& [name, hash] : one) {
    const std::string run = name.substr(0, name.find('.')) + name.substr(name.rfind('.'));
    const bool on_host = name.find("Cuda") == std::string::npos;
    const bool is_pinned = pins != pinned.end() && pins->second.contains(run);
    if (is_pinned && on_host && compiler_of_the_pins)
      EXPECT_EQ(hash, pins->second.at(run))
          << name << ", " << processor << ", " << PLICA_VECTOR_BYTES << " bytes";
    else
      std::cout << name << ", " << processor << ", " << PLICA_VECTOR_BYTES << " bytes: " << hash
                << ", not pinned\n";
  }
}

}  // namespace
