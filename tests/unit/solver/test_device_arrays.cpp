// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Positions and velocities through arrays of the caller's, on the device.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class DeviceArrays : public testing::Test {};
TYPED_TEST_SUITE(DeviceArrays, EachBackend);

template <class View>
std::vector<Point> host_copy(const View& view) {
  Kokkos::fence();
  const Kokkos::View<typename View::value_type**, Kokkos::LayoutRight, typename View::memory_space> packed(
      "packed", view.extent(0), 3);
  Kokkos::deep_copy(packed, Kokkos::subview(view, Kokkos::ALL, Kokkos::pair<int, int>(0, 3)));
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), packed);
  std::vector<Point> points;
  for (std::size_t a = 0; a < host.extent(0); ++a)
    points.emplace_back(static_cast<double>(host(a, 0)), static_cast<double>(host(a, 1)),
                        static_cast<double>(host(a, 2)));
  return points;
}

template <class B>
Problem thrown_cube() {
  Problem p = cube_levels(2, 4, "rsv");
  p.body.initial.position = Point(1, -2, 0.5);
  p.body.initial.angular_velocity = {0, 30, 0};
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.04, 1);
  return p;
}

TYPED_TEST(DeviceArrays, OfEveryLayoutAndPrecisionAreFilled) {
  using Memory = typename TypeParam::Memory;
  Simulation<TypeParam> simulation(thrown_cube<TypeParam>());
  advance(simulation, 3);
  for (int level : {0, 1}) {
    const auto n = simulation.positions(level).size();
    const Kokkos::View<float* [3], Kokkos::LayoutRight, Memory> right("right", n);
    const Kokkos::View<double* [3], Kokkos::LayoutLeft, Memory> left("left", n);
    const Kokkos::View<double**, Kokkos::LayoutRight, Memory> wide("wide", n, 8);  // part of a structure of 8 numbers
    const auto columns = Kokkos::subview(wide, Kokkos::ALL, Kokkos::pair<int, int>(2, 5));
    simulation.read_positions(right, level);
    simulation.read_velocities(left, level);
    simulation.read_positions(columns, level);
    EXPECT_LE(largest_difference(host_copy(right), simulation.positions(level)), round_off<float>(4, 3));
    EXPECT_EQ(host_copy(left), simulation.velocities(level));
    EXPECT_LE(largest_difference(host_copy(columns), simulation.positions(level)),
              round_off<typename TypeParam::Real>(4, 3));
  }
}

TYPED_TEST(DeviceArrays, HoldTheSurface) {
  Simulation<TypeParam> simulation(thrown_cube<TypeParam>());
  advance(simulation, 3);
  const auto n = simulation.surface_positions().size();
  const Kokkos::View<float*[3], Kokkos::LayoutRight, typename TypeParam::Memory> x("x", n), v("v", n);
  simulation.read_surface_positions(x);
  simulation.read_surface_velocities(v);
  EXPECT_LE(largest_difference(host_copy(x), simulation.surface_positions()), round_off<float>(4, 3));
  EXPECT_LE(largest_difference(host_copy(v), simulation.surface_velocities()), round_off<float>(4, 3));
}

// what is written continues as if it had been set from the host
TYPED_TEST(DeviceArrays, ReplaceTheState) {
  for (const char* cycle : {"single", "rs", "rv", "rsv", "rsv_sv"}) {
    Problem p = thrown_cube<TypeParam>();
    p.integration.cycle = cycle;
    Simulation<TypeParam> from_host(p), from_device(p), source(p);
    advance(source, 5);
    const auto n = source.positions().size();
    const Vectors<TypeParam> u = source.displacement(), v("v", n);
    Kokkos::View<double* [3], Kokkos::LayoutLeft, typename TypeParam::Memory> x("x", n);
    source.read_positions(x);
    source.read_velocities(v);
    auto moved = host_copy(u);
    from_host.set_state(moved, source.velocities());
    from_device.write_state(Kokkos::View<const double* [3], Kokkos::LayoutLeft, typename TypeParam::Memory>(x), v);
    advance(from_host, 4);
    advance(from_device, 4);
    const double scale = 2e-3;  // of the differences that round-off of positions a metre away makes
    for (int level = 0; level < static_cast<int>(from_host.levels().size()); ++level)
      EXPECT_LE(largest_difference(from_device.positions(level), from_host.positions(level)),
                round_off<typename TypeParam::Real>(1e3 * scale, 3))
          << cycle;
  }
}

TYPED_TEST(DeviceArrays, OfAnotherSizeAreRefused) {
  Simulation<TypeParam> simulation(thrown_cube<TypeParam>());
  const Vectors<TypeParam> few("few", 7);
  EXPECT_THROW(simulation.read_positions(few), InputError);
  EXPECT_THROW(simulation.read_velocities(few, 1), InputError);
  EXPECT_THROW(simulation.read_surface_positions(few), InputError);
  EXPECT_THROW(simulation.write_state(few, few), InputError);
  const auto before = simulation.positions();
  EXPECT_THROW(simulation.write_state(Vectors<TypeParam>("x", before.size()), few), InputError);
  EXPECT_EQ(simulation.positions(), before);
  EXPECT_THROW(simulation.read_positions(simulation.velocity(1), 2), InputError);
  const Kokkos::View<float**, typename TypeParam::Memory> flat("flat", simulation.positions().size(), 2);
  EXPECT_THROW(simulation.read_positions(flat), InputError);
}

}  // namespace
