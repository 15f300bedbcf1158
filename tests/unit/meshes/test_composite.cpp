// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/common_volume.hpp>
#include <plica/meshes/composite.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/generators.hpp>
#include <plica/meshes/jitter.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/reordering.hpp>

#include "support/refusal.hpp"

// Volumes that tetrahedra have in common, and meshes that are finer in a part of the body.
namespace {

using namespace plica;
using plica::test::refusal;

const Box beam{{0, 0, 0}, {0.4, 0.1, 0.1}};
const std::array<int, 3> coarse_cells = {16, 4, 4};

TetMesh beam_mesh(const std::array<int, 3>& cells) { return box_mesh(beam, cells); }

double volume_of(const std::array<Point, 4>& x) { return tet_volume(x[0], x[1], x[2], x[3]); }

double body_volume(const TetMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    sum += mesh.part(t) * volume_of(corners_of(mesh, static_cast<int>(t)));
  return sum;
}

std::vector<int> tets_where(const TetMesh& mesh, const auto& inside) {
  std::vector<int> chosen;
  for (int t = 0; t < static_cast<int>(mesh.tets.size()); ++t) {
    const auto x = corners_of(mesh, t);
    if (inside(Point((x[0] + x[1] + x[2] + x[3]) / 4))) chosen.push_back(t);
  }
  return chosen;
}

auto in_ball(const Point& centre, double radius) {
  return [=](const Point& p) { return (p - centre).norm() < radius; };
}

/// A ball on the beam's lower face: its tetrahedra, each in eight.
PartMesh refined_ball(const TetMesh& coarse, double radius = 0.045) {
  return refined(cut_out(whole_mesh(coarse), tets_where(coarse, in_ball({0.2, 0.05, 0}, radius))));
}

/// Expects followers to be where their masters put them, and to follow none that follows.
void expect_followed(const TetMesh& mesh, double rounding) {
  const std::vector<char> follows = follows_others(mesh);
  std::vector<Point> places = mesh.vertices;
  follow_masters(mesh.followers, places);
  for (std::size_t i = 0; i < mesh.followers.vertex.size(); ++i) {
    const auto v = static_cast<std::size_t>(mesh.followers.vertex[i]);
    EXPECT_LE((places[v] - mesh.vertices[v]).norm(), rounding);
    for (const int master : mesh.followers.of[i])
      EXPECT_EQ(follows[static_cast<std::size_t>(master)], 0);
    const auto& w = mesh.followers.weight[i];
    EXPECT_NEAR(std::accumulate(w.begin(), w.end(), 0.), 1, 1e-14);
  }
  EXPECT_TRUE(std::ranges::is_sorted(mesh.followers.vertex));
}

TEST(CommonVolume, OfShiftedCorners) {
  const std::array<Point, 4> corner = {Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0),
                                       Point(0, 0, 1)};
  for (const double shift : {0., 0.25, 0.5, 0.9, 1., 2.}) {
    std::array<Point, 4> moved = corner;
    for (Point& p : moved) p[0] += shift;
    const double left = std::max(0., 1 - shift);
    EXPECT_NEAR(common_volume(corner, moved), left * left * left / 6, 1e-15) << shift;
    EXPECT_NEAR(common_volume(moved, corner), left * left * left / 6, 1e-15) << shift;
  }
}

TEST(CommonVolume, OfOneInsideTheOtherIsItsOwn) {
  const std::array<Point, 4> large = {Point(1, 2, 3), Point(2, 2.1, 3.2), Point(0.9, 3, 2.8),
                                      Point(1.2, 2.3, 4)};
  std::array<Point, 4> small = large;
  const Point centre = (large[0] + large[1] + large[2] + large[3]) / 4;
  for (Point& p : small) p = centre + (p - centre) / 2;
  EXPECT_NEAR(common_volume(small, large), volume_of(large) / 8, 1e-15);
  EXPECT_NEAR(common_volume(large, small), volume_of(large) / 8, 1e-15);
}

