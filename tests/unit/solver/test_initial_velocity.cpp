// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Velocity fields at the start: a twist and parts, wherever the body is placed; and levels that are not of one body.
namespace {

using namespace plica;
using namespace plica::test;

std::vector<Point> start_velocity(const Problem& p) { return Simulation<Host>(p).velocities(); }

TEST(InitialVelocity, TwistGrowsAlongItsAxis) {
  Problem p = cube_levels(2, 4, "rs");
  p.body.initial.position = Point(3, 2, 1);
  p.body.initial.twist = TwistOptions{{0.01, 0.05, 0.05}, {0.06, 0.05, 0.05}, 30};
  const auto v = start_velocity(p);
  const auto& x = p.body.levels[0].vertices;
  for (std::size_t a = 0; a < v.size(); ++a) {
    const double omega = 30 * (x[a][0] - 0.01) / 0.05;  // beyond both points too
    const Point want(0, -omega * (x[a][2] - 0.05), omega * (x[a][1] - 0.05));
    EXPECT_LE((v[a] - want).norm(), round_off<double>(20, 3));
  }
}

TEST(InitialVelocity, AllPartsAddUpAndWhatIsFixedStays) {
  Problem p = cube_levels(2, 4, "rs");
  p.body.fixed = {left_face()};
  p.body.initial.velocity = {1, 0, 0};
  p.body.initial.parts.push_back({HalfSpaceSelection{{0.09, 0, 0}, {-1, 0, 0}}, {0, 0, -2}});
  p.body.initial.parts.push_back({Box{{-1, 0, 0}, {1, 0.01, 1}}, {0, 3, 0}});
  p.body.initial.twist = TwistOptions{{0, 0, 0}, {0, 0, 1}, 0};
  const auto v = start_velocity(p);
  const auto& x = p.body.levels[0].vertices;
  for (std::size_t a = 0; a < v.size(); ++a) {
    const Point want(1, x[a][1] <= 0.01 ? 3 : 0, x[a][0] >= 0.09 ? -2 : 0);
    EXPECT_EQ(v[a], x[a][0] == 0 ? Point(0, 0, 0) : want);
  }
}

TEST(InitialVelocity, APartHasAVertexOfTheFinestLevel) {
  Problem p = cube_levels(2, 4, "rs");
  p.body.initial.parts.push_back({BallSelection{{0.025, 0.1, 0.1}, 0.003}, {0, 0, 1}});  // none of level 1 is there
  EXPECT_NO_THROW(start_velocity(p));
  p.body.initial.parts.push_back({BallSelection{{0.03, 0.1, 0.1}, 0.003}, {0, 0, 1}});
  try {
    start_velocity(p);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("body.initial.parts.1"), std::string::npos) << e.what();
  }
}

TEST(LevelsOfOneBody, MustOverlap) {
  Problem p = body_of({box_mesh(decimetre, {4, 4, 4}), box_mesh({{0.4, 0, 0}, {0.5, 0.1, 0.1}}, {2, 2, 2})});
  EXPECT_NO_THROW(Simulation<Host>{p});  // `single` does not look at the second
  p.integration.cycle = "rs";
  try {
    Simulation<Host> simulation(p);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "body.levels: levels 0 and 1 do not overlap, they are 0.3 m apart; expected meshes of one body");
  }
  p.body.levels[1] = box_mesh({{0.09, 0, 0}, {0.19, 0.1, 0.1}}, {2, 2, 2});  // barely
  EXPECT_NO_THROW(Simulation<Host>{p});
}

}  // namespace
