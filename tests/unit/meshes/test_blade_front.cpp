// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/meshes/blade_front.hpp>

// What a blade sweeps in a body that moves.
namespace {

using namespace plica;

const TetMesh& cube() {
  static const TetMesh mesh = jittered_box({{0, 0, 0}, {1, 1, 1}}, {6, 6, 6});
  return mesh;
}

std::vector<Point> moved(const Point& by) {
  std::vector<Point> at = cube().vertices;
  for (Point& p : at) p += by;
  return at;
}

BladeFront::Edge edge_at(const Point& middle, double half = 0.3) {
  return {middle - Point(0, half, 0), middle + Point(0, half, 0)};
}

void add(Faces& all, const Faces& more) {
  Faces sum;
  std::ranges::set_union(all, more, std::back_inserter(sum));
  all = sum;
}

// The body goes to and fro while the blade goes down. In the body, each step of the blade starts
// where the last one has ended: the faces are those across this zigzag. The blade's ends are in the
// body, or beyond its sides
void expect_zigzag(double half) {
  BladeFront front(edge_at({0.5, 0.5, 0.9}, half), 0.08);
  Faces opened, expected;
  Point blade(0.5, 0.5, 0.9), cut = blade;  // the edge's middle in the room, and in the body
  for (int n = 0; n < 6; ++n) {
    const Point shift(0.11 * (n % 3) - 0.08, 0.02 * n, 0.01 * n), goal = blade - Point(0, 0, 0.1);
    if (n == 0) cut = blade - shift;
    const auto at = moved(shift);
    add(opened,
        faces_across(cube().tets, at,
                     front.advance(cube().tets, at, edge_at(blade, half), edge_at(goal, half))));
    const Point end = goal - shift;
    const auto from = edge_at(cut, half), to = edge_at(end, half);
    add(expected, faces_across(cube().tets, cube().vertices,
                               {{from[0], from[1], to[1]}, {from[0], to[1], to[0]}}));
    blade = goal, cut = end;
  }
  EXPECT_GT(expected.size(), 40u);
  EXPECT_EQ(opened, expected);
}

TEST(BladeFront, GoesOnWhereTheBodyHasCarriedIt) {
  for (const double half : {0.3, 0.8}) {
    SCOPED_TRACE(half);
    expect_zigzag(half);
  }
}

TEST(BladeFront, StaysWhereTheBodyTakesItAlong) {
  BladeFront front(edge_at({0.5, 0.5, 0.9}), 0.08);
  const auto opened = [&](const Point& shift, double from, double to) {
    const auto at = moved(shift);
    return faces_across(
        cube().tets, at,
        front.advance(cube().tets, at, edge_at({0.5, 0.5, from}), edge_at({0.5, 0.5, to})));
  };
  EXPECT_FALSE(opened({0, 0, 0}, 0.9, 0.6).empty());
  EXPECT_TRUE(opened({0, 0, -0.3}, 0.6, 0.6).empty()) << "a blade at rest";
  EXPECT_TRUE(opened({0.1, 0, -0.3}, 0.6, 0.5).empty()) << "the cut is at 0.3 already";
  const Faces more = opened({0, 0, -0.3}, 0.5, 0.1);
  EXPECT_EQ(more,
            faces_across(cube().tets, cube().vertices,
                         {{Point(0.5, 0.2, 0.6), Point(0.5, 0.8, 0.6), Point(0.5, 0.8, 0.4)},
                          {Point(0.5, 0.2, 0.6), Point(0.5, 0.8, 0.4), Point(0.5, 0.2, 0.4)}}));
  EXPECT_FALSE(more.empty());
}

// Back on its own way, in a body that stays where it is, it opens what is open
TEST(BladeFront, TurnsBack) {
  BladeFront front(edge_at({0.5, 0.5, 0.9}), 0.08);
  const auto opened = [&](double from, double to) {
    return faces_across(cube().tets, cube().vertices,
                        front.advance(cube().tets, cube().vertices, edge_at({0.5, 0.5, from}),
                                      edge_at({0.5, 0.5, to})));
  };
  const Faces down = opened(0.9, 0.4), up = opened(0.4, 0.9);
  EXPECT_FALSE(down.empty());
  EXPECT_EQ(up, down);
}

}  // namespace