// Two meshes of one box: what each tetrahedron has in common with all of the other mesh is itself.
TEST(CommonVolume, SumsToTheTetrahedron) {
  const TetMesh one = jittered(beam_mesh({7, 3, 3}), 0.3, 1),
                other = jittered(beam_mesh({5, 2, 2}), 0.3, 2);
  const TetLocator locator(other);
  std::vector<double> of_other(other.tets.size(), 0);
  for (int t = 0; t < static_cast<int>(one.tets.size()); ++t) {
    const auto x = corners_of(one, t);
    double sum = 0;
    for (const int c : locator.tets_near(bounding_box(std::vector<Point>(x.begin(), x.end())))) {
      const double volume = common_volume(x, corners_of(other, c));
      sum += volume, of_other[static_cast<std::size_t>(c)] += volume;
    }
    EXPECT_NEAR(sum / volume_of(x), 1, 1e-12);
  }
  for (std::size_t c = 0; c < of_other.size(); ++c)
    EXPECT_NEAR(of_other[c] / volume_of(corners_of(other, static_cast<int>(c))), 1, 1e-12);
}

TEST(Composite, NestedMeshesAreJoinedExactly) {
  const TetMesh coarse = beam_mesh(coarse_cells);
  const PartMesh part{box_mesh({{0.2, 0, 0}, {0.3, 0.05, 0.1}}, {8, 4, 8})};
  const Composite made = compose(part, coarse);
  EXPECT_EQ(made.cut, 0);
  EXPECT_EQ(made.dropped, 6 * 4 * 2 * 4);
  EXPECT_TRUE(made.mesh.filled.empty());
  EXPECT_TRUE(made.doubts.empty());
  EXPECT_EQ(made.mesh.tets.size(), part.mesh.tets.size() + coarse.tets.size() - 6 * 4 * 2 * 4);
  EXPECT_NEAR(made.covered_volume / body_volume(part.mesh), 1, 1e-13);
  EXPECT_NEAR(body_volume(made.mesh) / body_volume(coarse), 1, 1e-13);
  // two faces across x of 5 x 9 vertices, one across y of 9 x 9, less two common edges
  EXPECT_EQ(made.mesh.followers.vertex.size(), 2u * 5 * 9 + 9 * 9 - 2 * 9);
  expect_followed(made.mesh, 1e-15);
  const TriangleSurface skin = boundary_surface(made.mesh).surface;
  EXPECT_NEAR(surface_area(skin), 2 * (0.1 * 0.1 + 2 * 0.4 * 0.1), 1e-13);
  EXPECT_NEAR(enclosed_volume(skin), 0.4 * 0.1 * 0.1, 1e-14);
}

TEST(Composite, RefinedPartsHangOnEdges) {
  const TetMesh coarse = beam_mesh(coarse_cells);
  const PartMesh part = refined_ball(coarse);
  const Composite made = compose(part, coarse);
  EXPECT_EQ(made.cut, 0);
  EXPECT_EQ(8 * made.dropped, std::ssize(part.mesh.tets));
  EXPECT_NEAR(body_volume(made.mesh) / body_volume(coarse), 1, 1e-13);
  int middles = 0;
  for (const auto& w : made.mesh.followers.weight) {
    const auto halves =
        std::ranges::count_if(w, [](double x) { return std::abs(x - 0.5) < 1e-12; });
    EXPECT_TRUE(halves == 2 || std::abs(std::ranges::max(w) - 1) < 1e-12);
    middles += halves == 2 ? 1 : 0;
  }
  EXPECT_GT(middles, 10);
  expect_followed(made.mesh, 1e-15);
  EXPECT_NEAR(surface_area(boundary_surface(made.mesh).surface), 0.18, 1e-13);
}

