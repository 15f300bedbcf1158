// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <plica/drivers/app/commands/run_output.hpp>
#include <plica/drivers/app/scene/units.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <stdexcept>

#include "support/refusal.hpp"
#include "unit/app/child.hpp"
#include "unit/app/scene_text.hpp"

// Selections, motions, loads and tools as scenes write them.
namespace plica::app::test {
namespace {

using std::numbers::pi;

Scene with(const std::vector<std::string>& sets) { return scene_of(sound_scene, sets); }

TEST(Inputs, Selections) {
  const Scene scene =
      with({"body.fixed=[{box: {min: [0, 0, 0], max: [0, 1, 1]}}, {sphere: {radius: 2 cm}},"
            " {half_space: {point: [0, 0, 1 cm]}}, {nearest: [1, 2, 3 mm]}, {region: stiff}]",
            "body.regions.stiff={where: {half_space: {point: [5 cm, 0, 0], normal: [1, 0, 0]}}, "
            "density: 3}"});
  const auto& fixed = scene.problem.body.fixed;
  ASSERT_EQ(fixed.size(), 5u);
  EXPECT_EQ(std::get<Box>(fixed[0].where).max, Point(0, 1, 1));
  EXPECT_DOUBLE_EQ(std::get<BallSelection>(fixed[1].where).radius, 0.02);
  EXPECT_EQ(std::get<HalfSpaceSelection>(fixed[2].where).point, Point(0, 0, 0.01));
  EXPECT_EQ(std::get<HalfSpaceSelection>(fixed[2].where).normal, Point::UnitZ());
  EXPECT_EQ(std::get<NearestSelection>(fixed[3].where).to, Point(1, 2, 0.003));
  EXPECT_EQ(std::get<RegionSelection>(fixed[4].where).name, "stiff");
  const RegionOptions& stiff = scene.problem.body.regions.at("stiff");
  EXPECT_DOUBLE_EQ(std::get<HalfSpaceSelection>(*stiff.where).point[0], 0.05);
  EXPECT_EQ(stiff.density, 3);
}

TEST(Inputs, Supports) {
  const Scene scene =
      with({"body.fixed=[{nearest: [0, 0, 0], along: [x, z]}, {nearest: [0, 1, 0], along: y}, "
            "{nearest: [0, 2, 0], slide: normal}, {nearest: [0, 3, 0], slide: [0, 2, 1]}]",
            "body.prescribed=[{nearest: [1, 0, 0], rotate: {axis: [0, 0, 2], about: [1 cm, 0, 0], "
            "curve: [{time: 0, angle: 0}, {time: 1 s, angle: 180 deg}]}}]"});
  const auto& fixed = scene.problem.body.fixed;
  EXPECT_EQ(fixed[0].along, (std::vector<std::string>{"x", "z"}));
  EXPECT_EQ(fixed[1].along, std::vector<std::string>{"y"});
  EXPECT_FALSE(fixed[1].slide);
  EXPECT_EQ(fixed[2].slide, Point(0, 0, 0));
  EXPECT_EQ(fixed[3].slide, Point(0, 2, 1));
  const std::optional<Turn>& turn = scene.problem.body.prescribed[0].rotate;
  ASSERT_TRUE(turn && turn->about);
  EXPECT_EQ(turn->axis, Point(0, 0, 2));
  EXPECT_EQ(*turn->about, Point(0.01, 0, 0));
  EXPECT_DOUBLE_EQ(std::get<PathTurn>(turn->angle).knots.at(1).angle, pi);
}

TEST(Inputs, Motions) {
  const Scene scene =
      with({"body.prescribed=[{nearest: [0, 0, 0], velocity: [1 cm/s, 0, 0]}, {nearest: [1, 0, 0], "
            "curve: "
            "[{time: 0, displacement: [0, 0, 0]}, {time: 20 ms, displacement: [0, 0, 3 mm]}]}]",
            "contact.obstacles.0.sine={amplitude: [0, 0, 1 mm], frequency: 3 Hz, phase: -90 deg}"});
  const auto& given = scene.problem.body.prescribed;
  EXPECT_EQ(std::get<SteadyMotion>(given[0].motion).velocity, Point(0.01, 0, 0));
  const auto& knots = std::get<PathMotion>(given[1].motion).knots;
  ASSERT_EQ(knots.size(), 2u);
  EXPECT_DOUBLE_EQ(knots[1].time, 0.02);
  EXPECT_EQ(knots[1].displacement, Point(0, 0, 0.003));
  const auto& sine = std::get<SineMotion>(scene.problem.contact.obstacles[0].motion);
  EXPECT_EQ(sine.frequency, 3);
  EXPECT_DOUBLE_EQ(sine.phase, -pi / 2);
}

TEST(Inputs, Turns) {
  const auto turn = [](const std::string& keys) {
    return with({"contact.obstacles.0.rotate={" + keys + "}"}).problem.contact.obstacles[0].turn;
  };
  const auto steady = turn(
      "axis: [0, 2, 0], about: [1 cm, 0, 0], rotation: [180 deg, 0, 0], angular_velocity: 90 "
      "deg/s");
  EXPECT_EQ(steady->axis, Point(0, 2, 0));
  EXPECT_EQ(*steady->about, Point(0.01, 0, 0));
  EXPECT_DOUBLE_EQ(steady->rotation[0], pi);
  EXPECT_DOUBLE_EQ(std::get<SteadyTurn>(steady->angle).angular_velocity, pi / 2);
  const auto path = turn("curve: [{time: 0, angle: 0 deg}, {time: 20 ms, angle: -30 deg}]");
  EXPECT_FALSE(path->about);
  EXPECT_DOUBLE_EQ(std::get<PathTurn>(path->angle).knots.at(1).angle, -pi / 6);
  const auto sine = turn("sine: {amplitude: 10 deg, frequency: 2 Hz}");
  EXPECT_DOUBLE_EQ(std::get<SineTurn>(sine->angle).amplitude, pi / 18);
  const auto refused = [&](const std::string& keys) {
    return plica::test::refusal([&] { turn(keys); });
  };
  EXPECT_NE(refused("axs: [0, 0, 1]").find("rotate: unknown key 'axs'; did you mean 'axis'?"),
            std::string::npos);
  EXPECT_NE(refused("axis: [0, 0, 0]").find("rotate.axis"), std::string::npos);
  EXPECT_NE(refused("angular_velocity: 3 Hz").find("rotate.angular_velocity"), std::string::npos);
  EXPECT_NE(refused("angular_velocity: 3 rad/s, curve: [{time: 0, angle: 0}]").find("curve"),
            std::string::npos);
}

TEST(Inputs, Loads) {
  const Scene scene = with(
      {"body.loads=[{half_space: {}, traction: [0, 0, -2 kPa]}, {nearest: [0, 0, 0], force: [1 mN, "
       "0, 0],"
       " ramp: 50 ms}, {group: side, force: [0, 0, 0], curve: [{time: 1, factor: 2}]},"
       " {region: side, force: [0, 0, 0], sine: {frequency: 4}}]",
       "body.regions.side={where: {sphere: {radius: 5 cm}}}"});
  const auto& loads = scene.problem.body.loads;
  ASSERT_EQ(loads.size(), 4u);
  EXPECT_EQ(std::get<Traction>(loads[0].load).value, Point(0, 0, -2000));
  EXPECT_TRUE(std::holds_alternative<ConstantCourse>(loads[0].course));
  EXPECT_EQ(std::get<TotalForce>(loads[1].load).value, Point(0.001, 0, 0));
  EXPECT_DOUBLE_EQ(std::get<RampCourse>(loads[1].course).duration, 0.05);
  EXPECT_EQ(std::get<PolygonCourse>(loads[2].course).knots[0].factor, 2);
  EXPECT_EQ(std::get<SineCourse>(loads[3].course).frequency, 4);
}

TEST(Inputs, Shapes) {
  const Scene scene = with(
      {"contact.obstacles=[{capsule: {from: [0, 0, 0], to: [0, 0, 1], radius: 1 cm}}, {box: {size: "
       "[1, 2, 3], rotation: [0, 0, 90 deg]}}, {cylinder: {from: [0, 0, 0], to: [1, 0, 0], radius: "
       "2}}]"});
  const auto& obstacles = scene.problem.contact.obstacles;
  ASSERT_EQ(obstacles.size(), 3u);
  EXPECT_DOUBLE_EQ(std::any_cast<const CapsuleOptions&>(obstacles[0].shape).radius, 0.01);
  EXPECT_DOUBLE_EQ(std::any_cast<const BlockOptions&>(obstacles[1].shape).rotation[2], pi / 2);
  EXPECT_EQ(std::any_cast<const CylinderOptions&>(obstacles[2].shape).to, Point(1, 0, 0));
}

std::string obj_of(const TriangleSurface& surface) {
  std::ostringstream text;
  for (const Point& p : surface.vertices)
    text << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  for (const auto& t : surface.triangles)
    text << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  return text.str();
}

TEST(Inputs, ToolsAreScaledTurnedAndMoved) {
  const TemporaryFolder folder;
  TriangleSurface block = boundary_surface(box_mesh({{0, 0, 0}, {10, 20, 30}}, {1, 1, 1})).surface;
  std::ofstream(folder / "tool.obj") << obj_of(block);
  const std::string file = (folder / "tool.obj").string();
  const Scene scene = with({"contact.obstacles.0={surface: {file: " + file +
                            ", scale: 0.001, rotation: [0, 0, 90 deg], position: [1, 2, 3], cells: "
                            "20}, friction: 0.1}"});
  const auto& tool = std::any_cast<const SurfaceOptions&>(scene.problem.contact.obstacles[0].shape);
  const Box box = bounding_box(tool.surface.vertices);
  EXPECT_LE((box.min - Point(0.98, 2, 3)).norm(), 1e-12);
  EXPECT_LE((box.max - Point(1, 2.01, 3.03)).norm(), 1e-12);
  EXPECT_EQ(tool.cells, 20);

  block.triangles.pop_back();
  std::ofstream(folder / "open.obj") << obj_of(block);
  const auto opened = [&](const std::string& more) {
    return with({"contact.obstacles.0={surface: {file: " + (folder / "open.obj").string() +
                 ", scale: 0.001" + more + "}}"});
  };
  const auto thickness = [](const Scene& of) {
    return std::any_cast<const SurfaceOptions&>(of.problem.contact.obstacles[0].shape).thickness;
  };
  const auto warned = [](const Scene& of, const std::string& words) {
    return std::ranges::any_of(of.warnings, [&](const std::string& warning) {
      return warning.find(words) != std::string::npos;
    });
  };
  const Scene open = opened(""), given = opened(", thickness: 1 mm"), closed = opened(", cells: 4");
  EXPECT_DOUBLE_EQ(thickness(open), 0.02 * 0.03);
  EXPECT_TRUE(warned(open, "has no inside: 3 open edges, 0 edges of more"));
  EXPECT_TRUE(warned(open, "taken as a sheet of 0.0006 m"));
  EXPECT_DOUBLE_EQ(thickness(given), 0.001);
  EXPECT_FALSE(warned(given, "sheet")) << "it was asked for";
  EXPECT_EQ(thickness(closed), 0);
  EXPECT_TRUE(warned(closed,
                     "1 slit narrower than a cell of its distance grid, 0.0075 m, is closed; "
                     "with a thickness it is a sheet"));
  const std::string missing =
      error_of(damaged("{plane: {point: [0, 0, -0.1]}", "{surface: {file: spoon.stl}"));
  EXPECT_EQ(missing,
            "a.yaml:14: there is no surface file 'spoon.stl' (its name is relative to the scene)");
}

struct Wrong {
  const char* said;  // in place of a line of the scene
  const char* instead;
  const char* message;
};

TEST(Inputs, ErrorsHaveTheirPlace) {
  const Wrong all[] = {
      {"  material:", "  prescribed: [{nearest: [0, 0, 0]}]\n  material:",
       "a.yaml:7: body.prescribed.0: expected one of velocity, curve, sine, rotate, got a map "
       "(nearest)"},
      {"  material:", "  fixed: [{nearest: [0, 0, 0], along: [u]}]\n  material:",
       "a.yaml:7: body.fixed.0.along.0: unknown axis 'u'; did you mean 'x'?"},
      {"  material:", "  fixed: [{nearest: [0, 0, 0], slide: norml}]\n  material:",
       "a.yaml:7: body.fixed.0.slide: expected normal, or a list of 3 numbers, got 'norml'"},
      {"  material:", "  fixed: [{nearest: [0, 0, 0], slide: [0, 0, 0]}]\n  material:",
       "a.yaml:7: body.fixed.0.slide: expected a direction, got [0, 0, 0]"},
      {"  material:", "  fixed: [{nearest: [0, 0, 0], along: [x], slide: normal}]\n  material:",
       "a.yaml:7: body.fixed.0: expected only one of along, slide, got a map (nearest, along, "
       "slide)"},
      {"  material:", "  prescribed: [{velocity: [0, 0, 0]}]\n  material:",
       "a.yaml:7: body.prescribed.0: expected one of box, sphere, half_space, group, region, "
       "nearest, "
       "got a map (velocity)"},
      {"  material:",
       "  prescribed: [{nearest: [0, 0, 0], velocity: [0, 0, 0], sine: {amplitude: [0, 0, 0], "
       "frequency: 1}}]\n  "
       "material:",
       "a.yaml:7: body.prescribed.0: expected only one of velocity, curve, sine, rotate, got a map "
       "(nearest, velocity, sine)"},
      {"  material:", "  prescribed: [{nearest: [0, 0, 0], curv: []}]\n  material:",
       "a.yaml:7: body.prescribed.0: unknown key 'curv'; did you mean 'curve'?"},
      {"  material:", "  loads: [{nearest: [0, 0, 0], force: [0, 0, 3 Pa]}]\n  material:",
       "a.yaml:7: body.loads.0.force.2: expected a force (N), got '3 Pa', a pressure"},
      {"  material:",
       "  loads: [{nearest: [0, 0, 0], force: [0, 0, 3], ramp: 1, sine: {frequency: 1}}]\n  "
       "material:",
       "a.yaml:7: body.loads.0: expected only one of ramp, curve, sine, got a map (nearest, "
       "force, ramp, sine)"},
      {"  material:", "  loads: [{region: tip, force: [0, 0, 3]}]\n  material:",
       "a.yaml:7: body.loads.0.region: there is no region 'tip': the meshes name none"},
      {"friction: 0.2", "curve: [{time: 1, displacement: [0, 0, 0, 0]}]",
       "a.yaml:14: contact.obstacles.0.curve.0.displacement: expected a list of 3 lengths (m), got "
       "a list of 4"},
      {"friction: 0.2", "grasp: {form: 0.1 s}",
       "a.yaml:14: contact.obstacles.0.grasp: unknown key 'form'; did you mean 'from'?"},
      {"friction: 0.2", "grasp: {from: [0.1 s, 2 m]}",
       "a.yaml:14: contact.obstacles.0.grasp.from.1: expected a time (s) >= 0, got '2 m', a "
       "length"},
      {"friction: 0.2", "grasp: {reach: -1 mm}",
       "a.yaml:14: contact.obstacles.0.grasp.reach: expected a length (m) >= 0"},
  };
  for (const Wrong& wrong : all) {
    const std::string text = error_of(damaged(wrong.said, wrong.instead));
    EXPECT_EQ(text.substr(0, std::string(wrong.message).size()), wrong.message) << text;
  }
}

// What only the library checks gets its line all the same.
TEST(Inputs, TheLibrarysErrorsHaveTheirPlaceToo) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    std::ofstream(folder / "a.yaml") << text;
    try {
      load_scene(folder / "a.yaml");
    } catch (const InputError& error) {
      return std::string(error.what()).substr(folder.path().string().size() + 1);
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal(damaged("friction: 0.2",
                            "curve: [{time: 1, displacement: [0, 0, 0]},\n"
                            "        {time: 1, displacement: [0, 0, 0]}]")),
            "a.yaml:15: contact.obstacles.0.curve.1.time is 1 s; expected a time after that of the "
            "entry before, 1 s");
  EXPECT_EQ(refusal(damaged("friction: 0.2", "grasp: {from: 0.3 s,\n        until: 0.2 s}")),
            "a.yaml:15: contact.obstacles.0.grasp.until is 0.2 s; expected a time after 0.3 s: it "
            "closes and opens in turns");
  const Tree tree = parse_tree(sound_scene, "a.yaml");
  EXPECT_STREQ(located(InputError("body.levels.1: too small"), tree).what(),
               "a.yaml:6: body.levels.1: too small");
  EXPECT_STREQ(located(InputError("level 0: a step"), tree).what(), "a.yaml: level 0: a step");
}

struct Case {
  const char* text;
  double value;
  Dimension dimension;
};

TEST(Units, ReadsNumbersWithUnits) {
  const Case cases[] = {{"20 kPa", 20e3, pressure},
                        {"20kPa", 20e3, pressure},
                        {"1.5 MPa", 1.5e6, pressure},
                        {"2e-3 GPa", 2e6, pressure},
                        {"17 ms", 0.017, duration},
                        {"3 us", 3e-6, duration},
                        {"2 min", 120, duration},
                        {"4 cm", 0.04, length},
                        {"5 mm", 0.005, length},
                        {"5 um", 5e-6, length},
                        {"1000 kg/m^3", 1000, density},
                        {"1 g/cm^3", 1000, density},
                        {"1 g / cm3", 1000, density},
                        {"0.5 1/s", 0.5, rate},
                        {"0.5 /s", 0.5, rate},
                        {"2 Hz", 2, rate},
                        {"-9.81 m/s^2", -9.81, acceleration},
                        {"3 m/s", 3, velocity},
                        {"180 deg/s", std::numbers::pi, angular_velocity},
                        {"2 N/m^2", 2, pressure},
                        {"1 mmHg", 133.322387415, pressure},
                        {"2 bar", 2e5, pressure},
                        {"40 %", 0.4, plain}};
  for (const Case& c : cases) {
    const Measured measured = measure(c.text);
    EXPECT_NEAR(measured.value, c.value, 1e-12 * std::abs(c.value)) << c.text;
    ASSERT_TRUE(measured.dimension.has_value()) << c.text;
    EXPECT_EQ(*measured.dimension, c.dimension) << c.text << " is " << name_of(*measured.dimension);
  }
}

TEST(Units, ReadsPlainNumbers) {
  for (const auto& [text, value] :
       {std::pair{"3", 3.0}, {"-3.5", -3.5}, {"+2", 2.0}, {"1e3", 1e3}, {" .5 ", 0.5}}) {
    EXPECT_EQ(measure(text).value, value);
    EXPECT_FALSE(measure(text).dimension.has_value()) << text;
  }
}

TEST(Units, RefusesWhatIsNone) {
  for (const char* text : {"", "kPa", "nan", "inf", "1e999", "4 cmm", "4 m^x", "4 m^", "4 m//s",
                           "4 m/", "4 *", "--3", "+-3", "3 4", "0x10", "1,5"})
    EXPECT_THROW(measure(text), std::invalid_argument) << text;
}

TEST(Units, SuggestsTheNearestUnit) {
  try {
    measure("4 kpa");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "unknown unit 'kpa'; did you mean 'kPa'?");
  }
}

