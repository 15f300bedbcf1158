// SPDX-License-Identifier: BSD-3-Clause
// A liver from a surface file, pressed by a tool. One thread simulates 1 ms at a time and has a
// force ready for a haptic device after each. The main thread draws 60 times a second.
//   frame_loop liver.stl [seconds]
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <mutex>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/plica.hpp>
#include <thread>

namespace {

using Tissue = plica::Backend<double, Kokkos::DefaultExecutionSpace>;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr double tick = 1e-3;         // s; forces are read this often
constexpr double frame = 1.0 / 60;    // s
constexpr double fastest_tool = 0.1;  // m/s

/// What the threads exchange.
struct Shared {
  std::atomic<bool> running = true;
  std::mutex mutex;                           // for what follows
  plica::Point tool = plica::Point::Zero();   // where the hand wants the tool [m]
  plica::Point force = plica::Point::Zero();  // what the hand feels [N]
  std::vector<plica::Point> surface;          // what is drawn [m]
  double time = 0;                            // simulated [s]
  std::exception_ptr error;
};

plica::Problem liver(const std::string& file) {
  plica::TriangleSurface surface = plica::read_surface(file);
  for (plica::Point& x : surface.vertices) x *= 0.001;  // millimetres

  plica::Problem problem;
  problem.body.levels = {plica::weighted_lattice(surface, 0.008).mesh};
  problem.body.surface = surface;
  problem.body.material = {"neo_hookean", 5e3, 0.45, 1050};
  problem.body.damping.mass = 20;
  problem.body.fixed = {plica::HalfSpaceSelection{{0, 0, -0.02}, {0, 0, 1}}};

  plica::ObstacleOptions tool;
  tool.name = "tool";
  tool.shape = plica::CapsuleOptions{{0.045, 0, 0.048}, {0.045, 0, 0.148}, 0.008};
  tool.friction = 0.2;
  problem.contact.obstacles = {tool};
  problem.integration.cycle = "single";
  problem.integration.macro_step = tick;  // of as many sub-steps as are stable
  return problem;
}

/// Goes on by a tick at a time, as fast as the clock at most.
void simulate(const std::string& file, double duration, Shared& shared) {
  const Kokkos::ScopeGuard kokkos;
  plica::Simulation<Tissue> simulation(liver(file));
  plica::Point tool = plica::Point::Zero();
  auto due = Clock::now();
  while (simulation.time() < duration && shared.running) {
    {
      const std::lock_guard lock(shared.mutex);
      const plica::Point way = shared.tool - tool;
      tool += std::min(1.0, fastest_tool * tick / std::max(way.norm(), 1e-12)) * way;
    }
    simulation.move_obstacle(0, tool);
    if (const auto failure = simulation.step_checked()) {
      std::cerr << failure->text() << '\n';
      simulation.return_to_last_good();
    }
    const plica::Point force = -simulation.wrenches().front().force;
    const bool new_frame = simulation.macro_steps() % std::lround(frame / tick) == 0;
    {
      const std::lock_guard lock(shared.mutex);
      shared.force = force;
      shared.time = simulation.time();
      if (new_frame) shared.surface = simulation.surface_positions();
    }
    // A late step is not caught up: the body is then slower than the clock for a moment.
    due = std::max(due + std::chrono::duration_cast<Clock::duration>(Seconds(tick)), Clock::now());
    std::this_thread::sleep_until(due);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::cerr << "frame_loop liver.stl [seconds]\n", 2;
  const double duration = argc > 2 ? std::atof(argv[2]) : 1;
  Shared shared;
  std::thread simulation([&] {
    try {
      simulate(argv[1], duration, shared);
    } catch (...) {
      shared.error = std::current_exception();
    }
    shared.running = false;
  });

  double most = 0;
  const auto start = Clock::now();
  for (long n = 1; shared.running; ++n) {
    std::this_thread::sleep_until(start + n * Seconds(frame));  // the renderer waits for the screen
    std::vector<plica::Point> drawn;
    {
      const std::lock_guard lock(shared.mutex);
      shared.tool = {0, 0, -std::min(0.012, 0.03 * shared.time)};  // the hand: 12 mm down
      most = std::max(most, shared.force.z());
      drawn = shared.surface;
    }
    // draw(drawn);
  }
  const double wall = Seconds(Clock::now() - start).count();
  simulation.join();
  try {
    if (shared.error) std::rethrow_exception(shared.error);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  std::cout << "simulated " << shared.time << " s in " << wall << " s; the hand felt up to " << most
            << " N\n";
  return most > 0.05 && most < 50 ? 0 : 1;
}