// A part whose mesh has nothing to do with the coarser one. Dropped slivers are below 2 % of the
// tetrahedra that they are of.
TEST(Composite, OtherMeshesKeepVolumeAndLinearFields) {
  const TetMesh coarse = jittered(beam_mesh({13, 3, 3}), 0.2);
  const PartMesh part{jittered(box_mesh({{0.13, 0, 0.02}, {0.29, 0.1, 0.1}}, {9, 6, 5}), 0.2, 7)};
  const Composite made = compose(part, coarse);
  EXPECT_GT(made.cut, 20);
  EXPECT_GT(made.dropped, 20);
  EXPECT_NEAR(made.covered_volume / body_volume(part.mesh), 1, 1e-12);
  EXPECT_NEAR(body_volume(made.mesh) / body_volume(coarse), 1, 4e-3);
  expect_followed(made.mesh, 1e-14);
  for (const double filled : made.mesh.filled) EXPECT_TRUE(filled >= 0.02 && filled <= 1);

  Eigen::Matrix3d gradient;
  gradient << 0.3, -0.2, 0.1, 0.4, 0.5, -0.6, 0.7, 0.1, -0.9;
  std::vector<Point> field;
  for (const Point& x : made.mesh.vertices) field.emplace_back(gradient * x + Point(1, 2, 3));
  std::vector<Point> followed = field;
  follow_masters(made.mesh.followers, followed);
  for (std::size_t v = 0; v < field.size(); ++v) EXPECT_LE((followed[v] - field[v]).norm(), 1e-13);
}

TEST(Composite, GivesSumsAndMomentsToMasters) {
  const TetMesh mesh = compose(refined_ball(beam_mesh(coarse_cells)), beam_mesh(coarse_cells)).mesh;
  std::vector<Point> force;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    force.emplace_back(std::sin(double(v)), std::cos(3. * double(v)), std::sin(7. * double(v)));
  const auto sums = [&] {
    Point sum = Point::Zero(), moment = Point::Zero();
    for (std::size_t v = 0; v < force.size(); ++v)
      sum += force[v], moment += mesh.vertices[v].cross(force[v]);
    return std::pair(sum, moment);
  };
  const auto [sum, moment] = sums();
  give_to_masters(mesh.followers, force);
  const auto [sum_after, moment_after] = sums();
  EXPECT_LE((sum_after - sum).norm(), 1e-12);
  EXPECT_LE((moment_after - moment).norm(), 1e-12);
  for (const int v : mesh.followers.vertex) EXPECT_EQ(force[static_cast<std::size_t>(v)].norm(), 0);
}

// A part cut out of a whole mesh knows its skin; without that it is found by distance.
TEST(Composite, FindsTheSkin) {
  const TetMesh coarse = jittered(beam_mesh({13, 3, 3}), 0.2), fine = beam_mesh({24, 6, 6});
  PartMesh part = cut_out(whole_mesh(fine), tets_where(fine, in_ball({0.2, 0, 0.1}, 0.06)));
  const Followers known = compose(part, coarse).mesh.followers;
  part.skin.reset();
  const Followers found = compose(part, coarse).mesh.followers;
  EXPECT_EQ(found.vertex, known.vertex);
  EXPECT_EQ(found.of, known.of);
  EXPECT_GT(known.vertex.size(), 30u);
}

TEST(Composite, TakesTheBorderByName) {
  const TetMesh coarse = beam_mesh(coarse_cells);
  PartMesh part{box_mesh({{0.2, 0, 0}, {0.4, 0.1, 0.1}}, {16, 8, 8})};
  for (int v = 0; v < static_cast<int>(part.mesh.vertices.size()); ++v)
    if (part.mesh.vertices[static_cast<std::size_t>(v)][0] < 0.2 + 1e-9)
      part.mesh.vertex_sets["cut"].push_back(v);
  const TetMesh mesh = compose(part, coarse, "cut").mesh;
  EXPECT_EQ(mesh.followers.vertex, part.mesh.vertex_sets["cut"]);
  EXPECT_EQ(mesh.followers.vertex, compose(part, coarse).mesh.followers.vertex);
  EXPECT_NE(refusal([&] { compose(part, coarse, "cuts"); }).find("did you mean 'cut'"),
            std::string::npos);
}

