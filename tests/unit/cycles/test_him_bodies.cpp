// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/cycles/him/advice.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/him_pieces.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// The hierarchical inverse mass of several bodies, and below given meshes.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double step = 2e-3;

/// A held beam of one irregular mesh with slivers, whose spaces are made of it.
Body held_beam() {
  Body body = him_beam_alone("neo_hookean").body;
  body.fixed = {left_face()};
  body.surface = boundary_surface(body.levels[0]).surface;
  return body;
}

/// A free block of two meshes, stiffer, which turns.
Body free_block() {
  const Box box{{0, 0.5, 0}, {0.1, 0.7, 0.1}};
  Body body =
      body_of({jittered_box(box, {5, 10, 5}), jittered_box(box, {2, 4, 2})}, "neo_hookean").body;
  body.material.young_modulus = 60e3;
  body.initial.angular_velocity = {0, 0, 2};
  body.surface = boundary_surface(body.levels[0]).surface;
  return body;
}

Problem him_of(Body body) {
  Problem p;
  p.body = std::move(body);
  p.gravity = {0, 0, -9.81};
  p.integration.cycle = "him", p.integration.macro_step = step;
  return p;
}

std::vector<Point> displacement_after(const Problem& p, int steps) {
  Simulation<Host> simulation(p);
  const std::vector<Point> start = simulation.positions();
  advance(simulation, steps);
  std::vector<Point> u = simulation.positions();
  for (std::size_t a = 0; a < u.size(); ++a) u[a] -= start[a];
  return u;
}

std::vector<double> masses_of(const Body& body) {
  return lumped_masses(body.levels[0], region_densities(body, body.levels[0]));
}

// The fit's tolerance is 1 % of an eigenvalue, and scales are 4 % apart
TEST(HimOfBodies, MovesEachAsAlone) {
  const Body beam = held_beam(), block = free_block();
  const std::vector<Point> together =
      displacement_after(him_of(join_bodies({{"beam", beam}, {"block", block}})), 100);
  const std::vector<Point> one = displacement_after(him_of(beam), 100),
                           other = displacement_after(him_of(block), 100);
  ASSERT_EQ(together.size(), one.size() + other.size());
  const auto middle = together.begin() + static_cast<std::ptrdiff_t>(one.size());
  const double moved = largest(one), turned = largest(other);
  EXPECT_GT(moved, 0.02);
  EXPECT_LE(largest_difference(std::vector<Point>(together.begin(), middle), one), 2e-3 * moved);
  EXPECT_LE(largest_difference(std::vector<Point>(middle, together.end()), other), 2e-3 * turned);
}

TEST(HimOfBodies, ConservesTheMomentumOfEach) {
  Body left = free_block(), right = free_block();
  left.initial.velocity = {0.3, 0, 0}, right.initial.velocity = {-0.1, 0.2, 0};
  right.initial.position = Point(0.5, 0.6, 0.05), right.initial.angular_velocity = {1, 0, -3};
  Problem p = him_of(join_bodies({{"left", left}, {"right", right}}));
  p.gravity = Point::Zero();
  Simulation<Host> simulation(p);
  const std::vector<double> mass = masses_of(left);
  const auto momenta = [&] {
    std::array<Point, 2> all = {Point::Zero(), Point::Zero()};
    const std::vector<Point> v = simulation.velocities();
    for (std::size_t a = 0; a < v.size(); ++a) all[a / mass.size()] += mass[a % mass.size()] * v[a];
    return all;
  };
  const auto before = momenta();
  advance(simulation, 200);
  const auto after = momenta();
  for (std::size_t b = 0; b < 2; ++b)
    EXPECT_LE((after[b] - before[b]).norm(), round_off<double>(1e4) * before[b].norm()) << b;
}

