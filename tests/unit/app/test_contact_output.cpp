// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/contact_depth.hpp>
#include <plica/drivers/app/output/run_files.hpp>
#include <plica/drivers/app/output/summary.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/app/report/read_files.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/kernels/contact/shapes.hpp>

#include "unit/app/child.hpp"
#include "unit/app/scene_text.hpp"

// What runs write of contact, supports and the surface, and of the steps that contact cuts.
namespace plica::app::test {
namespace {

constexpr const char* block = R"(duration: 1
body: {levels: [{box: {size: [1, 1, 1], cells: [2, 2, 2]}}]}
)";
const std::vector<std::string> implicit = {"integration.integrator=implicit_euler",
                                           "integration.macro_step=1ms"};

TEST(RunFiles, WriteNormalsAndTextureOfTheSurface) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "skin.obj";
  write_file(file,
             "v 0.2 0.2 0.5\nv 0.7 0.2 0.5\nv 0.2 0.7 0.5\nvt 0 0\nvt 1 0\nvt 0 1\n"
             "f 1/1 2/2 3/3\n");
  const Scene scene = scene_of(block, {"output.fields=[normals, texture_coordinates]",
                                       "body.surface.file=" + file.string()});
  RunFiles files(scene, folder.path());
  Snapshot now;
  now.positions = scene.problem.body.levels[0].vertices;
  now.velocities.assign(now.positions.size(), Point::Zero());
  now.surface = {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  now.surface_velocities.assign(3, Point::Zero());
  files.write(now);
  const FrameFile surface = read_frame(folder / "frames/surface_0000.vtu");
  ASSERT_NE(surface.find("normals"), nullptr);
  EXPECT_EQ(surface.find("normals")->values, (std::vector<double>{1, 0, 0, 1, 0, 0, 1, 0, 0}));
  ASSERT_NE(surface.find("texture_coordinates"), nullptr);
  EXPECT_EQ(surface.find("texture_coordinates")->components, 2);
  EXPECT_EQ(surface.find("texture_coordinates")->values, (std::vector<double>{0, 0, 1, 0, 0, 1}));

  Tree tree = parse_tree(block, "a.yaml");
  for (const char* set : {"output.fields=texture_coordinates", "body.surface.boundary=true"})
    override_value(tree, set, set);
  try {
    load_scene(tree);
    ADD_FAILURE() << "the boundary has no texture";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("expected body.surface.file, an OBJ file"),
              std::string::npos)
        << error.what();
  }
}

// Columns more, and only where something rubs, and where implicit steps may be halved
TEST(RunFiles, HistoryTellsOfFriction) {
  const TemporaryFolder folder;
  Scene scene = scene_of(block, implicit);
  scene.problem.contact.obstacles.push_back({PlaneOptions{}, 0.3, {}, "floor"});
  scene.problem.contact.obstacles.push_back({PlaneOptions{}, {}, {}, "ice"});
  RunFiles files(scene, folder.path());
  Snapshot now;
  now.time = 0.25, now.positions = scene.problem.body.levels[0].vertices;
  now.velocities.assign(now.positions.size(), Point::Zero());
  now.wrenches.assign(2, {"", {1, 2, 3}, {4, 5, 6}});
  now.step_halvings = 7, now.friction_work = -0.25, now.slipping = {0.5, 1};
  files.write(now);
  const std::string text = content_of(folder / "history.csv");
  EXPECT_NE(text.find("ice.torque_z,step_halvings,friction_work,floor.slipping\n"),
            std::string::npos)
      << text;
  EXPECT_TRUE(text.ends_with(",4,5,6,7,-0.25,0.5\n")) << text;
  EXPECT_FALSE(has_friction(scene_of(block).problem.contact));
  Scene once = scene_of(block, implicit);
  EXPECT_EQ(most_halvings(once.problem), 6);
  once.problem.integration.implicit.newton_iterations = 1;
  EXPECT_EQ(most_halvings(once.problem), 0) << "nothing judges a step, and no contact";
  EXPECT_EQ(most_halvings(scene_of(block).problem), 0);
}