// Half a ball whose facets are larger than those of the other mesh, which so hangs over its skin by
// some hundredths of the volume.
TEST(Composite, CountsWhatHangsOverTheSkin) {
  const TetMesh all = ball_mesh({0, 0, 0}, 0.1, 6), facets = ball_mesh({0, 0, 0}, 0.1, 4);
  const PartMesh part =
      cut_out(whole_mesh(facets), tets_where(facets, [](const Point& p) { return p[0] > 0; }));
  ASSERT_GT(body_volume(all), 1.01 * body_volume(facets));
  const Composite made = compose(part, all);
  EXPECT_NEAR(body_volume(made.mesh), (body_volume(all) + body_volume(facets)) / 2,
              0.01 * body_volume(all));
  double beyond = 0;  // what of the other mesh is left away from the border
  for (std::size_t t = 0; t < made.mesh.tets.size(); ++t) {
    const auto x = corners_of(made.mesh, static_cast<int>(t));
    if (made.mesh.piece[t] == 1 && (x[0] + x[1] + x[2] + x[3])[0] / 4 > 0.04)
      beyond += made.mesh.part(t) * volume_of(x);
  }
  EXPECT_LT(beyond, 0.001 * body_volume(all));
}

TEST(Composite, OfPartsInParts) {
  const TetMesh coarse = beam_mesh(coarse_cells);
  const PartMesh middle = refined_ball(coarse, 0.09);
  const TetMesh two = compose(middle, coarse).mesh;
  const PartMesh inner =
      refined(cut_out(middle, tets_where(middle.mesh, in_ball({0.2, 0.05, 0}, 0.025))));
  const Composite three = compose(inner, two);
  EXPECT_EQ(*std::ranges::max_element(three.mesh.piece), 2);
  EXPECT_NEAR(body_volume(three.mesh) / body_volume(coarse), 1, 1e-13);
  EXPECT_TRUE(three.mesh.filled.empty());
  EXPECT_GT(three.mesh.followers.vertex.size(), two.followers.vertex.size());
  expect_followed(three.mesh, 1e-15);
  EXPECT_NEAR(surface_area(boundary_surface(three.mesh).surface), 0.18, 1e-13);

  const PartMesh near =
      refined(cut_out(middle, tets_where(middle.mesh, in_ball({0.2, 0.05, 0}, 0.08))));
  EXPECT_NE(refusal([&] { compose(near, two); }).find("edges from the border of the next level"),
            std::string::npos);
}

TEST(Composite, JoinsWhatMeshesSayByName) {
  TetMesh coarse = beam_mesh(coarse_cells);
  coarse.region_names = {"soft", "hard"};
  for (std::size_t t = 0; t < coarse.tets.size(); ++t)
    coarse.region.push_back(corners_of(coarse, static_cast<int>(t))[0][0] < 0.2 ? 0 : 1);
  for (int v = 0; v < static_cast<int>(coarse.vertices.size()); ++v)
    if (coarse.vertices[static_cast<std::size_t>(v)][0] == 0)
      coarse.vertex_sets["base"].push_back(v);
  coarse.tet_vectors["along"].assign(coarse.tets.size(), Point(1, 0, 0));
  PartMesh part = refined_ball(coarse);
  part.mesh.region_names = {"hard", "tumour"};
  part.mesh.region.assign(part.mesh.tets.size(), 1);
  part.mesh.vertex_sets["target"] = {0, 1};
  const TetMesh mesh = compose(part, coarse).mesh;
  EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"hard", "tumour", "soft"}));
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const double x = corners_of(mesh, static_cast<int>(t))[0][0];
    EXPECT_EQ(mesh.region[t], mesh.piece[t] == 0 ? 1 : x < 0.2 ? 2 : 0);
  }
  EXPECT_EQ(mesh.vertex_sets.at("base").size(), 25u);
  for (const int v : mesh.vertex_sets.at("base"))
    EXPECT_EQ(mesh.vertices[static_cast<std::size_t>(v)][0], 0);
  EXPECT_EQ(mesh.vertex_sets.at("target"), (std::vector<int>{0, 1}));
  EXPECT_EQ(mesh.tet_vectors.at("along").size(), mesh.tets.size());
}

