// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <plica/drivers/contact/pair_search.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/vectors.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"

// The search for parts of surfaces that are near each other, in states that are not sound.
namespace {

using namespace plica;
using namespace plica::test;

constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();

/// Two blocks on top of each other, with a small gap between them.
Problem stacked() {
  const auto block = [](double z) {
    Body body =
        body_of({box_mesh({{0, 0, z}, {0.1, 0.1, z + 0.1}}, {3, 3, 3})}, "neo_hookean").body;
    body.surface = boundary_surface(body.levels[0]).surface;
    return body;
  };
  Problem p;
  p.body = join_bodies({{"under", block(0)}, {"over", block(0.1005)}});
  return p;
}

/// The search at given places of the surface's points.
struct Search {
  Problem problem = stacked();
  LevelProbe<Host> probe{problem};
  const ContactRecords<Host>& records = probe.at(0).response().records();
  PairSearch<Host> search{probe.at(0).contact()->limits(), records};
  BlockSums<Host> blocks{records.points};
  std::vector<Point> rest = problem.body.surface->vertices;

  /// Returns the triangle that each point may touch; -1: none.
  std::vector<int> partners(const std::vector<Point>& x) {
    const Host::Exec& exec = probe.built.hierarchy->exec();
    exec.fence();
    for (int p = 0; p < records.points; ++p)
      for (int k = 0; k < 3; ++k) records.places(p, k) = x[static_cast<std::size_t>(p)][k];
    search.find(exec, probe.at(0).surface, probe.at(0).state, records, true, blocks);
    exec.fence();
    const int* found = records.partner.data();
    return {found, found + records.points};
  }
};

// Whatever the places are, partners are triangles of the surface; and once places are sound again,
// so are the partners.
TEST(PairSearch, SurvivesPlacesThatAreNotFinite) {
  Search s;
  const std::vector<int> sound = s.partners(s.rest);
  std::vector<std::size_t> touching;
  for (std::size_t p = 0; p < sound.size(); ++p)
    if (sound[p] >= 0) touching.push_back(p);
  ASSERT_GE(touching.size(), 16u);
  const std::vector<std::vector<Point>> wild = {
      {Point::Constant(nan)},
      {Point::Constant(inf)},
      {Point::Constant(-inf)},
      {Point(0, inf, 0.1)},
      {Point(0.05, 0.05, nan)},
      {Point::Constant(1e300)},
      {Point::Constant(nan), Point::Constant(inf)},
      {Point::Constant(inf), Point::Constant(-inf), Point(1e160, -1e160, 0)},
      {Point(inf, 0, 0), Point(0, -1e300, 0), Point(0, 0, inf), Point(nan, 1e200, 0)}};
  for (std::size_t w = 0; w < wild.size(); ++w)
    for (const std::size_t every : {std::size_t{1}, std::size_t{3}, touching.size()}) {
      std::vector<Point> x = s.rest;
      for (std::size_t i = 0; i < touching.size(); i += every)
        x[touching[i]] = wild[w][i / every % wild[w].size()];
      for (std::size_t p = 0; every == 1 && p < x.size(); ++p) x[p] = wild[w][p % wild[w].size()];
      for (const int triangle : s.partners(x)) {
        EXPECT_GE(triangle, -1) << w << " " << every;
        EXPECT_LT(triangle, s.records.mesh.triangles) << w << " " << every;
      }
      EXPECT_EQ(s.partners(s.rest), sound) << w << " " << every;
    }
}

}  // namespace