TEST(RunFiles, HistoryHasWhatHoldsVertices) {
  const TemporaryFolder folder;
  Scene scene = scene_of(block);
  scene.problem.body.fixed = {Box{{0, 0, 0}, {0, 1, 1}}};
  scene.problem.body.prescribed = {{NearestSelection{{1, 0, 0}}, Point(1, 0, 0)}};
  RunFiles files(scene, folder.path());
  Snapshot now;
  now.time = 0.25, now.positions = scene.problem.body.levels[0].vertices;
  now.velocities.assign(now.positions.size(), Point::Zero());
  now.reactions = {{"fixed_0", {1, 2, 3}, {4, 5, 6}}, {"prescribed_0", {7, 8, 9}, {10, 11, 12}}};
  files.write(now);
  const std::string text = content_of(folder / "history.csv");
  EXPECT_NE(text.find(",fixed_0.force_x,fixed_0.force_y,fixed_0.force_z,fixed_0.torque_x,"),
            std::string::npos);
  EXPECT_NE(text.find(",prescribed_0.torque_y,prescribed_0.torque_z\n"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with(",1,2,3,4,5,6,7,8,9,10,11,12\n")) << text;

  Summary summary;
  summary.reactions = now.reactions;
  const auto json = nlohmann::json::parse(summary_json(scene, summary, {}));
  EXPECT_EQ(json["reactions"]["prescribed_0"]["torque"].get<std::vector<double>>(),
            (std::vector<double>{10, 11, 12}));
}

// The deepest of each obstacle, and of bodies, with the time; also where a run goes on
TEST(ContactDepths, AreTheGreatestOfTheRun) {
  ContactOptions contact;
  contact.obstacles.resize(2);
  contact.obstacles[0].name = "floor", contact.obstacles[1].name = "probe";
  TriangleSurface surface;
  surface.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}, surface.triangles = {{0, 1, 2}};
  ContactDepth depth(contact, 1, surface, true), other(contact, 1, surface, true);
  EXPECT_EQ(depth.all().edge, 4);
  depth.look(1, {0.1, 0}, {}, 0.01);
  other.restore(depth.save());
  for (ContactDepth* each : {&depth, &other}) {
    each->look(2, {0.05, 0.2}, {}, 0.04);
    EXPECT_EQ(each->all().deepest[0].depth, 0.1);
    EXPECT_EQ(each->all().deepest[0].time, 1);
    EXPECT_EQ(each->all().deepest[1].depth, 0.2);
    EXPECT_EQ(each->all().deepest[2].depth, 0.04);
  }
}

// Half an edge is visible, and of a needle half its radius, where it is about to come through
TEST(ContactDepths, WarnOfWhatIsDeep) {
  ContactOptions contact;
  contact.obstacles.push_back({SphereOptions{{0, 0, 0}, 10}, {}, {}, "ball"});
  contact.obstacles.push_back({CapsuleOptions{{0, 0, 0}, {0, 0, 9}, 0.1}, {}, {}, "needle"});
  const TriangleSurface surface;
  ContactDepth fine(contact, 1, surface, false), ball = fine, needle = fine, both = fine;
  fine.look(1, {0.49, 0.049}, {}), ball.look(1, {0.6, 0.01}, {}), needle.look(1, {0.4, 0.06}, {});
  both.look(1, {0.6, 0.01}, {}), both.look(2, {0.2, 0.09}, {});
  EXPECT_EQ(fine.warning(), "");
  EXPECT_NE(ball.warning().find("ball was 0.6 m deep in the surface, 0.6 of a mean edge"),
            std::string::npos);
  EXPECT_NE(needle.warning().find("needle was 0.06 m deep in the surface, 0.6 of its radius"),
            std::string::npos);
  EXPECT_NE(both.warning().find("at 2 s needle was 0.09 m"), std::string::npos) << both.warning();
}

// Bodies find each other within half an edge: a quarter of one is deep
TEST(ContactDepths, WarnOfBodiesInEachOther) {
  const TriangleSurface surface;
  ContactDepth fine({}, 2, surface, true), deep = fine;
  fine.look(1, {}, {}, 0.49), deep.look(1, {}, {}, 0.3), deep.look(2, {}, {}, 0.6);
  EXPECT_EQ(fine.warning(), "");
  EXPECT_NE(deep.warning().find("at 2 s a body was 0.6 m deep in a body, 0.3 of a mean edge"),
            std::string::npos)
      << deep.warning();
}

// A run whose last steps are taken again replaces what it has written of them
TEST(RunFiles, GoOnFromWhereTheyAreCutBack) {
  const TemporaryFolder folder;
  const Scene scene = scene_of(block);
  RunFiles files(scene, folder.path());
  Snapshot now;
  now.positions = scene.problem.body.levels[0].vertices;
  now.velocities.assign(now.positions.size(), Point::Zero());
  std::uint64_t first = 0;
  for (const double time : {0., 0.25, 0.5, 0.75}) {
    now.time = time;
    files.write(now);
    if (time == 0) first = files.history_bytes();
  }
  files.cut_back(1, first);
  EXPECT_EQ(files.frames(), 1u);
  EXPECT_EQ(files.last_time(), 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "frames/surface_0001.vtu"));
  now.time = 0.3;
  files.write(now);
  const std::string history = content_of(folder / "history.csv"),
                    film = content_of(folder / "frames.pvd");
  EXPECT_EQ(std::ranges::count(history, '\n'), 3) << history;
  EXPECT_NE(history.find("\n0.3,"), std::string::npos) << history;
  EXPECT_NE(film.find("timestep=\"0.3\" part=\"0\" file=\"frames/surface_0001.vtu\""),
            std::string::npos)
      << film;
  EXPECT_EQ(film.find("timestep=\"0.25\""), std::string::npos) << film;
}

TEST(Summary, SaysWhereHimWentByExplicitSteps) {
  EXPECT_EQ(mostly_explicit_text({{"him_explicit_steps", 50}}, 100), "");
  EXPECT_EQ(mostly_explicit_text({}, 100), "");
  EXPECT_EQ(mostly_explicit_text({{"him_explicit_steps", 51}}, 100).substr(0, 70),
            "cycle him: 51 of 100 macro steps were taken by explicit steps of level");
}

}  // namespace
}  // namespace plica::app::test
