// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <plica/drivers/linear/make_linear_solver.hpp>
#include <plica/drivers/linear/stage_system.hpp>
#include <plica/drivers/spaces/coarse_spaces.hpp>
#include <plica/drivers/spaces/edge_graph.hpp>
#include <plica/drivers/spaces/moving_least_squares.hpp>
#include <plica/meshes/organs.hpp>
#include <set>

#include "support/him_pieces.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Coarse levels of one mesh: what they reproduce, what they keep apart, what they are good for.
namespace {

using namespace plica;
using namespace plica::test;

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::vector<int> all_of(const TetMesh& mesh) {
  std::vector<int> all(mesh.vertices.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::vector<char> none_of(const TetMesh& mesh) {
  return std::vector<char>(mesh.vertices.size(), 0);
}

std::vector<double> mass_of(const TetMesh& mesh) {
  return level_constants(body_of({mesh}).body, mesh, Point::Zero(), 0).mass;
}

BlockRows stiffness_of(const TetMesh& mesh) { return rest_stiffness(mesh, {{3e4, 1e4}}); }

/// Two prongs, 0.4 m long and a hundredth apart, that hang together at their left ends.
TetMesh fork() {
  TetMesh whole = box_mesh({{0, 0, 0}, {0.4, 0.05, 0.11}}, {40, 5, 11}), cut;
  std::vector<int> number(whole.vertices.size(), -1);
  for (const auto& t : whole.tets) {
    Point middle = Point::Zero();
    for (const int v : t) middle += whole.vertices[at(v)] / 4;
    if (middle[0] > 0.05 && middle[2] > 0.05 && middle[2] < 0.06) continue;
    auto& made = cut.tets.emplace_back(t);
    for (int& v : made) {
      int& there = number[at(v)];
      if (there < 0)
        there = static_cast<int>(cut.vertices.size()),
        cut.vertices.push_back(whole.vertices[at(v)]);
      v = there;
    }
  }
  return cut;
}

TEST(FarthestPoints, AreSpreadEvenlyAndReachEveryPart) {
  TetMesh two = box_mesh(beam_box, {16, 4, 4});
  const TetMesh other = box_mesh({{1, 0, 0}, {1.05, 0.05, 0.05}}, {2, 2, 2});
  const int first = static_cast<int>(two.vertices.size());
  two.vertices.insert(two.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (auto t : other.tets) {
    for (int& v : t) v += first;
    two.tets.push_back(t);
  }
  const EdgeGraph graph = edge_graph(two);
  const std::vector<int> order = farthest_points(graph, 60);
  ASSERT_EQ(order.size(), 60u);
  EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), 60u);
  EXPECT_NE(order[0] < first, order[1] < first);  // each part has one before any has two
  // no vertex is further from the points than twice their least distance: a walk from every point
  std::vector<double> nearest(two.vertices.size(), 1e9);
  double least = 1e9;
  EdgeWalk walk(graph);
  for (std::size_t j = 0; j < order.size(); ++j) {
    least = std::min(least, nearest[at(order[j])]);
    walk.from(order[j], 10, [&](int v, double d) { nearest[at(v)] = std::min(nearest[at(v)], d); });
  }
  EXPECT_LE(*std::max_element(nearest.begin(), nearest.end()), least);
  EXPECT_GE(point_graph(graph, order).spacing, least);
  EXPECT_LE(point_graph(graph, order).spacing, 2 * least);
}

TEST(FarthestPoints, OfAllVerticesAreAll) {
  const TetMesh mesh = box_mesh(decimetre, {2, 2, 2});
  EXPECT_EQ(farthest_points(edge_graph(mesh), 1000).size(), mesh.vertices.size());
}

TEST(EdgeWalk, FindsTheShortestWays) {
  const TetMesh mesh = irregular_beam();
  const EdgeGraph graph = edge_graph(mesh);
  constexpr double reach = 0.2, radius = 0.12;
  const auto straight = [&](int v) { return (mesh.vertices[at(v)] - mesh.vertices[0]).norm(); };
  std::vector<double> shortest(mesh.vertices.size(), 1e9);
  shortest[0] = 0;
  for (bool shrank = true; shrank;) {
    shrank = false;
    for (int v = 0; v < graph.vertices(); ++v)
      for (int k = graph.first[at(v)]; k < graph.first[at(v + 1)]; ++k)
        if (const double d = shortest[at(v)] + graph.length[at(k)];
            d < shortest[at(graph.neighbour[at(k)])])
          shortest[at(graph.neighbour[at(k)])] = d, shrank = true;
  }
  EdgeWalk walk(graph);
  std::vector<double> all(shortest.size(), 1e9), near = all;
  walk.from(0, reach, [&](int v, double d) { all[at(v)] = d; });
  walk.from(
      0, reach, [&](int v) { return std::max(0.0, straight(v) - radius); },
      [&](int v, double d) { near[at(v)] = d; });
  int reached = 0, left_out = 0;
  for (std::size_t v = 0; v < shortest.size(); ++v) {
    EXPECT_EQ(all[v], shortest[v] <= reach ? shortest[v] : 1e9);
    EXPECT_TRUE(near[v] == all[v] || straight(static_cast<int>(v)) >= radius);
    reached += all[v] < 1e9, left_out += all[v] < near[v];
  }
  EXPECT_GT(reached, 30);
  EXPECT_GT(left_out, 5);
}

TEST(PointGraph, JoinsPointsWhereTheirSurroundingsMeet) {
  const TetMesh mesh = fork();
  const EdgeGraph graph = edge_graph(mesh);
  const std::vector<int> points = farthest_points(graph, 150);
  const EdgeGraph coarse = point_graph(graph, points).graph;
  ASSERT_EQ(coarse.vertices(), 150);
  const auto prong = [&](int j) {
    const Point& p = coarse.place[at(j)];
    return p[0] < 0.2 ? 0 : p[2] > 0.055 ? 1 : -1;
  };
  std::map<std::pair<int, int>, double> length;
  for (int a = 0; a < coarse.vertices(); ++a) {
    EXPECT_EQ(coarse.place[at(a)], mesh.vertices[at(points[at(a)])]);
    for (int k = coarse.first[at(a)]; k < coarse.first[at(a + 1)]; ++k)
      length[{a, coarse.neighbour[at(k)]}] = coarse.length[at(k)];
  }
  for (const auto& [ends, l] : length) {
    const auto [a, b] = ends;
    EXPECT_EQ(l, (length.at({b, a})));
    EXPECT_GE(l, (coarse.place[at(a)] - coarse.place[at(b)]).norm());
    EXPECT_NE(prong(a) * prong(b), -1);
  }
  std::vector<double> far(mesh.vertices.size());
  EdgeWalk(graph).from(points[0], 10, [&](int v, double d) { far[at(v)] = d; });
  int reached = 0;
  EdgeWalk(coarse).from(0, 10, [&](int j, double d) {
    ++reached;
    EXPECT_LE(d, 1.4 * far[at(points[at(j)])]);
    EXPECT_GE(d, far[at(points[at(j)])] / 1.4);
  });
  EXPECT_EQ(reached, 150);
}

TEST(SparseProduct, IsThatOfTheFullMatrices) {
  const TetMesh mesh = irregular_beam();
  RowMatrix A = ring_smoothing(mesh);
  // some rows are empty
  A.prune([](Eigen::Index row, Eigen::Index, double) { return row % 3 != 1; });
  const RowMatrix B = RowMatrix(A.transpose()), C = product(A, B);
  const Eigen::MatrixXd full = Eigen::MatrixXd(A) * Eigen::MatrixXd(B);
  EXPECT_LE((Eigen::MatrixXd(C) - full).norm(), 1e-14 * full.norm());
  for (Eigen::Index row = 0; row < C.rows(); ++row)
    for (int k = C.outerIndexPtr()[row] + 1; k < C.outerIndexPtr()[row + 1]; ++k)
      EXPECT_LT(C.innerIndexPtr()[k - 1], C.innerIndexPtr()[k]);
}

TEST(MovingLeastSquares, ReproduceLinearFields) {
  for (const TetMesh& mesh : {irregular_beam(), blob_mesh(Point::Zero(), 0.12, 8)}) {
    const EdgeGraph graph = edge_graph(mesh);
    const std::vector<int> points =
        farthest_points(graph, static_cast<int>(mesh.vertices.size() / 5));
    const RowMatrix P =
        moving_least_squares(graph, all_of(mesh), points, point_graph(graph, points).spacing, 1.8);
    const auto field = [](const Point& x) { return 3 + x.dot(Point(1, -2, 0.5)); };
    for (Eigen::Index a = 0; a < P.rows(); ++a) {
      double sum = 0, value = 0;
      for (RowMatrix::InnerIterator entry(P, a); entry; ++entry) {
        sum += entry.value();
        value +=
            entry.value() * field(mesh.vertices[at(points[static_cast<std::size_t>(entry.col())])]);
      }
      EXPECT_NEAR(sum, 1, 2e-3);  // weights below 1e-4 are left out
      EXPECT_NEAR(value, field(mesh.vertices[static_cast<std::size_t>(a)]), 6e-3);
    }
    EXPECT_LE(static_cast<double>(P.nonZeros()) / static_cast<double>(P.rows()), 20);
  }
}

TEST(MovingLeastSquares, KeepApartWhatIsNotConnected) {
  const TetMesh mesh = fork();
  const EdgeGraph graph = edge_graph(mesh);
  const std::vector<int> points = farthest_points(graph, 150);
  const RowMatrix P =
      moving_least_squares(graph, all_of(mesh), points, point_graph(graph, points).spacing, 1.8);
  const auto upper = [&](int v) { return mesh.vertices[at(v)][2] > 0.055; };
  int looked_at = 0;
  for (Eigen::Index a = 0; a < P.rows(); ++a) {
    if (mesh.vertices[static_cast<std::size_t>(a)][0] < 0.2) continue;
    ++looked_at;
    for (RowMatrix::InnerIterator entry(P, a); entry; ++entry)
      EXPECT_EQ(upper(points[static_cast<std::size_t>(entry.col())]), upper(static_cast<int>(a)));
  }
  EXPECT_GT(looked_at, 500);
}

TEST(SliverSpace, IsNoneWhereThereAreNoSlivers) {
  const TetMesh mesh = box_mesh(beam_box, {8, 4, 4});
  EXPECT_FALSE(sliver_space(mesh, none_of(mesh), mass_of(mesh), stiffness_of(mesh)));
}

TEST(SliverSpace, LetsSliversFollowAndNothingElse) {
  const TetMesh mesh = irregular_beam();
  const BlockRows K = stiffness_of(mesh);
  const auto slivers = sliver_space(mesh, none_of(mesh), mass_of(mesh), K);
  ASSERT_TRUE(slivers);
  EXPECT_GT(slivers->before, 6);
  EXPECT_LE(slivers->after, 3.5);
  EXPECT_GT(slivers->kept.size(), 0.8 * static_cast<double>(mesh.vertices.size()));
  EXPECT_LT(slivers->kept.size(), mesh.vertices.size());
  // linear fields pass, and the rest of the mesh is as it was
  for (Eigen::Index a = 0; a < slivers->up.rows(); ++a) {
    Point x = Point::Zero();
    int entries = 0;
    for (RowMatrix::InnerIterator entry(slivers->up, a); entry; ++entry, ++entries)
      x += entry.value() * mesh.vertices[at(slivers->kept[static_cast<std::size_t>(entry.col())])];
    EXPECT_LE((x - mesh.vertices[static_cast<std::size_t>(a)]).norm(), 1e-6);
  }
  EXPECT_LE(slivers->up.nonZeros(), 4 * slivers->up.rows());
  // lambda_max is between the largest lambda_a and four times that, also of what is left
  const auto mass = mass_of(mesh);
  std::vector<double> carried(slivers->kept.size(), 0.0);
  for (Eigen::Index a = 0; a < slivers->up.rows(); ++a)
    for (RowMatrix::InnerIterator entry(slivers->up, a); entry; ++entry)
      carried[static_cast<std::size_t>(entry.col())] +=
          entry.value() * mass[static_cast<std::size_t>(a)];
  EXPECT_NEAR(std::accumulate(carried.begin(), carried.end(), 0.0),
              std::accumulate(mass.begin(), mass.end(), 0.0), 1e-9);
  for (const double m : carried) EXPECT_GT(m, 0);
}

TEST(SpaceSizes, EndWithAFewHundredInEvenSteps) {
  EXPECT_TRUE(space_sizes(100).empty());
  EXPECT_EQ(space_sizes(400), std::vector<int>{100});
  for (const int vertices : {2'000, 5'000, 20'000, 200'000, 1'000'000}) {
    const std::vector<int> sizes = space_sizes(vertices),
                           touched = space_sizes(vertices, him_sizes_with_contact);
    EXPECT_EQ(sizes.back(), std::clamp(vertices / 25, 100, 300)) << vertices;
    EXPECT_EQ(touched.back(), 300) << vertices << ": what touches is detail";
    EXPECT_LE(sizes.front(), vertices / 4 + 1) << vertices;
    for (std::size_t i = 1; i < sizes.size(); ++i)
      EXPECT_LE(sizes[i - 1], 5.1 * sizes[i]) << vertices;
  }
}

TEST(MassSpaces, AnswerATranslationAsOne) {
  for (const Problem& problem : {him_beam(false), him_beam_alone()}) {
    std::vector<RowMatrix> transfers;
    const std::vector<TetMesh>& meshes = problem.body.levels;
    const auto mass = mass_of(meshes[0]);
    if (meshes.size() == 1)
      for (const CoarseSpace& space : coarse_spaces(meshes[0], none_of(meshes[0]), mass,
                                                    stiffness_of(meshes[0]), {.sizes = {200, 60}}))
        transfers.push_back(space.up);
    for (std::size_t i = 1; i < meshes.size(); ++i)
      transfers.push_back(
          transfer_matrix(meshes[i - 1], none_of(meshes[i - 1]), meshes[i], none_of(meshes[i]),
                          embed(meshes[i - 1].vertices, meshes[i], Outside::extrapolate), true));
    const MassSpace space = mass_spaces(transfers, mass).front();
    const Eigen::Index n = space.mass.rows();
    const Eigen::Map<const Eigen::ArrayXd> E(space.scale.data(), n),
        D(space.inverse_diagonal.data(), n);
    const Eigen::VectorXd momentum = space.mass * Eigen::VectorXd::Ones(n);
    const Eigen::VectorXd x = (E * momentum.array()).matrix(), lumped = (D * x.array()).matrix();
    const Eigen::ArrayXd answer = E * D * (2 * x - space.mass * lumped).array();
    EXPECT_LE((answer - 1).abs().maxCoeff(), 0.02);
  }
}

/// Of displacement at the end, against the finest level alone.
/// @param over_critical  the macro step over that level's; 0: him's own
double him_error(const Problem& problem, double duration, double over_critical = 0) {
  Problem p = problem;
  p.integration.cycle = "single";
  Simulation<Host> single(p);
  p.integration.cycle = "him";
  const double asked = over_critical > 0 ? over_critical * single.levels()[0].critical_step
                                         : Simulation<Host>(p).macro_step();
  p.integration.macro_step = duration / std::ceil(duration / asked);
  Simulation<Host> stepped(p);
  EXPECT_GT(stepped.macro_step(), 6 * single.macro_step());
  for (Simulation<Host>* one : {&single, &stepped}) {
    one->end_at(duration);
    while (one->time() < duration * (1 - 1e-9))
      if (const auto bad = one->step_checked()) return ADD_FAILURE() << bad->text(), 1.0;
  }
  const auto u = displacements(stepped, p.body.levels[0]),
             truth = displacements(single, p.body.levels[0]);
  const auto difference = minus(u, truth);
  return std::sqrt(dot(difference, difference) / dot(truth, truth));
}

/// A beam of these meshes that sags, clamped at one end.
Problem sagging(std::vector<TetMesh> levels, const char* element) {
  Problem p = body_of(std::move(levels), "neo_hookean");
  p.body.element = {element};
  p.body.fixed = {left_face()};
  p.body.material.young_modulus = 200e3;
  p.gravity = {0, 0, -9.81};
  p.integration.cycle = "him";
  return p;
}

TEST(Him, NeedsOneMeshOnly) {
  for (const char* element : {"linear", "nodal"})
    EXPECT_LE(him_error(sagging({irregular_beam()}, element), 0.1), 0.02) << element;
}

// Slivers of the finest mesh do not slow the rest of it above coarser meshes that are given either:
// without a space for them the errors are 1.5 and 2.5 %
TEST(Him, LetsSliversFollowAboveGivenMeshes) {
  const TetMesh regular = box_mesh(beam_box, {20, 5, 5}),
                coarser = jittered_box(beam_box, {5, 2, 2});
  const TetMesh slivers = with_slivers(jittered_box(beam_box, {20, 5, 5}, 0.2), 0.003);
  const Simulation<Host> him(sagging({slivers, coarser}, "linear"));
  const auto& levels = him.levels();
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_EQ(levels[1].kind, LevelKind::slivers);
  EXPECT_LT(levels[1].vertices, levels[0].vertices);
  EXPECT_EQ(levels[2].kind, LevelKind::mesh);
  EXPECT_EQ(levels[2].vertices, static_cast<int>(coarser.vertices.size()));
  EXPECT_NEAR(him.macro_step(), 8 * levels[0].detail_step, 1e-9 * him.macro_step());
  EXPECT_EQ(Simulation<Host>(sagging({regular, coarser}, "linear")).levels().size(), 2u);
  EXPECT_LE(him_error(sagging({slivers, coarser}, "linear"), 0.1, 20), 0.011);
  EXPECT_LE(him_error(sagging({slivers, coarser}, "nodal"), 0.1, 20), 0.019);
}

TEST(LevelsBelow, AreAsGivenWhereNothingIsASliver) {
  const std::vector<TetMesh> meshes = {box_mesh(beam_box, {8, 4, 4}),
                                       jittered_box(beam_box, {5, 3, 3})};
  const std::vector<char> none[] = {none_of(meshes[0]), none_of(meshes[1])};
  const std::vector<RestLevel> levels = {{meshes[0], none[0]}, {meshes[1], none[1]}};
  const auto transfer = [&](bool slivers) {
    const LevelsBelow below = levels_below(levels, mass_of(meshes[0]), stiffness_of(meshes[0]),
                                           {.sizes = {}, .slivers = slivers}, true);
    EXPECT_EQ(below.transfers.size(), 1u);
    return below.transfers.front();
  };
  EXPECT_EQ((transfer(true) - transfer(false)).norm(), 0);
}

// What spaces made of one mesh get, given meshes get too: translations stay
TEST(Him, ScalesTheSpacesOfGivenMeshes) {
  Problem p = him_beam(false, "neo_hookean");
  p.body.levels.front() = irregular_beam();
  const std::vector<TetMesh>& meshes = p.body.levels;
  std::vector<std::vector<char>> none;
  std::vector<RestLevel> levels;
  for (const TetMesh& mesh : meshes) none.push_back(none_of(mesh));
  for (std::size_t i = 0; i < meshes.size(); ++i) levels.push_back({meshes[i], none[i]});
  const LevelsBelow below = levels_below(levels, {}, {}, {.sizes = {}}, true);
  ASSERT_EQ(below.transfers.size(), 2u);
  EXPECT_TRUE(below.made.empty());
  const auto spaces = mass_spaces(below.transfers, mass_of(meshes[0]));
  EXPECT_TRUE(spaces.back().scale.empty()) << "the last one has no use for it";
  const MassSpace& space = spaces.front();
  const Eigen::Index n = space.mass.rows();
  const Eigen::Map<const Eigen::ArrayXd> E(space.scale.data(), n),
      D(space.inverse_diagonal.data(), n);
  const Eigen::VectorXd momentum = space.mass * Eigen::VectorXd::Ones(n);
  const Eigen::VectorXd x = (E * momentum.array()).matrix(), lumped = (D * x.array()).matrix();
  EXPECT_LE((E * D * (2 * x - space.mass * lumped).array() - 1).abs().maxCoeff(), 0.02);
}

TEST(Him, ReportsTheSpacesItMade) {
  const Problem p = him_beam_alone();
  const Simulation<Host> him(p);
  const auto& levels = him.levels();
  ASSERT_EQ(levels.size(), 4u);  // the mesh, slivers, 150, 40
  EXPECT_GT(levels[1].vertices, 300);
  EXPECT_EQ(levels[2].vertices, 150);
  EXPECT_EQ(levels[3].vertices, 40);
  for (std::size_t i = 1; i < levels.size(); ++i) {
    EXPECT_EQ(levels[i].tets, 0);
    EXPECT_GE(levels[i].nonzeros, 1);
  }
  EXPECT_EQ(levels[1].mean_edge, 0);
  EXPECT_GT(levels[3].mean_edge, levels[2].mean_edge);
}

TEST(Coarsen, RefusesWhatItCannotDo) {
  Problem p = him_beam_alone();
  const auto refused = [&] { return refusal([&] { validate(p); }); };
  EXPECT_EQ(refused(), "");
  p.integration.cycle = "rsv";
  EXPECT_NE(refused().find("cycle rsv integrates its coarser levels"), std::string::npos)
      << refused();
  p.integration.cycle = "him", p.body.coarsen = {150, 150};
  EXPECT_NE(refused().find("expected fewer points from level to level"), std::string::npos)
      << refused();
  p.body.coarsen = {29};
  EXPECT_NE(refused().find("expected a whole number >= 30"), std::string::npos) << refused();
  p.body.coarsen = {100000};
  EXPECT_NE(refused().find("expected a whole number in [30, "), std::string::npos) << refused();
  p = him_beam(true), p.body.coarsen = {30};  // the coarsest mesh has 12 vertices
  EXPECT_NE(refused().find("body.levels.3.coarsen"), std::string::npos) << refused();
}

}  // namespace
