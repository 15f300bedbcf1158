// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Bodies that are attached to each other.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double side = 0.06;

Body cube(const Point& at, int cells, int levels = 1) {
  std::vector<TetMesh> meshes;
  for (int i = 0; i < levels; ++i)
    meshes.push_back(
        box_mesh({at, at + Point(side, side, side)}, {cells - i, cells - i, cells - i}));
  Body body = body_of(std::move(meshes), "neo_hookean").body;
  body.surface = boundary_surface(body.levels[0]).surface;
  return body;
}

constexpr double gap = 1e-4;  // between two cubes

/// A fixed cube, and under it one of other cells that is attached to it.
Problem hanging(const std::optional<double>& stiffness, int levels = 1,
                const std::string& cycle = "single") {
  Body upper = cube({0, 0, side + gap}, 4, levels), lower = cube({0, 0, 0}, 3, levels);
  upper.fixed = {HalfSpaceSelection{{0, 0, 2 * side + gap}, {0, 0, -1}}};
  Problem p;
  p.body = join_bodies({{"upper", upper}, {"lower", lower}});
  p.contact.attachments = {
      {.body = "lower", .to = "upper", .reach = 2 * gap, .stiffness = stiffness}};
  p.gravity = {0, 0, -9.81};
  p.integration.cycle = cycle;
  return p;
}

double mass_of(const Body& body) {
  double sum = 0;
  for (const double m : lumped_masses(body.levels[0], {body.material.density})) sum += m;
  return sum;
}

// The 16 points of the lower cube's top share its weight, and no spring shortens the step.
TEST(Attachments, CarryAWeightByTheirSprings) {
  const double weight = 9.81 * mass_of(cube({0, 0, 0}, 3));
  Problem apart = hanging({});
  apart.contact.attachments.clear();
  for (const double stiffness : {30.0, 3000.0, 1e6}) {
    Problem p = hanging(stiffness);
    p.body.regions.at("lower").damping.mass = p.body.regions.at("upper").damping.mass = 30;
    Simulation<Host> s(p);
    for (const Part& part : s.parts())
      if (part.name == "attachments") {
        EXPECT_TRUE(part.in && part.bytes > 0) << part.reason;
        EXPECT_EQ(part.reason, "1 attachment, 16 points");
      }
    EXPECT_EQ(s.levels()[0].critical_step, Simulation<Host>(apart).levels()[0].critical_step);
    while (s.time() < 0.6) advance(s, 10);
    const auto wrenches = s.wrenches();
    ASSERT_EQ(wrenches.size(), 2u);
    EXPECT_NEAR(wrenches[1].force[2], weight, 0.002 * weight) << stiffness;
    EXPECT_NEAR(wrenches[0].force[2], -weight, 0.002 * weight) << stiffness;
    const double even = 0.5 * weight * weight /
                        (16 * stiffness);  // of springs that share it evenly: the least there is
    EXPECT_GE(s.energies().contact, even * (1 - 0.005)) << stiffness;
    EXPECT_LE(s.energies().contact, 1.5 * even) << stiffness;
  }
}

// 16 springs carry the weight, those at the corners more than the mean: eight times as strong as
// that they hold, half as strong they tear, and the body falls.
TEST(Attachments, TearAtTheirStrength) {
  const double weight = 9.81 * mass_of(cube({0, 0, 0}, 3));
  for (const auto& [integrator, step] :
       {std::pair{"symplectic_euler", 0.0}, {"implicit_euler", 1e-3}})
    for (const double part : {8.0, 0.5}) {
      SCOPED_TRACE(integrator + std::string(" ") + std::to_string(part));
      Problem p = hanging(3000);
      p.body.regions.at("lower").damping.mass = p.body.regions.at("upper").damping.mass = 30;
      p.contact.attachments[0].strength = part * weight / 16;
      p.integration.integrator = {integrator};
      if (step > 0) p.integration.macro_step = step;
      Simulation<Host> s(p);
      while (s.time() < 0.3) advance(s, 10);
      EXPECT_EQ(s.torn_attachments(), part > 1 ? 0 : 16);
      EXPECT_NEAR(s.wrenches()[1].force[2], part > 1 ? weight : 0, 0.02 * weight);
      if (part < 1) {
        EXPECT_LT(s.velocities().back()[2], -0.2);
      }
      Simulation<Host> other(p);
      other.restore(s.save());
      EXPECT_EQ(other.torn_attachments(), s.torn_attachments());
    }
}

