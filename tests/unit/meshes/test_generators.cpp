// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <plica/core/error.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/compare_levels.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <set>

#include "fuzz/mesh_target.hpp"
#include "fuzz/replay.hpp"
#include "support/refusal.hpp"

namespace {

using namespace plica;
using namespace plica::test;

constexpr double pi = std::numbers::pi;
constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
constexpr int huge = std::numeric_limits<int>::max();

// What every generated mesh owes: positive volumes, all vertices used, one part, a boundary that
// encloses the volume
MeshQuality expect_sound(const TetMesh& mesh) {
  std::vector<char> used(mesh.vertices.size(), 0);
  for (const auto& tet : mesh.tets)
    for (const int v : tet) used[static_cast<std::size_t>(v)] = 1;
  EXPECT_EQ(std::count(used.begin(), used.end(), 1), static_cast<std::ptrdiff_t>(used.size()));
  for (int t = 0; t < static_cast<int>(mesh.tets.size()); ++t)
    EXPECT_GT(tet_shape(mesh, t).volume, 0.0);
  MeshQuality quality = mesh_quality(mesh);
  EXPECT_EQ(quality.parts, 1);
  EXPECT_EQ(quality.duplicate_vertices, 0);
  EXPECT_NEAR(enclosed_volume(boundary_surface(mesh).surface) / quality.volume, 1.0, 1e-12);
  return quality;
}

TEST(BoxMesh, CountsVolumeAndEnds) {
  const Box box{{-1, 0.1, 3}, {0.3, 0.7, 3.9}};
  const TetMesh mesh = box_mesh(box, {3, 4, 5});
  EXPECT_EQ(mesh.vertices.size(), 4u * 5 * 6);
  EXPECT_EQ(mesh.tets.size(), 6u * 3 * 4 * 5);
  const MeshQuality quality = expect_sound(mesh);
  EXPECT_NEAR(quality.volume, 1.3 * 0.6 * 0.9, 1e-14);
  EXPECT_EQ(quality.box.min, box.min);
  EXPECT_EQ(quality.box.max, box.max);
  EXPECT_EQ(quality.boundary_triangles, 2 * 2 * (3 * 4 + 4 * 5 + 5 * 3));
}

TEST(BoxMesh, EveryCellIsCutAroundTheSameDiagonal) {
  const TetMesh mesh = box_mesh({{0, 0, 0}, {2, 2, 2}}, {2, 2, 2});
  for (const auto& tet : mesh.tets) {
    bool diagonal = false;
    for (const int a : tet)
      for (const int b : tet)
        diagonal |= mesh.vertices[static_cast<std::size_t>(b)] -
                        mesh.vertices[static_cast<std::size_t>(a)] ==
                    Point(1, 1, 1);
    EXPECT_TRUE(diagonal);
  }
  // The order is part of what runs are compared by
  EXPECT_EQ(mesh.vertices[1], Point(1, 0, 0));
  EXPECT_EQ(mesh.vertices[3], Point(0, 1, 0));
  EXPECT_EQ(mesh.vertices[9], Point(0, 0, 1));
  EXPECT_EQ(mesh.tets[0], (std::array<int, 4>{0, 1, 4, 13}));
  EXPECT_EQ(mesh.tets[1], (std::array<int, 4>{0, 1, 13, 10}));
}

TEST(BoxMesh, OneCell) {
  EXPECT_NEAR(expect_sound(box_mesh({{0, 0, 0}, {1, 1, 1}}, {1, 1, 1})).volume, 1.0, 1e-15);
}

TEST(BoxMesh, RefusesBadSizes) {
  const auto refused = [](const Box& box, const std::array<int, 3>& cells,
                          const std::string& part) {
    const std::string text = refusal([&] { box_mesh(box, cells); });
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  refused({{0, 0, 0}, {1, 0, 1}}, {1, 1, 1}, "along y is 0");
  refused({{0, 0, 0}, {1, 1, -1}}, {1, 1, 1}, "along z is -1");
  refused({{0, nan, 0}, {1, 1, 1}}, {1, 1, 1}, "0, nan, 0");
  refused({{0, 0, 0}, {1, 1, inf}}, {1, 1, 1}, "1, 1, inf");
  refused({{0, 0, 0}, {1, 1, 1}}, {1, 0, 1}, "is 0; it must be 1 or more");
  refused({{0, 0, 0}, {1, 1, 1}}, {1, 1, -5}, "is -5");
  refused({{0, 0, 0}, {1, 1, 1}}, {1000, 1000, 1000}, "tetrahedra is 6000000000");
  refused({{0, 0, 0}, {1, 1, 1}}, {huge, huge, huge}, "below 2^31");
}

TEST(BallMesh, IsSoundAtAnyResolution) {
  for (const int n : {1, 2, 3, 4, 5, 8, 9, 16}) {
    const TetMesh mesh = ball_mesh({1, 2, 3}, 0.5, n);
    EXPECT_EQ(mesh.vertices.size(), static_cast<std::size_t>((n + 1) * (n + 1) * (n + 1)));
    EXPECT_EQ(mesh.tets.size(), static_cast<std::size_t>(6 * n * n * n));
    const MeshQuality quality = expect_sound(mesh);
    EXPECT_LT(quality.height_ratios.max, 3.2) << n;  // a cube's is 2.45
    const auto boundary = boundary_surface(mesh).surface;
    for (const Point& p : boundary.vertices) EXPECT_NEAR((p - Point(1, 2, 3)).norm(), 0.5, 1e-14);
  }
}

TEST(BallMesh, VolumeConvergesWithTheSquareOfTheCells) {
  const double exact = 4.0 / 3.0 * pi;
  const double coarse = 1.0 - mesh_quality(ball_mesh({0, 0, 0}, 1.0, 6)).volume / exact;
  const double fine = 1.0 - mesh_quality(ball_mesh({0, 0, 0}, 1.0, 12)).volume / exact;
  EXPECT_GT(fine, 0.0);
  EXPECT_LT(fine, 0.01);
  EXPECT_NEAR(coarse / fine, 4.0, 0.2);
}

TEST(CylinderMesh, IsSoundAtAnyResolution) {
  for (const int n : {1, 2, 3, 4, 7, 12}) {
    const TetMesh mesh = cylinder_mesh({1, 2, 3}, 0.5, 1.5, n, n + 1);
    EXPECT_EQ(mesh.tets.size(), static_cast<std::size_t>(6 * n * n * (n + 1)));
    const MeshQuality quality = expect_sound(mesh);
    EXPECT_LT(quality.height_ratios.max, 4.5) << n;
    EXPECT_LT(quality.volume, pi * 0.25 * 1.5);
    EXPECT_DOUBLE_EQ(quality.box.min.z(), 3.0);
    EXPECT_DOUBLE_EQ(quality.box.max.z(), 4.5);
  }
  EXPECT_NEAR(mesh_quality(cylinder_mesh({0, 0, 0}, 1, 1, 20, 4)).volume, pi, 0.01);
}

TEST(BallAndCylinderMesh, RefuseBadSizes) {
  EXPECT_THROW(ball_mesh({0, 0, nan}, 1.0, 4), InputError);
  EXPECT_THROW(ball_mesh({0, 0, 0}, 0.0, 4), InputError);
  EXPECT_THROW(ball_mesh({0, 0, 0}, inf, 4), InputError);
  EXPECT_THROW(ball_mesh({0, 0, 0}, 1.0, 0), InputError);
  EXPECT_THROW(ball_mesh({0, 0, 0}, 1.0, huge), InputError);
  EXPECT_THROW(cylinder_mesh({0, inf, 0}, 1.0, 1.0, 4, 4), InputError);
  EXPECT_THROW(cylinder_mesh({0, 0, 0}, -1.0, 1.0, 4, 4), InputError);
  EXPECT_THROW(cylinder_mesh({0, 0, 0}, 1.0, nan, 4, 4), InputError);
  EXPECT_THROW(cylinder_mesh({0, 0, 0}, 1.0, 1.0, 4, 0), InputError);
  EXPECT_THROW(cylinder_mesh({0, 0, 0}, 1.0, 1.0, huge, huge), InputError);
}

TEST(SphereSurface, CountsRadiusOrientationAndClosure) {
  const Point centre(1, -2, 3);
  std::size_t quads = 1;
  for (int s = 0; s <= 4; ++s, quads *= 4) {
    const TriangleSurface surface = sphere_surface(centre, 0.05, s);
    EXPECT_EQ(surface.vertices.size(), 10 * quads + 2);
    EXPECT_EQ(surface.triangles.size(), 20 * quads);
    for (const Point& p : surface.vertices) EXPECT_NEAR((p - centre).norm(), 0.05, 1e-15);
    std::set<std::array<int, 2>> directed;
    for (const auto& [a, b, c] : surface.triangles) {
      const auto at = [&](int v) { return surface.vertices[static_cast<std::size_t>(v)]; };
      EXPECT_GT(tet_volume(centre, at(a), at(b), at(c)), 0.0);
      directed.insert({{a, b}, {b, c}, {c, a}});
    }
    EXPECT_EQ(directed.size(), 60 * quads);  // each edge once each way
    for (const auto& [a, b] : directed) EXPECT_TRUE(directed.contains({b, a}));
  }
  const TriangleSurface fine = sphere_surface(centre, 2.0, 5);
  EXPECT_NEAR(surface_area(fine), 16.0 * pi, 0.05);
  EXPECT_NEAR(enclosed_volume(fine), 32.0 / 3.0 * pi, 0.05);
}

TEST(SphereSurface, RefusesBadSizes) {
  EXPECT_EQ(sphere_surface({0, 0, 0}, 1.0, 3).vertices.size(), 642u);
  EXPECT_THROW(sphere_surface({nan, 0, 0}, 1.0, 3), InputError);
  EXPECT_THROW(sphere_surface({0, 0, 0}, -1.0, 3), InputError);
  EXPECT_THROW(sphere_surface({0, 0, 0}, 1.0, -1), InputError);
  EXPECT_THROW(sphere_surface({0, 0, 0}, 1.0, 14), InputError);
  EXPECT_THROW(sphere_surface({0, 0, 0}, 1.0, huge), InputError);
}

const std::filesystem::path folder = std::filesystem::path(PLICA_SOURCE_DIR) / "meshes" / "data";

TEST(CommittedMeshes, AreSoundAndSmall) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".msh") continue;
    SCOPED_TRACE(entry.path().string());
    ++count;
    EXPECT_LT(entry.file_size(), 150'000u);
    MeshReport report;
    const TetMesh mesh = read_mesh(entry.path(), &report);
    EXPECT_EQ(report.flipped, 0);
    EXPECT_EQ(report.unreferenced, 0);
    const MeshQuality quality = mesh_quality(mesh);
    EXPECT_EQ(quality.parts, 1);
    EXPECT_EQ(quality.duplicate_vertices, 0);
    EXPECT_LT(quality.height_ratios.max, 7.0);
    EXPECT_LT((quality.box.max - quality.box.min).norm(), 0.5);  // in metres, not millimetres
  }
  EXPECT_EQ(count, 5);
}