TEST(Units, SaysThatDecimalsTakeAPoint) {
  try {
    measure("0,6 s");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "a comma; expected a point before decimals");
  }
}

TEST(Units, NamesDimensions) {
  EXPECT_EQ(name_of(pressure), "a pressure");
  EXPECT_EQ(unit_of(pressure), "Pa");
  EXPECT_EQ(name_of({.mass = 2, .time = -1}), "a quantity in kg^2/s");
}

// A user may copy any unit from a message into a scene.
TEST(Units, AreReadAsTheyArePrinted) {
  EXPECT_EQ(unit_of({.mass = 1, .length = 2}), "kg*m^2");
  EXPECT_EQ(unit_of({.time = -2, .angle = -1}), "1/s^2/rad");
  const auto expect_read = [](const Dimension& d) {
    const Measured measured = measure(Quantity{d}.to_text(2));
    EXPECT_EQ(measured.value, 2) << unit_of(d);
    EXPECT_EQ(measured.dimension.value_or(plain), d) << unit_of(d);
  };
  for (int mass = -2; mass <= 2; ++mass)
    for (int length = -3; length <= 3; ++length)
      for (int time = -3; time <= 3; ++time)
        for (int angle = -1; angle <= 1; ++angle) expect_read({mass, length, time, angle});
}