// One body in two parts bends as it does in one.
TEST(Attachments, MakeOneBeamOfTwoHalves) {
  const auto half = [&](double at) {
    Body body =
        body_of({box_mesh({{at, 0, 0}, {at + 0.2, 0.1, 0.1}}, {6, 3, 3})}, "neo_hookean").body;
    body.surface = boundary_surface(body.levels[0]).surface;
    body.material.young_modulus = 200e3;
    return body;
  };
  Body first = half(0), second = half(0.2);
  first.fixed = {left_face()};
  Body whole = body_of({box_mesh(beam_box, {12, 3, 3})}, "neo_hookean").body;
  whole.material.young_modulus = 200e3, whole.fixed = {left_face()};
  Problem p, one;
  p.body = join_bodies({{"first", first}, {"second", second}});
  one.body = join_bodies({{"whole", whole}});
  p.contact.bodies = false;
  p.contact.attachments = {
      {.body = "second", .to = "first", .where = Box{{0.2, 0, 0}, {0.2, 1, 1}}, .reach = 1e-6}};
  for (Problem* each : {&p, &one}) {
    each->gravity = {0, 0, -9.81}, each->integration.macro_step = 2e-4;
    for (auto& [name, region] : each->body.regions) region.damping.mass = 20;
  }
  Simulation<Host> parts(p), together(one);
  for (auto* s : {&parts, &together}) {
    while (s->time() < 0.6) advance(*s, 100);
  }
  const auto tip = [](const Simulation<Host>& s, const Body& body) {
    double low = 0;
    const auto u = displacements(s, body.levels[0]);
    for (const Point& d : u) low = std::min(low, d[2]);
    return low;
  };
  EXPECT_NEAR(tip(parts, p.body) / tip(together, one.body), 1, 0.02) << tip(together, one.body);
}

// Two cubes fly and spin, attached: springs give each what they take from the other, along the line
// between two places.
TEST(Attachments, KeepMomenta) {
  Body left = cube({0, 0, 0}, 3), right = cube({side + gap, 0, 0}, 4);
  left.initial.velocity = {0, 0.3, 0}, right.initial.velocity = {0.1, -0.3, 0.2};
  Problem p;
  p.body = join_bodies({{"left", left}, {"right", right}});
  p.contact.attachments = {{.body = "left", .to = "right", .reach = 2 * gap}};
  Simulation<Host> s(p);
  const std::vector<double> mass =
      lumped_masses(p.body.levels[0], region_densities(p.body, p.body.levels[0]));
  const auto momenta = [&] {
    std::pair<Point, Point> all{Point::Zero(), Point::Zero()};
    const auto x = s.positions(), v = s.velocities();
    for (std::size_t a = 0; a < mass.size(); ++a)
      all.first += mass[a] * v[a], all.second += mass[a] * x[a].cross(v[a]);
    return all;
  };
  const auto before = momenta();
  const double energy = s.energies().total(), size = 0.3 * s.levels()[0].mass;
  double most = 0;
  while (s.time() < 0.3) {
    advance(s, 10);
    most = std::max(most, s.energies().total());
  }
  const auto after = momenta();
  EXPECT_LE((after.first - before.first).norm(), round_off<double>(5000, size));
  EXPECT_LE((after.second - before.second).norm(), 0.01 * side * size);
  EXPECT_LE(most, 1.02 * energy);
  const auto v = s.velocities();  // neither flies away
  const auto x = s.positions();
  Point apart = Point::Zero();
  for (std::size_t a = 0; a < x.size(); ++a) apart += (a < 64 ? -1.0 / 64 : 1.0 / 125) * x[a];
  EXPECT_LT(apart.norm(), 1.3 * side);
}

TEST(Attachments, HoldInEveryCycle) {
  for (const std::string cycle : {"rs", "rsv", "fas", "him"}) {
    Problem p = hanging({}, 2, cycle);
    for (auto& [name, region] : p.body.regions) region.damping.mass = 20;
    Simulation<Host> s(p);
    while (s.time() < 0.3) advance(s, 1);
    double lowest = 0;
    for (const Point& x : s.positions()) lowest = std::min(lowest, x[2]);
    EXPECT_GT(lowest, -0.15 * side) << cycle;
  }
}

TEST(Attachments, RefuseWhatTheyCannotHold) {
  const auto said = [](const auto& change) {
    Problem p = hanging({});
    change(p, p.contact.attachments[0]);
    return refusal([&] { Simulation<Host> s(p); });
  };
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(said([](Problem&, AttachmentOptions& o) { o.to = "uper"; }), "attachments.0.to: ");
  has(said([](Problem&, AttachmentOptions& o) { o.to = "uper"; }), "upper");
  has(said([](Problem&, AttachmentOptions& o) { o.to = "lower"; }), "expected another one");
  has(said([](Problem&, AttachmentOptions& o) { o.reach = 1e-5; }), "the nearest is 0.0001 m away");
  has(said([](Problem&, AttachmentOptions& o) { o.where = GroupSelection{"top"}; }),
      "expected box, sphere, half_space");
  has(said([](Problem&, AttachmentOptions& o) {
        o.where = Box{{5, 5, 5}, {6, 6, 6}};
      }),
      "attachments.0.where");
  has(said([](Problem&, AttachmentOptions& o) { o.stiffness = -1; }), "attachments.0.stiffness");
  has(said([](Problem& p, AttachmentOptions& o) {
        const AttachmentOptions again = o;
        p.contact.attachments.push_back(again);
      }),
      "attachments.1 holds a point of bodies.lower that attachments.0 holds too");
  Problem alone;
  alone.body = cube({0, 0, 0}, 2);
  alone.contact.attachments = {{.body = "a", .to = "b"}};
  has(refusal([&] { Simulation<Host> s(alone); }), "expected several");
  alone.contact.obstacles.push_back(
      {.shape = PlaneOptions{}, .friction = {}, .motion = {}, .name = "b"});
  has(refusal([&] { Simulation<Host> s(alone); }),
      "b is an obstacle; expected a body, or in place of this contact.obstacles.0.grasp");
}

}  // namespace
