// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>

#include "support/bodies.hpp"

// Every option out of its range is refused by its name, with the value and what is expected.
namespace {

using namespace plica;
using namespace plica::test;

struct Bad {
  std::function<void(Problem&)> change;
  std::vector<std::string> says;
};

const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();

const std::vector<Bad> bad_problems = {
    {[](Problem& p) { p.body.levels.clear(); }, {"body.levels", "at least one mesh"}},
    {[](Problem& p) { p.body.levels[0].tets.clear(); }, {"level 0 has no tetrahedron"}},
    {[](Problem& p) { p.body.material.model = "neohookean"; }, {"neohookean", "did you mean 'neo_hookean'?"}},
    {[](Problem& p) { p.body.material.young_modulus = -1; }, {"body.material.young_modulus is -1", "above 0 Pa"}},
    {[](Problem& p) { p.body.material.young_modulus = nan; }, {"body.material.young_modulus is"}},
    {[](Problem& p) { p.body.material.poisson_ratio = 0.5; }, {"body.material.poisson_ratio is 0.5", "below 0.5"}},
    {[](Problem& p) { p.body.material.density = 0; }, {"body.material.density is 0"}},
    {[](Problem& p) { p.body.material.density = infinite; }, {"body.material.density is inf"}},
    {[](Problem& p) { p.body.regions["fat"]; }, {"unknown region 'fat'"}},
    {[](Problem& p) { p.body.damping.mass = -2; }, {"body.damping.mass is -2"}},
    {[](Problem& p) { p.gravity[1] = infinite; }, {"gravity is inf"}},
    {[](Problem& p) { p.body.initial.velocity[2] = nan; }, {"body.initial.velocity"}},
    {[](Problem& p) { p.body.initial.position = Point(nan, 0, 0); }, {"body.initial.position"}},
    {[](Problem& p) { p.integration.cycle = "rsvv"; }, {"did you mean 'rsv'?"}},
    {[](Problem& p) { p.integration.distribution = "equl"; }, {"did you mean 'equal'?"}},
    {[](Problem& p) { p.integration.integrator = {"rk5"}; }, {"did you mean 'rk4'?"}},
    {[](Problem& p) { p.integration.integrator = {}; }, {"integration.integrator has 0 entries for 1 levels"}},
    {[](Problem& p) {
       p.integration.substeps = {1, 2, 3};
     },
     {"integration.substeps has 3 entries for 1 levels"}},
    {[](Problem& p) { p.integration.substeps = {-1}; }, {"integration.substeps is -1"}},
    {[](Problem& p) { p.integration.macro_step = 0; }, {"integration.macro_step is 0"}},
    {[](Problem& p) { p.integration.shift_to_coarsest = 1; }, {"integration.shift_to_coarsest is 1"}},
    {[](Problem& p) { p.integration.safety = 1.1; }, {"integration.safety is 1.1"}},
    {[](Problem& p) { p.integration.switch_threshold = 0; }, {"integration.switch_threshold is 0"}},
    {[](Problem& p) { p.integration.outside = "clip"; }, {"clip", "clamp"}},
    {[](Problem& p) { p.integration.implicit.relative_residual = 1; }, {"integration.implicit.relative_residual is 1"}},
    {[](Problem& p) { p.integration.implicit.max_iterations = 0; }, {"integration.implicit.max_iterations is 0"}},
    {[](Problem& p) { p.integration.implicit.newton_iterations = 0; }, {"newton_iterations is 0"}},
    {[](Problem& p) {
       p.contact.obstacles.push_back({SphereOptions{}, {}, Point::Zero()});
     },
     {"no surface"}},
    {[](Problem& p) { p.contact.stiffness_scale = 0; }, {"contact.stiffness_scale is 0"}},
    {[](Problem& p) { p.contact.damping_scale = -1; }, {"contact.damping_scale is -1"}},
};

std::string refusal(const Problem& p) {
  try {
    validate(p);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Validate, AcceptsTheDefaults) { EXPECT_EQ(refusal(small_cube()), ""); }

TEST(Validate, NamesEveryBadOption) {
  for (const Bad& bad : bad_problems) {
    Problem p = small_cube();
    bad.change(p);
    const std::string text = refusal(p);
    for (const std::string& part : bad.says)
      EXPECT_NE(text.find(part), std::string::npos) << part << " not in: " << text;
  }
}

TEST(Validate, ContactNeedsASurfaceWithAnArea) {
  Problem p = small_cube();
  p.body.surface = TriangleSurface{{{0, 0, 0}}, {}};
  EXPECT_EQ(refusal(p), "");
  p.contact.obstacles = {{PlaneOptions{}, {}, Point::Zero()}};
  EXPECT_NE(refusal(p).find("no triangle"), std::string::npos);
}

TEST(Validate, ChecksObstacles) {
  const auto with = [](ObstacleOptions o) {
    Problem p = small_cube();
    p.body.surface = TriangleSurface{{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}, {{0, 1, 2}}};
    p.contact.obstacles = {std::move(o)};
    return refusal(p);
  };
  EXPECT_EQ(with({PlaneOptions{}, 0.3, Point::Zero()}), "");
  EXPECT_EQ(with({BowlOptions{{0, 0, 0}, 1, 0}, {}, Point::Zero()}), "");
  EXPECT_NE(with({PlaneOptions{{0, 0, 0}, {0, 0, 0}}, {}, Point::Zero()}).find("normal"), std::string::npos);
  EXPECT_NE(with({SphereOptions{{0, 0, 0}, -1}, {}, Point::Zero()}).find("radius is -1"), std::string::npos);
  EXPECT_NE(with({BowlOptions{{0, 0, 0}, 1, 1.5}, {}, Point::Zero()}).find("rim is 1.5"), std::string::npos);
  EXPECT_NE(with({PlaneOptions{}, -0.1, Point::Zero()}).find("friction is -0.1"), std::string::npos);
  EXPECT_NE(with({PlaneOptions{}, {}, Point(nan, 0, 0)}).find("contact.obstacles.0.velocity"), std::string::npos);
}

}  // namespace
