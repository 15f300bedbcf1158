// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <plica/meshes/files/mesh_files.hpp>

#include "unit/app/child.hpp"

// plica mesh info and plica mesh convert, as a user has them
namespace plica::app::test {
namespace {

class MeshCommands : public testing::Test {
 protected:
  Child plica(std::vector<std::string> words) {
    words.insert(words.begin(), {PLICA_EXECUTABLE, "mesh"});
    return run_child(words, folder);
  }
  std::string at(const std::string& name) const { return folder / name; }
  static std::string sample(const std::string& name) {
    return PLICA_SOURCE_DIR "/meshes/data/formats/" + name;
  }
  Json info(std::vector<std::string> words) {
    words.insert(words.begin(), "info");
    words.emplace_back("--json");
    const Child child = plica(words);
    EXPECT_EQ(child.status, 0) << child.errors;
    return Json::parse(child.output);
  }
  void expect_refused(const std::vector<std::string>& words, const std::string& message) {
    const Child child = plica(words);
    EXPECT_EQ(child.status, 2);
    EXPECT_NE(child.errors.find(message), std::string::npos) << child.errors;
    EXPECT_EQ(child.output, "");
  }

  TemporaryFolder folder;
};

TEST_F(MeshCommands, InfoOfAMesh) {
  const Json json =
      info({sample("blocks_41.msh"), "--young-modulus", "80 kPa", "--model", "linear"});
  EXPECT_EQ(json["vertices"], 23);
  EXPECT_EQ(json["tets"], 48);
  EXPECT_EQ(json["parts"], 1);
  EXPECT_NEAR(json["volume"], 1.6e-5, 1e-18);
  EXPECT_EQ(json["regions"].size(), 2);
  EXPECT_EQ(json["vertex_sets"]["edge"], 3);
  EXPECT_EQ(json["material"]["young_modulus"], 80e3);
  EXPECT_EQ(json["material"]["density"], 1000);
  EXPECT_EQ(json["worst"].size(), 10);
  double least = 1e300;
  for (const Json& tet : json["worst"]) {
    EXPECT_GE(tet["critical_step"], json["element_bound"].get<double>() * (1 - 1e-12));
    EXPECT_TRUE(tet["region"] == "tissue" || tet["region"] == "large tumour");
    EXPECT_GT(tet["number"], 0);
    least = std::min(least, tet["critical_step"].get<double>());
  }
  EXPECT_NEAR(least, json["element_bound"], 1e-12)
      << "the flattest one is the stiffest of this mesh";
  EXPECT_GT(json["critical_step"], json["element_bound"]);
  const Json softer = info({sample("blocks_41.msh"), "--young-modulus", "20kPa"});
  EXPECT_NEAR(softer["critical_step"], 2 * json["critical_step"].get<double>(),
              1e-3 * softer["critical_step"].get<double>());
  const Json larger = info({sample("blocks_41.msh"), "--scale", "10", "--young-modulus", "80 kPa"});
  EXPECT_NEAR(larger["critical_step"], 10 * json["critical_step"].get<double>(),
              1e-2 * larger["critical_step"].get<double>());
  EXPECT_NEAR(larger["edges"]["max"], 0.2, 1e-12);
}

TEST_F(MeshCommands, InfoForPeople) {
  const Child child = plica({"info", sample("blocks_41.msh")});
  ASSERT_EQ(child.status, 0) << child.errors;
  for (const char* piece : {"Gmsh MSH 4.1 ASCII", "1.6e-05 m^3 in 1 connected part", "large tumour",
                            "critical step", "best: 70.5", "####", "20 mm x 20 mm x 40 mm",
                            "young_modulus 20 kPa, poisson_ratio 0.4, density 1000 kg/m^3",
                            "by their numbers in the file"})
    EXPECT_NE(child.output.find(piece), std::string::npos) << piece << "\n" << child.output;
}

TEST_F(MeshCommands, InfoOfASurface) {
  const Json json = info({sample("blocks.obj"), "--scale", "2"});
  EXPECT_EQ(json["triangles"], 40);
  EXPECT_EQ(json["closed"], true);
  EXPECT_NEAR(json["area"], 4 * 0.004, 1e-9);
  EXPECT_NEAR(json["volume"], 8 * 1.6e-5, 1e-12);
  std::ofstream(at("open.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const Json open = info({at("open.obj")});
  EXPECT_EQ(open["closed"], false);
  EXPECT_TRUE(open["volume"].is_null());
  EXPECT_NEAR(open["edges"]["max"], std::sqrt(2.0), 1e-15);
  EXPECT_NE(plica({"info", at("open.obj")}).output.find("3 open edges"), std::string::npos);
}

TEST_F(MeshCommands, ConvertKeepsTheMesh) {
  ASSERT_EQ(
      plica({"convert", sample("blocks_41.msh"), at("a.msh"), "--format", "msh22", "--binary"})
          .status,
      0);
  const TetMesh input = read_mesh(sample("blocks_41.msh")), binary = read_mesh(at("a.msh"));
  EXPECT_EQ(binary.vertices, input.vertices);
  EXPECT_EQ(binary.vertex_sets, input.vertex_sets);
  const Child onward = plica({"convert", at("a.msh"), at("b.ele")});
  EXPECT_EQ(onward.status, 0);
  EXPECT_NE(onward.errors.find("the region 'tissue' is now 'attribute_1'"), std::string::npos)
      << onward.errors;
  EXPECT_TRUE(std::filesystem::exists(at("b.node")));
  ASSERT_EQ(plica({"convert", at("b.node"), at("c.vtu")}).status, 0);
  EXPECT_EQ(read_mesh(at("c.vtu")).tets, input.tets);
  ASSERT_EQ(plica({"convert", at("c.vtu"), at("d.stl"), "--binary"}).status, 0);
  EXPECT_EQ(read_surface(at("d.stl")).triangles.size(), 40);
}

TEST_F(MeshCommands, ConvertInPlace) {
  ASSERT_EQ(plica({"convert", sample("blocks.obj"), at("s.obj")}).status, 0);
  ASSERT_EQ(plica({"convert", at("s.obj"), at("s.obj"), "--scale", "0.5"}).status, 0);
  const TriangleSurface once = read_surface(sample("blocks.obj")), half = read_surface(at("s.obj"));
  ASSERT_EQ(half.triangles, once.triangles);
  EXPECT_EQ(half.vertices.back(), once.vertices.back() / 2);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 3)
      << "nothing but s.obj is left";
}

TEST_F(MeshCommands, ConvertLeavesAMeshInPlaceAlone) {
  ASSERT_EQ(plica({"convert", sample("blocks_41.msh"), at("a.msh")}).status, 0);
  const std::string before = content_of(at("a.msh"));
  std::filesystem::create_symlink("a.msh", at("same.msh"));
  for (const char* out : {"a.msh", "same.msh"}) {
    const Child child = plica({"convert", at("a.msh"), at(out)});
    EXPECT_EQ(child.status, 2);
    EXPECT_NE(child.errors.find("this is the file that is read"), std::string::npos)
        << child.errors;
  }
  EXPECT_EQ(content_of(at("a.msh")), before);
}

TEST_F(MeshCommands, ConvertLeavesTheOldFileWhereItFails) {
  std::ofstream(at("b.ele")) << "old";
  std::filesystem::create_directories(at("b.ele.part/in the way"));
  const Child child = plica({"convert", sample("blocks_41.msh"), at("b.ele")});
  EXPECT_EQ(child.status, 1);
  EXPECT_NE(child.errors.find("cannot write"), std::string::npos) << child.errors;
  EXPECT_EQ(content_of(at("b.ele")), "old");
  EXPECT_FALSE(std::filesystem::exists(at("b.node"))) << "the first of the two files";
  EXPECT_FALSE(std::filesystem::exists(at("b.node.part")));
}

TEST_F(MeshCommands, RepairSaysWhatChanged) {
  std::ofstream(at("flat.mesh"))
      << "MeshVersionFormatted 2\nDimension 3\nVertices 6\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
         "1 1 1 0\n0.5 0.5 0 0\nTetrahedra 3\n1 2 3 4 1\n2 3 4 5 1\n1 2 3 6 1\nEnd\n";
  expect_refused({"info", at("flat.mesh")},
                 "flat.mesh:13: tetrahedron 3 (nodes 1 2 3 6) has no volume");
  const Child child = plica({"repair", at("flat.mesh"), "-o", at("sound.msh")});
  EXPECT_EQ(child.status, 0) << child.errors;
  for (const char* piece : {"1 tetrahedron without volume dropped", "without volume before",
                            "5 vertices, 2 tetrahedra"})
    EXPECT_NE(child.output.find(piece), std::string::npos) << child.output;
  EXPECT_EQ(read_mesh(at("sound.msh")).tets.size(), 2u);
  EXPECT_NE(plica({"repair", sample("blocks_41.msh"), "-o", at("same.msh")})
                .output.find("nothing to repair"),
            std::string::npos);
  EXPECT_EQ(read_mesh(at("same.msh")).tets, read_mesh(sample("blocks_41.msh")).tets);
}

TEST_F(MeshCommands, LatticesOverSurfacesAndMeshes) {
  const Child filled = plica({"fill", sample("blocks.ply"), "-o", at("blocks.vtu"), "--size",
                              "5 mm", "--with", "lattice"});
  EXPECT_EQ(filled.status, 0) << filled.errors;
  EXPECT_NE(filled.output.find("225 vertices, 768 tetrahedra"), std::string::npos) << filled.output;
  EXPECT_EQ(
      plica({"coarsen", sample("blocks_41.msh"), "-o", at("c.msh"), "--vertices", "23"}).status, 2);
  ASSERT_EQ(plica({"coarsen", at("blocks.vtu"), "-o", at("c.msh"), "--vertices", "100"}).status, 0);
  EXPECT_LE(read_mesh(at("c.msh")).vertices.size(), 100u);
  std::ofstream(at("open.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  expect_refused({"fill", at("open.obj"), "-o", at("a.msh"), "--size", "1mm"}, "3 open edges");
  expect_refused({"fill", at("open.obj"), "-o", at("a.msh"), "--size", "1mm"},
                 "the first is at [0.5, 0, 0]");
  expect_refused({"fill", sample("blocks.ply"), "-o", at("a.msh"), "--size", "5 cm"},
                 "larger than the body, 0.02 x 0.02 x 0.04 m");
  expect_refused({"fill", sample("blocks.ply"), "-o", at("a.msh"), "--size", "-1"}, "--size");
  expect_refused({"coarsen", sample("blocks_41.msh"), "-o", at("a.msh"), "--vertices", "30"},
                 "the mesh has 23 vertices; a coarser one has at least 30");
}

// A stand-in for Gmsh, so that what follows from it does not depend on what is installed
class FillsWithGmsh : public MeshCommands {
 protected:
  ~FillsWithGmsh() override { setenv("PATH", path.c_str(), 1); }
  void with_gmsh(const std::string& does) const {
    std::ofstream(at("gmsh")) << "#!/bin/sh\n" << does;
    std::filesystem::permissions(at("gmsh"), std::filesystem::perms::owner_all);
    setenv("PATH", (at("") + ":" + path).c_str(), 1);
  }
  std::vector<std::string> fill_and(const std::vector<std::string>& more) const {
    std::vector<std::string> words = fill;
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  std::vector<std::string> asked(const std::string& with) const {
    return fill_and({"--with", with});
  }

  const std::string path = getenv("PATH");
  const std::vector<std::string> fill = {"fill", sample("blocks.ply"), "-o", at("a.vtu"), "--size",
                                         "5 mm"};
};

TEST_F(FillsWithGmsh, WhereThereIsOne) {
  with_gmsh("cp '" + sample("blocks_22.msh") + "' \"$6\"\n");
  const Child fitted = plica(fill);
  EXPECT_EQ(fitted.status, 0) << fitted.errors;
  EXPECT_NE(fitted.output.find("23 vertices"), std::string::npos) << fitted.output;

  with_gmsh("echo 'Info : starts'; echo 'Error : the surface meets itself' >&2; exit 1\n");
  const Child instead = plica(fill);
  EXPECT_EQ(instead.status, 0) << instead.errors;
  EXPECT_NE(instead.output.find("Error : the surface meets itself\na lattice of cubes instead"),
            std::string::npos)
      << instead.output;
  EXPECT_NE(instead.output.find("225 vertices"), std::string::npos) << instead.output;
  expect_refused(
      asked("gmsh"),
      "--with gmsh: Gmsh made no mesh that fits; it says:\n  Error : the surface meets itself");

  with_gmsh("exec yes 'Info : once more'\n");
  expect_refused(asked("gmsh"),
                 "Gmsh was stopped, since its messages did not end; its last words:\n");

  with_gmsh("cp '" + sample("../ball.msh") + "' \"$6\"\n");
  expect_refused(asked("gmsh"), "of a surface that encloses");
  setenv("PATH", at("").c_str(), 1);
  std::filesystem::remove(at("gmsh"));
  expect_refused(asked("gmsh"), "there is no gmsh on PATH");
  EXPECT_NE(plica(fill).output.find("there is no gmsh on PATH\na lattice of cubes instead"),
            std::string::npos);
  setenv("PATH", path.c_str(), 1);
  expect_refused(asked("tetgen"), "--with");
}

TEST_F(FillsWithGmsh, WhichIsStoppedWhereItHangs) {
  const std::string temporary = at("temporary");
  std::filesystem::create_directory(temporary);
  setenv("TMPDIR", temporary.c_str(), 1);
  with_gmsh("echo 'Info : Meshing surface 3' && touch \"$6\" && exec sleep 1000\n");
  expect_refused(fill_and({"--with", "gmsh", "--time-limit", "0.3 s"}),
                 "blocks.ply: --with gmsh: Gmsh was stopped, since it had made no mesh after 0.3 "
                 "s: give it longer "
                 "(--time-limit), choose a larger --size, or mend the surface (it may meet "
                 "itself); its last words:\n"
                 "  Info : Meshing surface 3");
  EXPECT_FALSE(std::filesystem::exists(at("a.vtu")));
  EXPECT_TRUE(std::filesystem::is_empty(temporary));
  const Child instead = plica(fill_and({"--time-limit", "300 ms"}));
  EXPECT_EQ(instead.status, 0) << instead.errors;
  EXPECT_NE(instead.output.find("no mesh after 0.3 s"), std::string::npos) << instead.output;
  EXPECT_NE(instead.output.find("225 vertices"), std::string::npos) << instead.output;
  unsetenv("TMPDIR");
  expect_refused(fill_and({"--time-limit", "-1 s"}), "--time-limit");
}

// A cell of air, of the number 0, beside one of tissue
const std::string two_cells =
    "# vtk DataFile Version 3.0\ntwo\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0 1 0 "
    "0 "
    "0 1 0 0 0 1 1 1 1\nCELLS 2 10\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 2\n10 10\nCELL_DATA 2\n"
    "SCALARS labels int 1\nLOOKUP_TABLE default\n0 1\nSCALARS kind int 1\nLOOKUP_TABLE "
    "default\n4 5\n";

TEST_F(MeshCommands, ReadAsSceneFilesDo) {
  std::ofstream(at("two.vtk")) << two_cells;
  EXPECT_EQ(info({at("two.vtk")})["regions"].size(), 2);
  const Json kinds = info({at("two.vtk"), "--regions", "kind"});
  EXPECT_EQ(kinds["regions"][0]["name"], "kind_4");
  EXPECT_EQ(info({at("two.vtk"), "--leave-out", "0"})["tets"], 1);
  EXPECT_EQ(info({at("two.vtk"), "--regions", "kind", "--leave-out", "kind_5"})["tets"], 1);
  EXPECT_EQ(info({at("two.vtk"), "--regions", "none"})["regions"].size(), 1);
  EXPECT_EQ(plica({"convert", at("two.vtk"), at("one.msh"), "--leave-out", "0"}).status, 0);
  EXPECT_EQ(read_mesh(at("one.msh")).tets.size(), 1u);
  EXPECT_EQ(info({sample("blocks_order2.msh"), "--order", "linear"})["tets"].get<int>() * 8,
            info({sample("blocks_order2.msh")})["tets"].get<int>());
  expect_refused({"info", at("two.vtk"), "--regions", "kin"}, "did you mean 'kind'?");
  expect_refused({"info", at("two.vtk"), "--leave-out", "0,7"}, "leave_out: unknown region '7'");
  expect_refused({"info", at("two.vtk"), "--leave-out", "0,,1"}, "between commas, got '0,,1'");
  expect_refused({"info", at("two.vtk"), "--order", "linar"}, "did you mean 'linear'?");
  expect_refused({"info", at("two.vtk"), "--weld", "0"}, "--weld is for surfaces of triangles");
  expect_refused({"info", sample("blocks.stl"), "--order", "split"},
                 "--order is for meshes of tetrahedra");
  expect_refused(
      {"fill", sample("blocks.ply"), "-o", at("a.vtu"), "--size", "5 mm", "--leave-out", "1"},
      "--leave-out is for images of labels");
  expect_refused({"repair", at("two.vtk"), "-o", at("a.msh"), "--regions", "kin"}, "'kind'");
  // a scale that was meant: millimetres are no unlikely metres
  const Child scaled = plica({"convert", sample("blocks_41.msh"), at("mm.msh"), "--scale", "1000"});
  EXPECT_EQ(scaled.status, 0);
  EXPECT_EQ(scaled.errors.find("is the file in"), std::string::npos) << scaled.errors;
  EXPECT_NE(plica({"convert", at("mm.msh"), at("a.msh")}).errors.find("is the file in mm?"),
            std::string::npos);
}

// A ball of the label 2 in a shell of the label 1, of radii 5 and 9 voxels
std::string image_of_a_ball() {
  std::string labels;
  for (int k = -10; k < 10; ++k)
    for (int j = -10; j < 10; ++j)
      for (int i = -10; i < 10; ++i) {
        const double r =
            std::sqrt((i + 0.5) * (i + 0.5) + (j + 0.5) * (j + 0.5) + (k + 0.5) * (k + 0.5));
        labels += static_cast<char>(r < 5 ? 2 : r < 9 ? 1 : 0);
      }
  return "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 20 20 20\nspacings: 2 2 2\nencoding: raw\n"
         "Segment0_LabelValue:=2\nSegment0_Name:=tumour\n\n" +
         labels;
}

TEST_F(MeshCommands, FillOfAnImage) {
  std::ofstream(at("a.nrrd"), std::ios::binary) << image_of_a_ball();
  const Child filled = plica({"fill", at("a.nrrd"), "-o", at("a.msh"), "--size", "6 mm"});
  EXPECT_EQ(filled.status, 0) << filled.errors;
  EXPECT_NE(filled.output.find("NRRD, 20 x 20 x 20 voxels, lengths in units of 1 mm, as is usual"),
            std::string::npos)
      << filled.output;
  const Json json = info({at("a.msh")});
  EXPECT_EQ(json["regions"].size(), 2);
  EXPECT_EQ(json["regions"][0]["name"], "label_1");
  EXPECT_EQ(json["regions"][1]["name"], "tumour");
  const double ball = 4.0 / 3 * 3.14159265 * 0.018 * 0.018 * 0.018;
  EXPECT_NEAR(json["volume"].get<double>(), ball, 0.06 * ball);
  EXPECT_EQ(plica({"fill", at("a.nrrd"), "-o", at("a.vtu"), "--size", "6 mm"}).status, 0);
  EXPECT_EQ(read_mesh(at("a.vtu")).region_names, (std::vector<std::string>{"region_1", "region_2"}))
      << "the array has the labels";
  EXPECT_EQ(
      plica({"fill", at("a.nrrd"), "-o", at("b.msh"), "--size", "6 mm", "--leave-out", "tumour"})
          .status,
      0);
  EXPECT_EQ(read_mesh(at("b.msh")).region_names, std::vector<std::string>{"label_1"});
  const Child metres =
      plica({"fill", at("a.nrrd"), "-o", at("m.msh"), "--size", "6 m", "--scale", "1"});
  EXPECT_NE(metres.errors.find("the body is"), std::string::npos) << "an unlikely size is doubted";
  const std::vector<std::string> fill = {"fill", at("a.nrrd"), "-o", at("c.msh"), "--size"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), fill.begin(), fill.end());
    return more;
  };
  expect_refused(with({"6 mm", "--with", "gmsh"}), "--with is for surfaces");
  expect_refused(with({"6 mm", "--leave-out", "3"}), "unknown label '3'");
  expect_refused(with({"6 mm", "--leave-out", "1,2"}), "no voxel with a label above 0");
  expect_refused(with({"9 cm"}), "larger than the body");
  std::ofstream(at("cut.nrrd"), std::ios::binary) << image_of_a_ball().substr(0, 4000);
  expect_refused({"fill", at("cut.nrrd"), "-o", at("c.msh"), "--size", "6 mm"},
                 "expected 8000, 1 for each of 20 x 20 x 20");
  EXPECT_FALSE(std::filesystem::exists(at("c.msh")));
}

TEST_F(MeshCommands, PipesAndHugeNamesAreRefused) {
  ASSERT_EQ(mkfifo(at("pipe.msh").c_str(), 0600), 0);
  expect_refused({"info", at("pipe.msh")}, "is a pipe or a device");
  expect_refused({"info", std::string(100000, 'x') + ".msh"},
                 "cannot be opened: File name too long");
}

TEST_F(MeshCommands, WrongArgumentsAreRefused) {
  const std::string mesh = sample("blocks_41.msh");
  expect_refused(
      {"convert", mesh, at("a.msch")},
      "did you mean 'msh'? (choices: msh, mesh, vtk, vtu, ele, node, obj, ply, off, stl)");
  expect_refused({"convert", mesh, at("a.msh"), "--format", "msh40"},
                 "unknown format 'msh40'; did you mean 'msh41'?");
  expect_refused({"convert", mesh, at("a.ele"), "--binary"}, "no binary form");
  expect_refused({"convert", sample("blocks.obj"), at("a.vtk")},
                 "unknown surface file extension 'vtk'");
  expect_refused({"convert", at("none.msh"), at("a.msh")},
                 "none.msh: cannot be opened: No such file or directory");
  expect_refused({"convert", mesh, at("a.msh"), "--scale", "0"},
                 "--scale: expected a number > 0, got '0'");
  expect_refused({"convert", mesh, at("a.msh"), "--merge-duplicates", "1 m"},
                 "at most 1 m apart cannot be merged");
  expect_refused({"convert", sample("blocks.obj"), at("a.obj"), "--merge-duplicates", "1 mm"},
                 "for meshes");
  expect_refused({"info", mesh, "--young-modulus", "20kpa"},
                 "unknown unit 'kpa'; did you mean 'kPa'?");
  expect_refused({"info", mesh, "--model", "neohookean"}, "did you mean 'neo_hookean'?");
  expect_refused({"info", sample("blocks.obj"), "--density", "1"},
                 "--density: this file holds a surface");
  expect_refused({"conver", mesh, at("a.msh")},
                 "unknown command 'conver'; did you mean 'convert'?");
  EXPECT_FALSE(std::filesystem::exists(at("a.msh")));
}

}  // namespace
}  // namespace plica::app::test