TEST(CommittedMeshes, BeamHasATumourAndABase) {
  const TetMesh mesh = read_mesh(folder / "beam.msh");
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"tissue", "tumour"}));
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_NEAR(quality.volume, 0.16 * 0.04 * 0.04, 1e-15);
  EXPECT_NEAR(quality.regions[1].volume, 4.0 / 3.0 * 3.14159 * std::pow(0.012, 3), 2e-6);
  ASSERT_GT(mesh.vertex_sets.at("base").size(), 10u);
  for (const int v : mesh.vertex_sets.at("base"))
    EXPECT_EQ(mesh.vertices[static_cast<std::size_t>(v)].x(), 0.0);
}

TEST(CommittedMeshes, BallIsRound) {
  const TetMesh mesh = read_mesh(folder / "ball.msh");
  for (const int v : mesh.vertex_sets.at("skin"))
    EXPECT_NEAR(mesh.vertices[static_cast<std::size_t>(v)].norm(), 0.05, 1e-12);
}

TEST(CommittedMeshes, LiversFitEachOther) {
  const TetMesh fine = read_mesh(folder / "liver_fine.msh"),
                medium = read_mesh(folder / "liver_medium.msh"),
                coarse = read_mesh(folder / "liver_coarse.msh");
  EXPECT_GT(fine.tets.size(), 2 * medium.tets.size());
  EXPECT_GT(2 * medium.tets.size(), 3 * coarse.tets.size());
  for (const auto* pair : {&fine, &coarse}) {
    const Embedding down = embed(pair->vertices, medium, Outside::extrapolate);
    EXPECT_GT(down.misses, 0);  // the boundaries differ
    EXPECT_EQ(down.held, 0);
    EXPECT_LT(down.largest_distance_over_edge, 0.2);
  }
}

