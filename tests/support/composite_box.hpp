// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <plica/core/mesh.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/meshes/embedding.hpp>
#include <vector>

// Boxes of two pieces that are put together by hand: a finer mesh beyond a plane, a coarser one
// before it.
namespace plica::test {

/// The part of a tetrahedron's volume where a linear function is above 0, from its values at the
/// corners; exact to rounding.
inline double part_above(std::array<double, 4> h) {
  std::sort(h.begin(), h.end(), std::greater<>());
  const auto at = [&](int a, int b) {  // where the function is 0 on an edge, from its end above 0
    const double up = h[static_cast<std::size_t>(a)], down = h[static_cast<std::size_t>(b)];
    return up / (up - down);
  };
  switch (std::count_if(h.begin(), h.end(), [](double x) { return x > 0; })) {
    case 0:
      return 0;
    case 1:
      return at(0, 1) * at(0, 2) * at(0, 3);
    case 2:
      return at(0, 2) * at(0, 3) + at(0, 2) * (1 - at(0, 3)) * at(1, 3) +
             (1 - at(0, 2)) * at(1, 2) * at(1, 3);
    case 3:
      return 1 - (1 - at(0, 3)) * (1 - at(1, 3)) * (1 - at(2, 3));
    default:
      return 1;
  }
}

/// The mesh of a part x >= at, and the rest of the body before it from a mesh of all of it. The
/// part's vertices at the plane follow the coarser tetrahedra that they lie in.
inline TetMesh completed(const TetMesh& part, const TetMesh& whole, double at) {
  TetMesh mesh = part, rest{whole.vertices, {}, {}, {}, {}};
  mesh.filled.assign(part.tets.size(), 1), mesh.piece.assign(part.tets.size(), 0);
  std::vector<int> number(whole.vertices.size(), -1);
  for (const auto& tet : whole.tets) {
    std::array<double, 4> beyond;
    for (std::size_t c = 0; c < 4; ++c) {
      beyond[c] = whole.vertices[static_cast<std::size_t>(tet[c])][0] - at;
      if (std::abs(beyond[c]) < 1e-12) beyond[c] = 0;
    }
    const double left = 1 - part_above(beyond);
    if (left < 1e-9) continue;
    rest.tets.push_back(tet);
    mesh.filled.push_back(left), mesh.piece.push_back(1);
    auto& own = mesh.tets.emplace_back(tet);
    for (int& v : own) {
      int& n = number[static_cast<std::size_t>(v)];
      if (n < 0) {
        n = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back(whole.vertices[static_cast<std::size_t>(v)]);
      }
      v = n;
    }
  }
  std::vector<Point> border;
  for (std::size_t a = 0; a < part.vertices.size(); ++a)
    if (std::abs(part.vertices[a][0] - at) < 1e-9) {
      mesh.followers.vertex.push_back(static_cast<int>(a));
      border.push_back(part.vertices[a]);
    }
  const Embedding in = embed(border, rest, Outside::extrapolate);
  for (std::size_t i = 0; i < border.size(); ++i) {
    std::array<int, 4> of = in.vertices[i];
    std::array<double, 4> weight = in.weights[i];
    double sum = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      of[c] = number[static_cast<std::size_t>(of[c])];
      if (std::abs(weight[c]) < 1e-10) weight[c] = 0;
      sum += weight[c];
    }
    for (double& w : weight) w /= sum;
    mesh.followers.of.push_back(of), mesh.followers.weight.push_back(weight);
  }
  return mesh;
}

/// A beam of 0.4 m whose half beyond the middle has cells of half the size. Nested: the pieces meet
/// in faces. Else the coarser mesh is irregular, and the finer one is not made of its cells.
inline TetMesh composite_beam(bool nested, int across = 2) {
  const Box beam{{0, 0, 0}, {0.4, 0.1, 0.1}}, half{{nested ? 0.2 : 0.213, 0, 0}, {0.4, 0.1, 0.1}};
  const std::array<int, 3> cells{4 * across, across, across};
  if (nested)
    return completed(box_mesh(half, {4 * across, 2 * across, 2 * across}), box_mesh(beam, cells),
                     0.2);
  return completed(box_mesh(half, {4 * across - 1, 2 * across + 1, 2 * across + 1}),
                   jittered_box(beam, cells), 0.213);
}

/// Puts followers where their masters are.
inline void follow(const TetMesh& mesh, std::vector<Point>& x) {
  const Followers& f = mesh.followers;
  for (std::size_t i = 0; i < f.vertex.size(); ++i) {
    Point sum = Point::Zero();
    for (std::size_t c = 0; c < 4; ++c)
      sum += f.weight[i][c] * x[static_cast<std::size_t>(f.of[i][c])];
    x[static_cast<std::size_t>(f.vertex[i])] = sum;
  }
}

/// A random field whose followers follow.
inline std::vector<Point> followed_field(const TetMesh& mesh, double size, unsigned seed) {
  std::vector<Point> x = random_field(mesh.vertices.size(), size, seed);
  follow(mesh, x);
  return x;
}

}  // namespace plica::test