std::vector<long> due_steps(const Interval& every, double step, long last) {
  const Schedule schedule(every, step);
  std::vector<long> due;
  for (long n = 0; n <= last; ++n)
    if (schedule.due(n)) due.push_back(n);
  return due;
}

TEST(Interval, ReadsTimesAndSteps) {
  EXPECT_EQ(parse_interval("20 ms"), (Interval{0.02, 0}));
  EXPECT_EQ(parse_interval("0.5"), (Interval{0.5, 0}));
  EXPECT_EQ(parse_interval("10 steps"), (Interval{0, 10}));
  EXPECT_EQ(parse_interval("1step"), (Interval{0, 1}));
  for (const char* bad :
       {"", "steps", "0 steps", "-2 steps", "1.5 steps", "3 cm", "0 s", "-1", "10 stepps"})
    EXPECT_THROW(parse_interval(bad), std::invalid_argument) << bad;
}

TEST(Interval, OfCheckpoints) {
  EXPECT_EQ(checkpoint_interval("every=100"), (Interval{0, 100}));
  EXPECT_EQ(checkpoint_interval("every=100 steps"), (Interval{0, 100}));
  EXPECT_EQ(checkpoint_interval("every=0.1s"), (Interval{0.1, 0}));
  for (const char* bad : {"", "100", "every=", "every=0", "every=-1", "evry=1", "every=1 m",
                          "every=99999999999999999999"})
    EXPECT_THROW(checkpoint_interval(bad), InputError) << bad;
}

TEST(Schedule, OfSteps) { EXPECT_EQ(due_steps({0, 4}, 0.1, 10), (std::vector<long>{0, 4, 8})); }

TEST(Schedule, TakesTheFirstStepAtOrAfterEachMultiple) {
  EXPECT_EQ(due_steps({0.25, 0}, 0.1, 10), (std::vector<long>{0, 3, 5, 8, 10}));
  EXPECT_EQ(due_steps({0.01, 0}, 0.1, 3), (std::vector<long>{0, 1, 2, 3}));
  EXPECT_EQ(due_steps({1e-300, 0}, 0.1, 3), (std::vector<long>{0, 1, 2, 3}));
}

TEST(Schedule, RoundingLosesNoStep) {
  for (const double step : {0.1, 0.03, 1e-3, 1.0 / 3, 3.7e-5}) {
    const auto due = due_steps({7 * step, 0}, step, 70000);
    ASSERT_EQ(due.size(), 10001) << step;
    for (std::size_t i = 0; i < due.size(); ++i)
      ASSERT_EQ(due[i], static_cast<long>(7 * i)) << step;
  }
}

}  // namespace
}  // namespace plica::app::test
