// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/error.hpp>
#include <plica/drivers/solver/diagnose.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Bodies that start flat, inside out or at random, and what becomes of them.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class BadStates : public testing::Test {};
TYPED_TEST_SUITE(BadStates, EachBackend);

Problem deformed(const std::string& material, const Point& stretch, std::optional<int> random = {}) {
  Problem p = small_cube(material, 2);
  p.body.material.allow_inversion = true;
  p.body.initial.stretch = stretch, p.body.initial.random = random;
  return p;
}

std::string refusal(const Problem& p) {
  try {
    const Simulation<Host> simulation(p);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TYPED_TEST(BadStates, StartsAreWhatTheySay) {
  Problem p = cube_levels(2, 3, "rs");
  p.body.levels.back() = p.body.levels.front();  // of the same vertices: its state is level 0's
  p.body.fixed = {left_face()};
  p.body.initial.position = Point(1, 2, 3);
  p.body.initial.stretch = {5, 0, -1};
  const Simulation<TypeParam> simulation(p);
  const auto& rest = p.body.levels[0].vertices;
  const double close = round_off<typename TypeParam::Real>(20);
  for (int level = 0; level < 2; ++level) {
    const auto x = simulation.positions(level);
    for (std::size_t a = 0; a < x.size(); ++a) {
      const Point from = rest[a] - Point(0.05, 0.05, 0.05), still = Point(1, 2, 3) + from;
      const Point moved = Point(1, 2, 3) + Point(5 * from[0], 0, -from[2]);
      EXPECT_LE((x[a] - (rest[a][0] == 0 ? still : moved)).norm(), close) << level << " " << a;
    }
  }
}

TEST(RandomStarts, LieInTheBoxAndRepeat) {
  const auto first = Simulation<Host>(deformed("corotational", Point::Ones(), 3)).positions();
  for (const Point& x : first)
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(x[k] >= 0 && x[k] <= 0.1) << x;
  EXPECT_TRUE(same_bits(Simulation<Host>(deformed("corotational", Point::Ones(), 3)).positions(), first));
  EXPECT_GT(largest_difference(Simulation<Host>(deformed("corotational", Point::Ones(), 4)).positions(), first), 0.02);
  // limits are those of the body at rest
  EXPECT_EQ(Simulation<Host>(deformed("corotational", Point::Ones(), 3)).levels()[0].critical_step,
            Simulation<Host>(deformed("corotational", Point::Ones())).levels()[0].critical_step);
}

// neo_hookean's mirrored start is far stiffer: it takes Newton's method. From random starts it may come to rest in a tangle: that is
// not asked for.
TEST(BadStates, NewtonTurnsAMirroredBodyBack) {
  Problem p = deformed("neo_hookean", {1, 1, -1});
  p.body.damping.mass = 20;
  p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 2e-3;
  p.integration.implicit.newton_iterations = 60;
  p.integration.implicit.unfinished = "halve", p.integration.implicit.halvings = 12;
  Simulation<Host> simulation(p);
  const double before = simulation.energies().elastic;
  advance(simulation, 500);
  const auto J = simulation.element_fields().J;
  EXPECT_GT(*std::min_element(J.begin(), J.end()), 0.99);
  EXPECT_LT(simulation.energies().elastic, 1e-9 * before);
}

// Materials that claim it find back to their shape, up to a rigid motion; steps that are linearised once are retried by halves.
TYPED_TEST(BadStates, RecoverInMaterialsThatSaySo) {
  for (const char* material : {"corotational", "neo_hookean"}) {
    ASSERT_TRUE(recovers(material));
    std::vector<Problem> starts = {deformed(material, {1, 1, 0}), deformed(material, {5, 1, 1})};
    if (std::string(material) == "corotational")
      for (const Problem& more :
           {deformed(material, {1, 1, -1}), deformed(material, Point::Ones(), 1), deformed(material, Point::Ones(), 2)})
        starts.push_back(more);
    for (std::size_t i = 0; i < starts.size(); ++i) {
      SCOPED_TRACE(material + (" " + std::to_string(i)));
      Problem p = starts[i];
      p.body.damping.mass = 20;
      p.integration.integrator = {"implicit_euler"};
      p.integration.macro_step = 2e-3;
      p.integration.retry.halvings = 10;
      Simulation<TypeParam> simulation(p);
      const double before = simulation.energies().elastic;
      advance(simulation, 500);
      const auto J = simulation.element_fields().J;
      EXPECT_GT(*std::min_element(J.begin(), J.end()), 0.5);
      EXPECT_LT(simulation.energies().elastic, 1e-6 * before);
    }
  }
}

TEST(InvertedStarts, AreRefusedWhereTheyAreNotAllowed) {
  Problem p = deformed("neo_hookean", {1, 1, -1});
  EXPECT_EQ(refusal(p), "");
  p.body.material.allow_inversion.reset();
  const std::string said = refusal(p);
  for (const char* part : {"body.initial", "48 of 48 elements", "J = -1", "body.material.allow_inversion: true"})
    EXPECT_NE(said.find(part), std::string::npos) << said;
  p.body.initial.stretch = {1, -1, -1};  // turned about x
  EXPECT_EQ(refusal(p), "");
  p.body.material = {"corotational", 20e3, 0.35, 1000};
  p.body.initial.stretch = {1, 1, 0};
  EXPECT_EQ(refusal(p), "");
  p.body.material.allow_inversion = false;
  EXPECT_NE(refusal(p).find("body.initial"), std::string::npos);
}

TEST(InvertedStarts, AreDoubtedInMaterialsThatDoNotRecover) {
  const auto said = [](const std::string& material) {
    std::string all;
    for (const std::string& doubt : doubts(deformed(material, {1, 1, -1}))) all += doubt;
    return all;
  };
  EXPECT_NE(said("st_venant_kirchhoff").find("nothing that turns them back"), std::string::npos);
  EXPECT_EQ(said("corotational"), "");
  EXPECT_EQ(said("neo_hookean"), "");
}

TEST(InitialShape, SenselessOnesAreRefused) {
  Problem p = deformed("corotational", {1, 2, 1}, 3);
  EXPECT_NE(refusal(p).find("one of them"), std::string::npos);
  p.body.initial.random = -1;
  EXPECT_NE(refusal(p).find("body.initial.random"), std::string::npos);
  p.body.initial.random.reset();
  p.body.initial.stretch[1] = std::numeric_limits<double>::infinity();
  EXPECT_NE(refusal(p).find("body.initial.stretch"), std::string::npos);
}

// Whoever asks for it is told of inverted elements in any material
TYPED_TEST(BadStates, InversionCanBeForbiddenToEachMaterial) {
  for (const Choice& material : materials()) {
    SCOPED_TRACE(material.name);
    for (const bool allowed : {true, false}) {
      Problem p = small_cube(material.name);
      p.body.material.allow_inversion = allowed;
      p.integration.macro_step = 1e-6;
      Simulation<TypeParam> simulation(p);
      std::vector<Point> u, v(p.body.levels[0].vertices.size(), Point::Zero());
      for (const Point& x : p.body.levels[0].vertices) u.push_back({0, 0, -2 * x[2]});
      simulation.set_state(u, v);
      simulation.step();
      const auto bad = simulation.check();
      EXPECT_EQ(bad ? bad->kind : "", allowed ? "" : "inverted");
    }
  }
}

}  // namespace
