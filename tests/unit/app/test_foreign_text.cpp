// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <plica/meshes/files/mesh_files.hpp>

#include "unit/app/child.hpp"

// Names and files that are not in UTF-8, as older programs write them: the program runs, and what it writes is UTF-8.
namespace plica::app::test {
namespace {

using Json = nlohmann::json;

const std::string latin =
                      "L\xE9"
                      "ber",
                  valid =
                      "L\xEF\xBF\xBD"
                      "ber";  // é in Latin-1; U+FFFD for it

// Two tetrahedra in two regions, a name of which ends in this
std::string mesh_with(const std::string& one, const std::string& other) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n3 1 \"" + one + "\"\n3 2 \"" + other + "\"\n2 3 \"" +
         one +
         "\"\n$EndPhysicalNames\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$EndNodes\n"
         "$Elements\n3\n1 2 2 3 3 1 2 3\n2 4 2 1 1 1 2 3 4\n3 4 2 2 2 2 3 4 5\n$EndElements\n";
}

class ForeignText : public testing::Test {
 protected:
  ForeignText() {
    std::ofstream(folder / "a.msh", std::ios::binary) << mesh_with(latin,
                                                                   "L\xE8"
                                                                   "ber");
  }

  Child plica(std::vector<std::string> words) {
    words.insert(words.begin(), PLICA_EXECUTABLE);
    return run_child(words, folder);
  }
  std::string scene(const std::string& file, const std::string& body, const std::string& more = {}) const {
    std::ofstream(folder / file, std::ios::binary)
        << "duration: 2 ms\nbody: {levels: [{file: a.msh}]" << body << "}\nintegration: {macro_step: 1 ms}\n"
        << more;
    return folder / file;
  }
  Json summary(const std::string& out = "out") const { return Json::parse(content_of(folder / out / "summary.json")); }

  TemporaryFolder folder;
};

TEST_F(ForeignText, RegionsOfAMeshFile) {
  const std::string file =
      scene("a.yaml", ", regions: {" + valid + ": {density: 900}, " + valid + " (2): {density: 950}}",
            "output: {volume: all}\n");
  const Child run = plica({"run", file, "-o", folder / "out"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(summary()["status"], "completed");
  EXPECT_EQ(summary()["levels"][0]["stiffest"][0]["region"].get<std::string>().substr(0, 8), valid.substr(0, 8));
  const Child unknown = plica({"check", file, "--json", "--set", "body.regions={" + latin + "x: {density: 1}}"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_NE(Json::parse(unknown.output)["error"].get<std::string>().find(valid + "x"), std::string::npos);
}

TEST_F(ForeignText, NamesOfAMeshFileStayDistinct) {
  const TetMesh mesh = read_mesh(folder / "a.msh");
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{valid, valid + " (2)"}));
  ASSERT_EQ(mesh.vertex_sets.size(), 1);
  EXPECT_EQ(mesh.vertex_sets.begin()->first, valid) << "a name of two groups stays one";
  const Json info = Json::parse(plica({"mesh", "info", folder / "a.msh", "--json"}).output);
  EXPECT_EQ(info["regions"][0]["name"], valid);
  EXPECT_EQ(plica({"mesh", "convert", folder / "a.msh", folder / "b.msh"}).status, 0);
  EXPECT_EQ(read_mesh(folder / "b.msh").vertex_sets.count(valid), 1);
}

TEST_F(ForeignText, SceneInLatin1) {
  const std::string file =
      scene("a.yaml", "", "name: " + latin + "\noutput: {probes: {" + latin + ": [0.1, 0.1, 0.1]}}  # " + latin + "\n");
  const Child run = plica({"run", file, "-o", folder / "out", "--checkpoint", "every=1"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(summary()["name"], valid);
  EXPECT_TRUE(content_of(folder / "out/probes.csv").starts_with("time," + valid + "_x,"));
  EXPECT_EQ(plica({"run", file, "--resume", folder / "out"}).status, 0);
  EXPECT_EQ(plica({"explain", file, "--json"}).status, 0);
  const Child twice = plica({"check", file, "--set",
                             "output.probes={" + latin +
                                 ": [0, 0, 0], L\xE8"
                                 "ber: [0, 0, 0]}"});
  EXPECT_EQ(twice.status, 2) << "two keys that read the same";
  EXPECT_NE(twice.errors.find("stands here for the second time"), std::string::npos) << twice.errors;
}

TEST_F(ForeignText, FilesWithLatin1Names) {
  const std::string inside = "d\xE9pot";
  std::filesystem::create_directory(folder / inside);
  std::filesystem::copy(folder / "a.msh", folder / inside / "a.msh");
  const std::string file = scene(inside + "/sc\xE8ne.yaml", ""), out = inside + "/r\xE9sultat";
  const Child run = plica({"run", file, "-o", folder / out, "--checkpoint", "every=1"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(summary(out)["name"], "sc\xEF\xBF\xBDne");
  EXPECT_TRUE(summary(out)["scene"].get<std::string>().ends_with("/sc\xEF\xBF\xBDne.yaml"));
  EXPECT_TRUE(std::filesystem::exists(folder / out / "frames/surface_0001.vtu"));
  const Child resumed = plica({"run", "--resume", folder / out, "--duration", "4 ms"});
  EXPECT_EQ(resumed.status, 0) << "the mesh beside the scene is found again: " << resumed.errors;
  const Child check = plica({"check", file, "--json"});
  EXPECT_EQ(Json::parse(check.output)["sound"], true);
}

}  // namespace
}  // namespace plica::app::test