TEST(Composite, IsReorderedWithItsFollowers) {
  const TetMesh mesh = compose(refined_ball(beam_mesh(coarse_cells)), beam_mesh(coarse_cells)).mesh;
  const Reordering order = locality_order(mesh);
  const TetMesh other = reordered(mesh, order);
  expect_followed(other, 1e-15);
  EXPECT_EQ(other.followers.vertex.size(), mesh.followers.vertex.size());
  EXPECT_EQ(std::ranges::count(other.piece, 0), std::ranges::count(mesh.piece, 0));
  EXPECT_NEAR(surface_area(boundary_surface(other).surface), 0.18, 1e-13);
  const TetMesh back = reordered(other, inverse(order));
  EXPECT_EQ(back.followers.vertex, mesh.followers.vertex);
  EXPECT_EQ(back.followers.of, mesh.followers.of);
  EXPECT_EQ(back.inner_faces, mesh.inner_faces);
  EXPECT_EQ(back.piece, mesh.piece);
}

TEST(Composite, RefusesWhatIsNoPart) {
  const TetMesh coarse = beam_mesh(coarse_cells);
  const auto why = [&](const Box& box) {
    return refusal([&] { compose(PartMesh{box_mesh(box, {4, 4, 4})}, coarse); });
  };
  EXPECT_EQ(why({{2, 0, 0}, {2.1, 0.1, 0.1}}).find("the part covers nothing"), 0u);
  EXPECT_EQ(why({{0.3, 0, 0}, {0.5, 0.1, 0.1}}).find("the part sticks out"), 0u);
  EXPECT_EQ(why(beam).find("the part has no border"), 0u);
  TetMesh lattice = coarse;
  lattice.filled.assign(coarse.tets.size(), 0.5);
  EXPECT_NE(refusal([&] { compose(refined_ball(coarse), lattice); }).find("lattice"),
            std::string::npos);
  const TetMesh whole = compose(refined_ball(coarse), coarse).mesh;
  EXPECT_NE(refusal([&] { compose(PartMesh{whole}, coarse); }).find("pieces"), std::string::npos);
}

// A part that is thicker than the body: its skin is not the coarser one's, and it would weigh more.
TEST(Composite, RefusesAnotherVolume) {
  const TetMesh coarse = beam_mesh(coarse_cells);
  PartMesh part{box_mesh({{0.1, -0.015, -0.015}, {0.3, 0.115, 0.115}}, {8, 4, 4})};
  part.skin.emplace();
  for (const auto& t : boundary_triangles(part.mesh))
    if (std::ranges::any_of(t, [&](int v) {
          const double x = part.mesh.vertices[static_cast<std::size_t>(v)][0];
          return x > 0.1 + 1e-9 && x < 0.3 - 1e-9;
        }))
      part.skin->push_back(t);
  EXPECT_EQ(refusal([&] { compose(part, coarse); }).find("the part changes the volume by "), 0u);
}

TEST(Composite, DoubtsEdgesOfOtherSizes) {
  const TetMesh coarse = beam_mesh(coarse_cells);
  const PartMesh part{box_mesh({{0.1, 0, 0}, {0.3, 0.1, 0.1}}, {2, 1, 1})};
  const Composite made = compose(part, coarse);
  ASSERT_EQ(made.doubts.size(), 1u);
  EXPECT_NE(made.doubts.front().find("expected coarser ones 1 to 4 times as long"),
            std::string::npos);
}

}  // namespace
