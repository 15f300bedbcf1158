// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/composite_box.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// The cycle him on a mesh of two pieces, over spaces that are made of it, or over a coarse mesh of
// the whole body.
namespace {

using namespace plica;
using namespace plica::test;

Problem beam_of_pieces(bool nested, bool over_mesh, const std::string& element) {
  Problem p = body_of({composite_beam(nested)}, "neo_hookean");
  if (over_mesh)
    p.body.levels.push_back(box_mesh(beam_box, {5, 2, 2}));
  else
    p.body.coarsen = {100, 40};
  p.body.element = {element}, p.body.material.poisson_ratio = 0.3;
  p.integration.cycle = "him";
  return p;
}

template <class Check>
void for_beams(const Check& check) {
  for (const bool nested : {true, false})
    for (const bool over_mesh : {true, false})
      for (const char* element : {"linear", "nodal"}) {
        SCOPED_TRACE(std::string(element) + (nested ? ", nested" : "") +
                     (over_mesh ? ", over a mesh" : ", over spaces"));
        check(beam_of_pieces(nested, over_mesh, element));
      }
}

// A fall has no strain: the inertia must be that of the masses, at the border too
TEST(HimPieces, FallLikeOneBody) {
  for_beams([](Problem p) {
    p.gravity = {0, 0, -9.81};
    Simulation<Host> s(p);
    EXPECT_GT(s.macro_step(), 1.5 * s.levels()[0].critical_step);
    while (s.time() < 0.1) advance(s, 1);
    const double way = -0.5 * 9.81 * s.time() * s.time();
    for (const Point& u : displacements(s, p.body.levels[0]))
      EXPECT_LT((u - Point(0, 0, way)).norm(), 1e-5 * std::abs(way));
  });
}

TEST(HimPieces, SagAsTheyDoInShortSteps) {
  for_beams([](Problem p) {
    p.body.fixed = {left_face()}, p.gravity = {0, 0, -9.81};
    p.body.material.young_modulus = 200e3;
    Problem plain = p;
    plain.integration.cycle = "single";
    const auto at_end = [](const Problem& of) {
      Simulation<Host> s(of);
      while (s.time() < 0.1) advance(s, 1);
      return std::pair(displacements(s, of.body.levels[0]), s.time());
    };
    const auto [got, time] = at_end(p);
    plain.integration.macro_step = time / 500;
    Simulation<Host> s(plain);
    advance(s, 500);
    const std::vector<Point> want = displacements(s, p.body.levels[0]);
    EXPECT_GT(largest(want), 5e-3);
    EXPECT_LT(largest_difference(got, want), 0.03 * largest(want));
  });
}

}  // namespace
