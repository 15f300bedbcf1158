// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>

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
  p.body.levels[1] = box_mesh({{0.02, 0, 0}, {0.12, 0.1, 0.1}}, {2, 2, 2});  // mostly
  EXPECT_NO_THROW(Simulation<Host>{p});
}

// A wrong scale or place of a coarse level is an error with the numbers; what round bodies differ by is at most a warning.
TEST(LevelsOfOneBody, HaveOneSizeAndPlace) {
  Problem p = body_of({box_mesh(decimetre, {4, 4, 4}), box_mesh(decimetre, {2, 2, 2})});
  p.integration.cycle = "rs";
  EXPECT_NO_THROW(Simulation<Host>{p});
  EXPECT_TRUE(doubts(p).empty());
  const auto refused = [&](const TetMesh& coarse) {
    p.body.levels[1] = coarse;
    try {
      Simulation<Host> simulation(p);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(
      refused(box_mesh({{0, 0, 0}, {100, 100, 100}}, {2, 2, 2})),
      "body.levels: level 1 is not the body of level 0: 100 x 100 x 100 m, 1e+06 m^3, 1e+09 kg, centroid [50, 50, "
      "50] instead of 0.1 x 0.1 x 0.1 m, 0.001 m^3, 1 kg, centroid [0.05, 0.05, 0.05]; is the file of level 1 in "
      "mm? Then its scale is 0.001");
  EXPECT_NE(refused(box_mesh({{0, 0, 0}, {1e-3, 1e-3, 1e-3}}, {2, 2, 2})).find("the file of level 0 in cm?"),
            std::string::npos);
  EXPECT_NE(refused(box_mesh({{0.05, 0, 0}, {0.15, 0.1, 0.1}}, {2, 2, 2})).find("must lie at the same place"),
            std::string::npos);
  EXPECT_NE(refused(box_mesh({{0, 0, 0}, {0.1, 0.1, 0.04}}, {2, 2, 2})).find("0.1 x 0.1 x 0.04 m"), std::string::npos);
  p.integration.cycle = "single";  // does not look at the second
  EXPECT_EQ(refused(box_mesh({{0, 0, 0}, {100, 100, 100}}, {2, 2, 2})), "");
  EXPECT_TRUE(doubts(p).empty());
  p.integration.cycle = "rs";
  EXPECT_EQ(refused(box_mesh({{0, 0, 0}, {0.1, 0.1, 0.08}}, {2, 2, 2})), "");
  ASSERT_EQ(doubts(p).size(), 1);
  EXPECT_EQ(doubts(p)[0],
            "body.levels: level 1 differs from level 0: 0.1 x 0.1 x 0.08 m, 0.0008 m^3, 0.8 kg, centroid [0.05, 0.05, "
            "0.04] instead of 0.1 x 0.1 x 0.1 m, 0.001 m^3, 1 kg, centroid [0.05, 0.05, 0.05]");
}

// The same body, but denser on its coarse level: a region that has lost its name there.
TEST(LevelsOfOneBody, HaveOneMass) {
  Problem p = body_of({box_mesh(decimetre, {4, 4, 4}), box_mesh(decimetre, {2, 2, 2})});
  p.integration.cycle = "rs";
  p.body.levels[1].region.assign(p.body.levels[1].tets.size(), 0);
  p.body.levels[1].region_names = {"bone"};
  p.body.regions["bone"].density = 2 * p.body.material.density;
  ASSERT_EQ(doubts(p).size(), 1);
  EXPECT_NE(doubts(p)[0].find("0.001 m^3, 2 kg"), std::string::npos) << doubts(p)[0];
  p.body.regions["bone"].density = 10 * p.body.material.density;
  EXPECT_THROW(Simulation<Host>{p}, InputError);
}

}  // namespace
