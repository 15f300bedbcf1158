// SPDX-License-Identifier: BSD-3-Clause
#include "unit/app/child.hpp"
#include "unit/app/scene_text.hpp"

// The cycle rest as the program runs it.
namespace plica::app::test {
namespace {

class RestProgram : public ProgramTest {
 protected:
  RestProgram()
      : ProgramTest(R"(duration: 1 s
gravity: [0, 0, -1]
body:
  levels: [{box: {size: [0.4, 0.1, 0.1], cells: [8, 2, 2]}}]
  material: {model: neo_hookean, young_modulus: 20 kPa, poisson_ratio: 0.3}
  fixed: [{half_space: {normal: [1, 0, 0]}}]
integration: {cycle: rest}
)") {}
  Json summary() const { return json_of("out/summary.json"); }
};

TEST_F(RestProgram, WritesItsLoadStepsAndItsResidual) {
  const Child run = plica({"run", scene, "-o", out});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.output.find("at rest"), std::string::npos) << run.output;
  const Json json = summary();
  EXPECT_EQ(json["cycle"], "rest");
  EXPECT_EQ(json["macro_steps"], 10);
  EXPECT_EQ(json["frames"], 11);
  EXPECT_LE(json["residual"].get<double>(), 1e-5);
  EXPECT_GT(json["counters"]["newton_iterations"].get<long>(), 0);
}

// A plane below the body does not hold it where gravity lifts it off.
TEST_F(RestProgram, EndsWithThreeWhereThereIsNoEquilibrium) {
  const Child run =
      plica({"run", scene, "-o", out, "--quiet", "--set", "body.fixed=[]", "--set",
             "contact.obstacles=[{plane: {point: [0, 0, -1 mm]}}]", "--set", "gravity=[0, 0, 1]"});
  EXPECT_EQ(run.status, 3) << run.errors;
  EXPECT_NE(run.errors.find("no equilibrium was found at"), std::string::npos) << run.errors;
  EXPECT_EQ(summary()["diagnosis"]["kind"], "solver");
  EXPECT_FALSE(summary()["diagnosis"]["vertex"].is_null());
}

TEST(RestScene, LoadsGrowWithinTheDuration) {
  const std::string text = R"(duration: 4 s
body:
  levels: [{box: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}}]
  fixed: [{half_space: {normal: [1, 0, 0]}}]
integration: {cycle: rest}
)";
  EXPECT_EQ(scene_of(text).problem.integration.rest.ramp, 4.0);
  EXPECT_EQ(scene_of(text, {"integration.rest.ramp=2 s"}).problem.integration.rest.ramp, 2.0);
  EXPECT_EQ(scene_of(text).output.every, (Interval{0, 1}));
  EXPECT_NE(error_of(text, {"integration.integrator=bdf2"}).find("leave it out"),
            std::string::npos);
  EXPECT_NE(error_of(text, {"integration.rest.tolerance=2"}).find("integration.rest.tolerance"),
            std::string::npos);
}

}  // namespace
}  // namespace plica::app::test