TEST(CommittedMeshes, HornsAreGradedAndNotNested) {
  std::vector<TetMesh> horns;
  for (const char* name : {"fine", "medium", "coarse"}) {
    const auto file = folder / "graded" / (std::string("horn_") + name + ".msh");
    EXPECT_LE(std::filesystem::file_size(file), 400'000u);
    MeshReport report;
    horns.push_back(read_mesh(file, &report));
    EXPECT_EQ(report.flipped + report.unreferenced, 0);
    const MeshQuality quality = mesh_quality(horns.back());
    EXPECT_EQ(quality.parts, 1);
    EXPECT_LT(quality.height_ratios.max, 7.0);
    EXPECT_GT(quality.edges.max, 7 * quality.edges.min);
    EXPECT_GT(horns.back().vertex_sets.at("base").size(), 5u);
    for (const int v : horns.back().vertex_sets.at("base"))
      EXPECT_EQ(horns.back().vertices[static_cast<std::size_t>(v)].x(), 0.0);
  }
  for (std::size_t i = 1; i < horns.size(); ++i) {
    EXPECT_GT(horns[i - 1].tets.size(), 4 * horns[i].tets.size());
    const Embedding down = embed(horns[i].vertices, horns[i - 1], Outside::clamp);
    EXPECT_GT(down.misses, 0);
    EXPECT_LT(down.largest_distance_over_edge, 0.5);
  }
}

SameBody same(const TetMesh& finest, const TetMesh& coarse) {
  return compare_levels(mesh_size(finest, {1000}), mesh_size(coarse, {1000}), 1).same;
}
TetMesh only_region_of(TetMesh mesh) {
  mesh.region.clear();
  return mesh;
}

// What is meant as levels of one body is not doubted, from files and from generators.
TEST(CompareLevels, DoubtsNoCommittedMesh) {
  const auto read = [](const char* name) { return only_region_of(read_mesh(folder / name)); };
  for (const char* coarse : {"liver_medium.msh", "liver_coarse.msh"})
    EXPECT_EQ(same(read("liver_fine.msh"), read(coarse)), SameBody::yes) << coarse;
  for (const char* coarse : {"graded/horn_medium.msh", "graded/horn_coarse.msh"})
    EXPECT_EQ(same(read("graded/horn_fine.msh"), read(coarse)), SameBody::yes) << coarse;
  const auto ball = [](int cells) { return ball_mesh({0, 0, 0}, 0.05, cells); };
  EXPECT_EQ(same(ball(16), ball(4)), SameBody::yes);
  EXPECT_EQ(same(ball(4), ball(2)), SameBody::yes);
  EXPECT_EQ(same(ball(16), ball(1)), SameBody::doubtful);  // a cube of 37 % of the volume
  const auto part = [&](const char* of, const char* whole) {
    return covers_part(mesh_size(read(of), {1000}), mesh_size(read(whole), {1000}));
  };
  for (const char* coarse : {"liver_medium.msh", "liver_coarse.msh"})
    EXPECT_FALSE(part("liver_fine.msh", coarse) || part(coarse, "liver_fine.msh")) << coarse;
}

TEST(CompareLevels, RefusesAPartOfTheBody) {
  const auto box = [](double length, int cells) {
    return mesh_size(box_mesh({{0, 0, 0}, {length, 0.1, 0.1}}, {cells, 2, 2}), {1000});
  };
  EXPECT_TRUE(covers_part(box(0.3, 6), box(0.4, 8)));
  EXPECT_TRUE(covers_part(box(0.2, 16), box(0.4, 2))) << "by two edges, and half of the volume";
  EXPECT_FALSE(covers_part(box(0.4, 8), box(0.3, 6))) << "it is the whole";
  EXPECT_FALSE(covers_part(box(0.39, 32), box(0.4, 8))) << "by less than an edge";
  MeshSize other = box(0.3, 6);
  other.box.min[0] -= 0.2, other.box.max[0] -= 0.2;
  EXPECT_FALSE(covers_part(other, box(0.4, 8))) << "it lies elsewhere";
}

TEST(CompareLevels, RefusesAnotherScaleOrPlace) {
  const TetMesh fine = box_mesh({{0, 0, 0}, {0.2, 0.1, 0.1}}, {4, 2, 2});
  const auto coarse = [&](double scale, double shift) {
    TetMesh mesh = box_mesh({{0, 0, 0}, {0.2, 0.1, 0.1}}, {2, 1, 1});
    for (Point& p : mesh.vertices) p = scale * p + Point(shift, 0, 0);
    return mesh;
  };
  EXPECT_EQ(same(fine, coarse(1, 0)), SameBody::yes);
  EXPECT_EQ(same(fine, coarse(1.04, 0)), SameBody::yes);
  EXPECT_EQ(same(fine, coarse(1.06, 0)), SameBody::doubtful);
  EXPECT_EQ(same(fine, coarse(1, 0.02)), SameBody::doubtful);
  for (const double scale : {1e-3, 1e-2, 0.45, 2.1, 100.0, 1000.0})
    EXPECT_EQ(same(fine, coarse(scale, 0)), SameBody::no) << scale;
  for (const double shift : {-0.1, 0.06, 0.1})
    EXPECT_EQ(same(fine, coarse(1, shift)), SameBody::no) << shift;
  const MeshSize light = mesh_size(fine, {200}), heavy = mesh_size(fine, {1000});
  EXPECT_EQ(compare_levels(heavy, light, 1).same, SameBody::no);
  const std::string said = compare_levels(heavy, mesh_size(coarse(1000, 0), {1000}), 2).sentence;
  EXPECT_EQ(said,
            "level 2 is not the body of level 0: 200 x 100 x 100 m, 2e+06 m^3, 2e+09 kg, centroid "
            "[100, 50, 50] instead "
            "of 0.2 x 0.1 x 0.1 m, 0.002 m^3, 2 kg, centroid [0.1, 0.05, 0.05]; is the file of "
            "level 2 in mm? Then its "
            "scale is 0.001");
}

// What the fuzzers start from, and what they once found, without libFuzzer

TEST(FuzzCorpus, IsRefusedOrSound) {
  for (const fuzz::Target& target : fuzz::mesh_targets)
    EXPECT_GE(fuzz::replay(target), 3) << target.name;
}

// Every seed is a whole file, so that the fuzzers start behind the first checks
TEST(FuzzCorpus, SeedsAreRead) {
  for (const char* name : {"msh", "vtk", "vtu"})
    for (const auto& entry : std::filesystem::directory_iterator(fuzz::folder / "corpus" / name)) {
      const std::string seed = entry.path().filename().string();
      if (seed.starts_with("polydata") || seed == "surface") continue;  // holds no tetrahedra
      EXPECT_NO_THROW(read_mesh(FileBytes{std::string("m.") + name, load_file(entry.path()).bytes}))
          << entry.path();
    }
  for (const auto& entry : std::filesystem::directory_iterator(fuzz::folder / "corpus" / "medit"))
    EXPECT_NO_THROW(read_mesh(FileBytes{"m.mesh", load_file(entry.path()).bytes})) << entry.path();
  for (const char* name : {"obj", "ply", "off", "stl"})
    for (const auto& entry : std::filesystem::directory_iterator(fuzz::folder / "corpus" / name))
      EXPECT_NO_THROW(
          read_surface(FileBytes{std::string("m.") + name, load_file(entry.path()).bytes}))
          << entry.path();
}

}  // namespace