TEST(HimOfBodies, GivesEachItsOwnSpaces) {
  Body beam = held_beam(), block = free_block();
  block.coarsen = {40};
  const Simulation<Host> simulation(him_of(join_bodies({{"beam", beam}, {"block", block}})));
  const auto& levels = simulation.levels();
  ASSERT_EQ(levels.size(), 5u);  // meshes, slivers of the beam, the block's second mesh, and spaces
  EXPECT_EQ(levels[0].vertices,
            static_cast<int>(beam.levels[0].vertices.size() + block.levels[0].vertices.size()));
  EXPECT_EQ(levels[1].kind, LevelKind::slivers);
  EXPECT_EQ(levels[2].kind, LevelKind::mesh);
  EXPECT_EQ(levels[3].vertices, 150);
  EXPECT_EQ(levels[4].vertices, 40 + 40);
  EXPECT_EQ(simulation.him()->coarsest, 40);
}

// --- Below given meshes ---

Problem sagging_beam(std::vector<TetMesh> meshes) {
  Problem p = body_of(std::move(meshes), "neo_hookean");
  p.body.fixed = {left_face()};
  return him_of(std::move(p.body));
}

// A coarsest mesh too large for a dense matrix gets a space below it, and moves as the finest mesh
// with spaces of its own.
TEST(HimBelowMeshes, MakesASpaceWhereTheCoarsestIsLarge) {
  const TetMesh fine = jittered_box(beam_box, {24, 6, 6}),
                coarse = jittered_box(beam_box, {18, 5, 5});
  ASSERT_GT(coarse.vertices.size(), 600u);
  const Problem p = sagging_beam({fine, coarse});
  const Simulation<Host> simulation(p);
  const auto& levels = simulation.levels();
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_EQ(levels[1].kind, LevelKind::mesh);
  EXPECT_EQ(levels[2].kind, LevelKind::space);
  EXPECT_EQ(levels[2].vertices, 300);
  EXPECT_TRUE(simulation.him()->all_modes);
  Problem alone = p;
  alone.integration.cycle = "single", alone.integration.macro_step = step / 16;
  const std::vector<Point> exact = displacement_after(alone, 16 * 100);
  EXPECT_LE(largest_difference(displacement_after(p, 100), exact), 0.02 * largest(exact));
}

TEST(HimBelowMeshes, MakesTheSpacesThatAreAskedFor) {
  Problem p = him_beam(true);
  p.body.levels = {box_mesh(beam_box, {16, 4, 4}), box_mesh(beam_box, {8, 3, 3})};
  EXPECT_EQ(Simulation<Host>(p).levels().size(), 2u) << "the coarsest mesh is small";
  p.body.coarsen = {60, 30};
  const Simulation<Host> simulation(p);
  ASSERT_EQ(simulation.levels().size(), 4u);
  EXPECT_EQ(simulation.levels()[3].vertices, 30);
}

// --- The automatic step ---

TEST(HimStep, SaysWhereTheAutomaticOneWasHalved) {
  Problem p = him_beam(false, "neo_hookean");
  p.body.levels = {jittered_box(beam_box, {24, 6, 6}), jittered_box(beam_box, {1, 1, 1})};
  p.body.element = {"nodal"};
  const auto said = [&](const Problem& problem) {
    const Simulation<Host> simulation(problem);
    const auto sentences =
        him_advice(problem, *simulation.him(), simulation.levels(), simulation.macro_step());
    return sentences.empty() ? "" : sentences.front();
  };
  EXPECT_EQ(said(him_beam_alone("neo_hookean")), "");
  HimReport halved = *Simulation<Host>(p).him();
  halved.usual_step = 0.004;
  const std::string sentence = him_advice(p, halved, {}, 0.001).front();
  EXPECT_NE(
      sentence.find(
          "no inertia fits the automatic macro step of 0.004 s, and it was halved to 0.001 s"),
      std::string::npos)
      << sentence;
  p.integration.macro_step = 1e-4;
  EXPECT_EQ(Simulation<Host>(p).him()->usual_step, 0) << "it was given";
}

}  // namespace
