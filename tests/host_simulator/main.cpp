// SPDX-License-Identifier: BSD-3-Clause
// The frame loop of a simulator that owns the device: two pieces of tissue, each on an
// execution-space instance of its own, a tool whose contact is the simulator's, and vertex buffers
// for its renderer. Between frames nothing waits.
#include <Kokkos_Core.hpp>
#include <algorithm>
#include <iostream>
#include <plica/drivers/run/simulation.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

namespace {

using Exec = Kokkos::DefaultExecutionSpace;
using Tissue = plica::Backend<float, Exec>;
using Vectors = plica::Vectors<Tissue>;

constexpr double frame = 1.0 / 60;  // s
// m, N/m per surface point, m
constexpr float tool_radius = 0.008f, tool_stiffness = 60.0f, tool_depth = 0.004f;

/// The simulator's own contact: a sphere pushes the surface's points out of it.
struct ToolContact {
  Vectors x, force;
  float tip[3];
  KOKKOS_FUNCTION void operator()(int p) const {
    float d[3], square = 0;
    for (int k = 0; k < 3; ++k) d[k] = x(p, k) - tip[k], square += d[k] * d[k];
    const float distance = Kokkos::sqrt(square), depth = tool_radius - distance;
    for (int k = 0; k < 3; ++k)
      force(p, k) = depth > 0 && distance > 0 ? tool_stiffness * depth / distance * d[k] : 0;
  }
};

/// A block 8 x 8 x 2 cm that lies on the table, at two resolutions.
plica::Problem block(const plica::Point& centre) {
  const plica::Box box{{-0.04, -0.04, 0}, {0.04, 0.04, 0.02}};
  plica::Problem problem;
  problem.body.levels = {plica::box_mesh(box, {16, 16, 4}), plica::box_mesh(box, {12, 12, 3})};
  // cycle rs with pushes on its surface is unstable on nodal ones
  problem.body.element = {"linear"};
  problem.body.material = {"corotational", 5e3, 0.4, 1000};
  problem.body.fixed = {plica::Box{{-1, -1, 0}, {1, 1, 0}}};
  problem.body.damping.mass = 2;
  problem.body.initial.position = centre;
  problem.body.surface = plica::boundary_surface(problem.body.levels[0]).surface;
  problem.gravity = {0, 0, -9.81};
  problem.integration.cycle = "rs";
  problem.surface_forces = true;
  return problem;
}

/// One piece of tissue, its tool, and what the renderer reads: six floats a vertex, position and
/// normal.
class Piece {
 public:
  Piece(const plica::Problem& problem, const Exec& exec)
      : simulation_(problem, exec),
        steps_(std::max(1L, std::lround(frame / simulation_.macro_step()))),
        points_(static_cast<int>(problem.body.surface->vertices.size())),
        x_("x", points_),
        force_("force", points_),
        vertex_buffer("vertex buffer", points_, 6) {
    simulation_.set_external_forces(
        [this](const plica::ForceRequest<Tissue>& request) { push(request); });
  }

  /// Enqueues the steps of one frame and its rendering data.
  void advance() {
    for (long n = 0; n < steps_; ++n) simulation_.step();
    simulation_.read_surface_positions(
        Kokkos::subview(vertex_buffer, Kokkos::ALL, Kokkos::pair<int, int>(0, 3)));
  }
  /// Waits; false where the simulation cannot go on, and cannot come again from its last good
  /// state.
  bool sound() {
    auto failure = simulation_.check();
    if (failure) failure = simulation_.recover(*failure);
    if (failure) std::cerr << failure->text() << '\n';
    return !failure;
  }

 private:
  plica::Simulation<Tissue> simulation_;
  long steps_;
  int points_;
  Vectors x_, force_;

  void push(const plica::ForceRequest<Tissue>& request) const {
    request.read_surface_positions(x_);
    const float depth = tool_depth * static_cast<float>(std::min(1.0, request.time / 0.2));
    Kokkos::parallel_for("tool", Kokkos::RangePolicy<Exec>(request.exec, 0, points_),
                         ToolContact{x_, force_, {tip[0], tip[1], 0.02f + tool_radius - depth}});
    request.add_surface_forces(force_);
  }

 public:
  float tip[2] = {0, 0};
  Kokkos::View<float**, Kokkos::LayoutRight, Tissue::Memory> vertex_buffer;
};

float lowest_near(const Piece& piece) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), piece.vertex_buffer);
  float lowest = 1;
  for (std::size_t p = 0; p < host.extent(0); ++p)
    if (Kokkos::hypot(host(p, 0) - piece.tip[0], host(p, 1) - piece.tip[1]) < 0.001f &&
        host(p, 2) > 0.01f)
      lowest = std::min(lowest, host(p, 2));
  return lowest;
}

}  // namespace

int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  try {
    // one instance for both where there is a single thread, which cannot be divided
    std::vector<Exec> instances = {Exec(), Exec()};
    if (Exec().concurrency() > 1)
      instances = Kokkos::Experimental::partition_space(Exec(), std::vector<int>{1, 1});
    Piece left(block({0, 0, 0.01}), instances[0]), right(block({0.2, 0, 0.01}), instances[1]);
    right.tip[0] = 0.2f;
    for (int n = 1; n <= 30; ++n) {
      left.advance();
      right.advance();
      Kokkos::fence("frame");  // the renderer would draw here
      if (n % 10 == 0 && !(left.sound() && right.sound())) return 1;
    }
    const float a = lowest_near(left), b = lowest_near(right);
    std::cout << "under the tools the surface lies at " << 1e3f * a << " and " << 1e3f * b
              << " mm\n";
    return a < 0.0185f && a > 0.015f && std::abs(a - b) < 1e-5f ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
